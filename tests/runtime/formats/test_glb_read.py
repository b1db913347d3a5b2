"""Reading GLB: what other programs write."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from characters import Z_UP, Character, character
from glb_files import Glb, glb
from motions import walking
from numpy.testing import assert_allclose
from scipy.interpolate import CubicHermiteSpline
from scipy.spatial.transform import Rotation, Slerp

from motionrt import load_motion
from motionrt.errors import FormatError
from motionrt.formats import load_rig, read_glb

TIMES = np.arange(31) / 30.0


def quaternions(angles: np.ndarray, axis: str = "x") -> np.ndarray:
    return Rotation.from_euler(axis, angles[:, None]).as_quat()


def bending(person: Character, **options: object) -> Glb:
    """The left knee bends to 60 degrees and back, once a second; the hips go 1 m ahead."""
    out = glb(person, frames="world", **options)  # type: ignore[arg-type]
    hips, knee = person.roles["pelvis"], person.roles["left_knee"]
    start = np.array(out.document["nodes"][hips]["translation"])
    path = start + np.outer(TIMES, [0, 0, 1.0])
    bend = quaternions(np.pi / 3 * np.sin(np.pi * TIMES))
    out.animate("bend", [(knee, "rotation", TIMES, bend), (hips, "translation", TIMES, path)])
    return out


def test_a_skinned_character_loads_with_its_motion(tmp_path: Path) -> None:
    person = character("mixamo")
    clip = load_rig(bending(person).save(tmp_path / "clip.glb"))
    assert clip.names == tuple(person.names)
    assert (clip.fps, clip.frames, clip.up, clip.metres_per_unit) == (30, 31, "y", 1.0)
    places, _ = clip.global_pose()
    assert_allclose(clip.rest_positions(), person.places, atol=1e-5)
    assert_allclose(places[0], person.places, atol=1e-5)
    ankle, knee = person.roles["left_ankle"], person.roles["left_knee"]
    shank = person.places[ankle] - person.places[knee]
    bent = Rotation.from_euler("x", 60, degrees=True).apply(shank)
    assert_allclose(places[15, ankle] - places[15, knee], bent, atol=1e-5)
    assert_allclose(places[30, 0] - places[0, 0], [0, 0, 1], atol=1e-5)


@pytest.mark.parametrize("frames", ["world", "bone", "random"])
@pytest.mark.parametrize("armature", [None, (Z_UP, 0.01), (np.eye(3), 100.0)])
def test_where_the_joints_are_does_not_depend_on_frames_and_scales(
    tmp_path: Path, frames: str, armature: tuple[np.ndarray, float] | None
) -> None:
    person = character("unreal", root="root")
    out = glb(person, frames=frames, armature=armature)
    out.animate("still", [(0, "translation", [0.0], [out.document["nodes"][0]["translation"]])])
    clip = load_rig(out.save(tmp_path / "clip.glb"))
    own = [clip.names.index(name) for name in person.names]
    assert_allclose(clip.global_pose()[0][0, own], person.places, atol=1e-4)
    assert_allclose(clip.rest_positions()[own], person.places, atol=1e-4)


def test_nodes_that_are_posed_leave_the_bind_pose_as_rest(tmp_path: Path) -> None:
    person = character("mixamo")
    lean = {person.roles["left_shoulder"]: Rotation.from_euler("z", -70, degrees=True).as_matrix()}
    out = glb(person, frames="random", posed=lean, armature=(Z_UP, 0.01))
    start = out.document["nodes"][person.roles["pelvis"]]["translation"]
    out.animate("still", [(person.roles["pelvis"], "translation", [0.0], [start])])
    clip = load_rig(out.save(tmp_path / "clip.glb"))
    own = [clip.names.index(name) for name in person.names]
    hand = person.roles["left_wrist"]
    assert_allclose(clip.rest_positions()[own], person.places, atol=1e-3)
    assert np.linalg.norm(clip.global_pose()[0][0, own[hand]] - person.places[hand]) > 0.1


def test_matrices_do_as_well_as_parts(tmp_path: Path) -> None:
    person = character("unity")
    out = bending(person)
    for node in out.document["nodes"][1 : len(person.names)]:
        if node["name"] == person.names[person.roles["left_knee"]]:
            continue  # what is animated must have parts
        matrix = np.eye(4)
        matrix[:3, :3] = Rotation.from_quat(node.pop("rotation")).as_matrix()
        matrix[:3, 3] = node.pop("translation")
        node["matrix"] = matrix.T.ravel().tolist()
    clip = load_rig(out.save(tmp_path / "clip.glb"))
    assert_allclose(clip.rest_positions(), person.places, atol=1e-5)


@pytest.mark.parametrize("kind", ["LINEAR", "STEP", "CUBICSPLINE"])
def test_keys_are_interpolated_as_the_format_says(tmp_path: Path, kind: str) -> None:
    person = character("mixamo")
    out = glb(person, frames="world")
    hips, knee = person.roles["pelvis"], person.roles["left_knee"]
    keys, rng = np.array([0.0, 0.4, 1.0]), np.random.default_rng(3)
    turns, moves = Rotation.from_rotvec(rng.normal(0, 0.5, (3, 3))), rng.normal(0, 0.3, (3, 3))
    slopes = rng.normal(0, 1, (3, 3))
    values, places = turns.as_quat(), moves
    if kind == "CUBICSPLINE":
        values = np.stack([np.zeros((3, 4)), values, np.zeros((3, 4))], axis=1).reshape(-1, 4)
        places = np.stack([slopes, moves, slopes], axis=1).reshape(-1, 3)
    out.animate("keys", [(knee, "rotation", keys, values), (hips, "translation", keys, places)], kind)
    clip = read_glb(out.save(tmp_path / "clip.glb"), fps=20)
    times = np.arange(21) / 20.0
    assert (clip.fps, clip.frames) == (20, 21)
    step = np.minimum(np.searchsorted(keys, times + 1e-9, side="right") - 1, 2)
    expected = {
        "LINEAR": lambda: np.stack([np.interp(times, keys, moves[:, i]) for i in range(3)], axis=1),
        "STEP": lambda: moves[step],
        "CUBICSPLINE": lambda: CubicHermiteSpline(keys, moves, slopes)(times),
    }[kind]()
    assert_allclose(clip.translations[:, hips], expected, atol=1e-5)
    if kind != "CUBICSPLINE":
        wanted = Slerp(keys, turns)(times) if kind == "LINEAR" else turns[step]
        assert_allclose(clip.rotations[:, knee], wanted.as_matrix(), atol=1e-5)
    else:
        assert_allclose(clip.rotations[[0, 8, 20], knee], turns.as_matrix(), atol=1e-5)


def test_rotations_may_be_stored_as_whole_numbers(tmp_path: Path) -> None:
    person = character("mixamo")
    out = bending(person)
    animation, knee = out.document["animations"][0], person.roles["left_knee"]
    shorts = np.round(quaternions(np.pi / 3 * np.sin(np.pi * TIMES)) * 32767).astype(np.int16)
    accessor = out.array(shorts, "VEC4")
    out.document["accessors"][accessor]["normalized"] = True
    animation["samplers"][0]["output"] = accessor
    clip = load_rig(out.save(tmp_path / "clip.glb"))
    assert_allclose(clip.rotations[15, knee], Rotation.from_euler("x", 60, degrees=True).as_matrix(), atol=1e-4)


def test_the_rate_is_that_of_the_keys_even_where_some_are_left_out(tmp_path: Path) -> None:
    person = character("mixamo")
    some = np.array([0, 1, 2, 3, 7, 8, 20, 48]) / 24.0
    out = glb(person, frames="world")
    out.animate("sparse", [(person.roles["left_knee"], "rotation", some, quaternions(0.1 * some))])
    clip = load_rig(out.save(tmp_path / "clip.glb"))
    assert (clip.fps, clip.frames) == (24, 49)


def test_keys_without_a_beat_are_sampled_at_thirty_frames_per_second(tmp_path: Path) -> None:
    person = character("mixamo")
    times = np.array([0.5, 0.613, 1.37, 2.5])
    out = glb(person, frames="world")
    out.animate("free", [(person.roles["left_knee"], "rotation", times, quaternions(0.1 * times))])
    clip = load_rig(out.save(tmp_path / "clip.glb"))
    assert (clip.fps, clip.frames) == (30, 61)
    assert load_rig(tmp_path / "clip.glb", fps=60).frames == 121


def test_several_animations_ask_for_a_choice_but_poses_do_not_count(tmp_path: Path) -> None:
    person = character("mixamo")
    out = bending(person)
    knee = person.roles["left_knee"]
    out.animate("T-Pose", [(knee, "rotation", [0.0], quaternions(np.zeros(1)))])
    assert load_rig(out.save(tmp_path / "clip.glb")).frames == 31
    out.animate("wave", [(knee, "rotation", TIMES[:11], quaternions(TIMES[:11]))])
    path = out.save(tmp_path / "clip.glb")
    with pytest.raises(FormatError, match="holds 2 animations; choose with animation=, one of: bend, wave"):
        load_motion(path)
    assert load_motion(path, animation="wave").frames == 11
    assert load_motion(path, animation=0).frames == 31
    with pytest.raises(FormatError, match="no animation 'run'; it has: bend, T-Pose, wave"):
        load_motion(path, animation="run")


def test_skins_of_one_figure_are_one_skeleton_and_a_prop_does_not_disturb(tmp_path: Path) -> None:
    person = character("mixamo")
    out = bending(person)
    document, count = out.document, len(person.names)
    skin = document["skins"][0]
    document["nodes"] += [{"name": "flag"}, {"name": "pole", "children": [len(document["nodes"])]}]
    document["scenes"][0]["nodes"].append(len(document["nodes"]) - 1)
    flag = [len(document["nodes"]) - 1, len(document["nodes"]) - 2]
    document["skins"] = [
        {"joints": list(range(0, count, 2)), "name": "coat"},
        {**skin, "name": "body"},
        {"joints": flag, "name": "flag"},
    ]
    assert load_rig(out.save(tmp_path / "clip.glb")).names == tuple(person.names)


def test_two_figures_ask_for_a_choice(tmp_path: Path) -> None:
    person = character("mixamo", extras=False)
    out, count = bending(person), len(person.names)
    first = len(out.document["nodes"])
    for node in glb(character("unity", extras=False), frames="world").document["nodes"][:count]:
        children = [first + child for child in node.get("children", [])]
        out.document["nodes"].append({**node, **({"children": children} if children else {})})
    out.document["scenes"][0]["nodes"].append(first)
    out.document["skins"][0]["name"] = "one"
    out.document["skins"].append({"joints": list(range(first, first + count)), "name": "two"})
    out.animate("other", [(first + person.roles["left_knee"], "rotation", TIMES, quaternions(TIMES))])
    path = out.save(tmp_path / "clip.glb")
    with pytest.raises(FormatError, match="holds 2 skeletons; say which with skin=, one of: one, two"):
        read_glb(path)
    assert read_glb(path, skin="one").names == tuple(person.names)
    assert read_glb(path, skin=1).names[0] == "Hips"
    assert load_motion(path, skin="two").frames == 31
    with pytest.raises(FormatError, match="no skin 'three'; it has: one, two"):
        load_rig(path, skin="three")


def test_a_skeleton_without_skin_is_what_the_animation_moves(tmp_path: Path) -> None:
    person = character("mixamo")
    out = bending(person)
    del out.document["skins"], out.document["nodes"][-1]["skin"]
    assert load_rig(out.save(tmp_path / "clip.glb")).names == tuple(person.names)


def test_a_second_joint_of_a_name_gets_a_number(tmp_path: Path) -> None:
    person = character("mixamo")
    out = bending(person)
    fingers = [i for i, name in enumerate(person.names) if name.endswith("2")]
    for finger in fingers:
        out.document["nodes"][finger]["name"] = "tip"
    del out.document["nodes"][0]["name"]
    names = load_rig(out.save(tmp_path / "clip.glb")).names
    assert [name for name in names if name.startswith("tip")] == [
        "tip",
        *(f"tip_{k}" for k in range(2, len(fingers) + 1)),
    ]
    assert names[0] == "node_0"


@pytest.mark.parametrize("scheme", ["mixamo", "unreal", "unity", "cmu", "xsens", "rokoko"])
def test_a_walk_on_another_character_comes_back(tmp_path: Path, scheme: str) -> None:
    walk = walking(30, fps=30)
    out = glb(character(scheme, pose="a"), frames="random", armature=(Z_UP, 0.01)).save(tmp_path / "rig.glb")
    walk.retarget_to(out).save(tmp_path / "walk.glb")
    loaded = load_motion(tmp_path / "walk.glb", animation="walk")
    for upper, lower in (("shoulder", "elbow"), ("elbow", "wrist")):
        for side in ("left", "right"):
            assert_allclose(bones(loaded, side, upper, lower), bones(walk, side, upper, lower), atol=2e-3)


def bones(motion: object, side: str, upper: str, lower: str) -> np.ndarray:
    index = motion.skeleton.index  # type: ignore[attr-defined]
    places = motion.positions()  # type: ignore[attr-defined]
    bone = places[:, index(f"{side}_{lower}")] - places[:, index(f"{side}_{upper}")]
    return np.asarray(bone / np.linalg.norm(bone, axis=-1, keepdims=True))
