"""Retargeting out: the character of a user does what the motion does, and his file stays his."""

from __future__ import annotations

import base64
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from characters import NAMES, Z_UP, Character, bvh_text, character
from gaits import gait
from glb_files import Glb, Player, container, glb, unpack
from motions import random_motion, standing, walking
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from motionrt import load_motion, load_target
from motionrt.formats import load_rig
from motionrt.metrics import foot_skate
from motionrt.motion import SMPL24, Motion
from motionrt.motion.feet.flat_ground import flat_ground
from motionrt.rigs.roles import assign_roles
from motionrt.rigs.tree import RigTree

DATA = Path(__file__).parents[3].parent / "shared" / "data" / "mocap"
Array = npt.NDArray[np.float64]
LEG = 0.405 + float(np.hypot(0.410, 0.010))  # thigh and shank of smpl24
SIDED = [f"{side}_{part}" for side in ("left", "right") for part in ("shoulder", "elbow", "wrist")]
LIMBS = [(f"{s}_{a}", f"{s}_{b}") for s in ("left", "right") for a, b in (("shoulder", "elbow"), ("elbow", "wrist"))]


def unit(vectors: npt.ArrayLike) -> Array:
    array = np.asarray(vectors, dtype=np.float64)
    return np.asarray(array / np.linalg.norm(array, axis=-1, keepdims=True))


def role_places(person: Character, path: Path, *roles: str) -> Array:
    """``(F, N, 3)`` where a GLB file puts the joints of ``roles``, played by the tests' own player."""
    return Player(path).places([person.names[person.roles[role]] for role in roles])


def source(motion: Motion, *roles: str) -> Array:
    return motion.positions()[:, [SMPL24.index(role) for role in roles]].astype(np.float64)


def toes_skate(toes: Array, floor: float) -> float:
    body = np.zeros((len(toes), 24, 3))
    body[:, [SMPL24.index("left_foot"), SMPL24.index("right_foot")]] = toes
    return foot_skate(body, floor)


@pytest.mark.parametrize("pose", ["t", "a"])
@pytest.mark.parametrize("scheme", NAMES)
def test_every_naming_scheme_walks_with_its_feet_on_the_ground(tmp_path: Path, scheme: str, pose: str) -> None:
    person = character(scheme, pose=pose, thigh=0.50, shank=0.40, foot=0.14, ankle=0.10, sole=0.025)
    walk, contacts = gait(1.6)
    rig = glb(person, frames="random", armature=(Z_UP, 0.01)).save(tmp_path / "rig.glb")
    path = walk.retarget_to(rig).save(tmp_path / "out.glb")
    scale = 0.90 / LEG
    toes = role_places(person, path, "left_foot", "right_foot")
    assert_allclose(toes, scale * source(walk, "left_foot", "right_foot") + [0, 0.025, 0], atol=1e-3)
    standing_toes = [toes[contacts[:, side], side, 1] for side in range(2)]
    assert_allclose(np.concatenate(standing_toes), 0.025, atol=1e-3)
    assert toes_skate(toes / scale, 0.025 / scale) <= 1.2 * foot_skate(walk.positions()) + 1e-3
    hips = role_places(person, path, "left_hip", "right_hip").mean(axis=1)
    wanted = scale * (source(walk, "left_hip", "right_hip").mean(axis=1)[:, 1] - 0.065) + 0.10
    assert_allclose(hips[:, 1], wanted, atol=1e-3)


@pytest.mark.parametrize("frames", ["world", "bone", "random"])
@pytest.mark.parametrize("pose", ["t", "a"])
def test_arms_point_where_those_of_the_motion_point(tmp_path: Path, frames: str, pose: str) -> None:
    person, motion = character("mixamo", pose=pose), random_motion(8, fps=30, seed=5)
    path = motion.retarget_to(glb(person, frames=frames).save(tmp_path / "rig.glb")).save(tmp_path / "out.glb")
    for upper, lower in LIMBS:
        mine, theirs = role_places(person, path, upper, lower), source(motion, upper, lower)
        assert_allclose(unit(mine[:, 1] - mine[:, 0]), unit(theirs[:, 1] - theirs[:, 0]), atol=1e-4)


def test_the_t_pose_of_the_motion_is_the_t_pose_of_the_character(tmp_path: Path) -> None:
    person = character("mixamo", thigh=0.45, shank=0.455)
    path = standing(2, 30).retarget_to(glb(person, frames="random").save(tmp_path / "rig.glb")).save(tmp_path / "o.glb")
    body = ["pelvis", "spine0", "spine1", "spine2", "neck", "head", "left_collar", "right_collar", *SIDED]
    places = role_places(person, path, *body)[0]
    rest = person.places[[person.roles[role] for role in body]]
    assert_allclose(places - places[0], rest - rest[0], atol=1e-4)
    assert_allclose(places[0, 1], rest[0, 1], atol=5e-3)


def test_how_joints_are_oriented_makes_no_difference(tmp_path: Path) -> None:
    person, motion = character("unreal"), random_motion(5, fps=30, seed=2)
    places = []
    for seed, armature in ((1, None), (2, (Z_UP, 0.01)), (3, (np.eye(3), 100.0))):
        rig = glb(person, frames="random", seed=seed, armature=armature).save(tmp_path / "rig.glb")
        places.append(Player(motion.retarget_to(rig).save(tmp_path / "out.glb")).places(person.names))
    assert_allclose(places[1], places[0], atol=1e-4)
    assert_allclose(places[2], places[0], atol=1e-4)


@pytest.mark.parametrize("spine", [1, 2, 3, 4, 5, 7])
def test_spines_of_any_number_of_joints_share_the_bend(tmp_path: Path, spine: int) -> None:
    rotations = standing(1, 30).rotations.copy()
    for name in ("spine1", "spine2", "spine3"):
        rotations[:, SMPL24.index(name)] = Rotation.from_euler("x", 20, degrees=True).as_matrix()
    person = character("mixamo", spine=spine)
    rig = glb(person, frames="random").save(tmp_path / "rig.glb")
    moved = Motion(rotations, standing(1, 30).root, 30).retarget_to(rig)
    turned = moved.clip.global_pose()[1][0].astype(np.float64)
    rest = moved.clip.rest_pose()[1].astype(np.float64)
    bends = []
    for k in range(spine):
        joint = moved.names.index(person.names[person.roles[f"spine{k}"]])
        bends.append(Rotation.from_matrix(turned[joint] @ rest[joint].T).as_rotvec(degrees=True))
    assert_allclose(bends, [[60 * (k + 1) / spine, 0, 0] for k in range(spine)], atol=0.01)


def test_thumbs_and_props_stay_as_they_are_at_rest(tmp_path: Path) -> None:
    person = character("unreal")
    path = (
        random_motion(6, 30)
        .retarget_to(glb(person, frames="random").save(tmp_path / "rig.glb"))
        .save(tmp_path / "o.glb")
    )
    driven, player = set(person.roles.values()), Player(path)
    moving = ("Index", "Middle", "twist")  # see test_secondary
    extras = [
        joint
        for joint, name in enumerate(person.names)
        if joint not in driven and not any(word in name for word in moving)
    ]
    assert len(extras) > 8
    for joint in extras:
        keys = player.tracks[joint, "rotation"]
        rest = np.asarray(player.nodes[joint]["rotation"])
        assert_allclose(np.abs(keys @ rest), 1, atol=1e-6)
        assert (joint, "translation") not in player.tracks


def test_the_file_keeps_all_that_is_the_users(tmp_path: Path) -> None:
    person = character("mixamo")
    out = glb(person, armature=(Z_UP, 0.01))
    out.animate("idle", [(0, "rotation", [0.0, 1.0], [[0, 0, 0, 1]] * 2)])
    out.document["images"] = [{"uri": "skin.png"}]
    rig = out.save(tmp_path / "rig.glb")
    before, old = unpack(rig.read_bytes())
    after, new = unpack(walking(10, 30).retarget_to(rig).save(tmp_path / "walk.glb").read_bytes())
    assert [animation["name"] for animation in after["animations"]] == ["walk", "idle"]
    assert after["animations"][1] == before["animations"][0]
    for key in ("nodes", "skins", "meshes", "materials", "images", "asset", "extras", "scenes"):
        assert after[key] == before[key]
    for key in ("accessors", "bufferViews"):
        assert after[key][: len(before[key])] == before[key]
    assert new[: before["buffers"][0]["byteLength"]] == old[: before["buffers"][0]["byteLength"]]
    again, _ = unpack(walking(5, 30).retarget_to(tmp_path / "walk.glb").save(tmp_path / "walk.glb").read_bytes())
    assert [animation["name"] for animation in again["animations"]] == ["walk", "idle"]


def test_a_file_whose_data_is_in_its_json_works_too(tmp_path: Path) -> None:
    person, walk = character("mixamo"), walking(6, 30)
    out = glb(person)
    out.document["buffers"] = [{
        "byteLength": len(out.binary),
        "uri": "data:application/octet-stream;base64," + base64.b64encode(bytes(out.binary)).decode(),
    }]  # fmt: skip
    rig = tmp_path / "rig.glb"
    rig.write_bytes(container(out.document, b""))
    moved = walk.retarget_to(rig)
    loaded = load_rig(moved.save(tmp_path / "out.glb"))
    assert_allclose(loaded.global_pose()[0], moved.positions(), atol=1e-5)


@pytest.mark.parametrize("unit_m", [1.0, 0.01, 0.0254])
@pytest.mark.parametrize("z_up", [False, True])
@pytest.mark.parametrize("root_offset", [True, False])
def test_bvh_rigs_of_any_unit_and_axis_stay_what_they_are(
    tmp_path: Path, unit_m: float, z_up: bool, root_offset: bool
) -> None:
    person = character("cmu", sole=0.0)
    laid = person.turned(Z_UP) if z_up else person
    rig = tmp_path / "rig.bvh"
    text = bvh_text(laid, unit=unit_m, root_offset=root_offset)
    rig.write_text(text, encoding="utf-8")
    walk, _ = gait(2.0)
    moved = walk.retarget_to(rig)
    path = moved.save(tmp_path / "out.bvh")
    assert path.read_text(encoding="utf-8").split("MOTION")[0] == text.split("MOTION")[0]
    clip = load_rig(path)
    assert (clip.frames, clip.fps) == (60, 30)
    toes = [clip.names.index(person.names[person.roles[f"{side}_foot"]]) for side in ("left", "right")]
    places = clip.global_pose()[0].astype(np.float64) @ (Z_UP if z_up else np.eye(3)) * unit_m
    assert_allclose(places[:, toes], 0.90 / LEG * source(walk, "left_foot", "right_foot"), atol=2e-3)
    assert moved.units_per_metre == pytest.approx(0.90 / LEG / unit_m, rel=1e-4)


def test_a_bvh_rig_that_moves_every_joint_keeps_its_bones(tmp_path: Path) -> None:
    person, walk = character("mixamo"), walking(5, 30)
    rig = tmp_path / "rig.bvh"
    rig.write_text(bvh_text(person, channels=6), encoding="utf-8")
    moved = walk.retarget_to(rig)
    clip = load_rig(moved.save(tmp_path / "out.bvh"))
    assert_allclose(clip.global_pose()[0], moved.positions(), atol=2e-3)
    assert_allclose(
        clip.translations[:, 1:], np.broadcast_to(clip.offsets[1:], clip.translations[:, 1:].shape), atol=1e-4
    )


def test_a_bvh_rig_becomes_a_glb_in_metres_and_a_glb_rig_a_bvh_in_centimetres(tmp_path: Path) -> None:
    person, motion = character("mixamo", pose="a"), random_motion(6, 30)
    rig = tmp_path / "rig.bvh"
    rig.write_text(bvh_text(person.turned(Z_UP)), encoding="utf-8")
    moved = motion.retarget_to(rig)
    places = Player(moved.save(tmp_path / "out.glb")).places(list(moved.names))
    assert_allclose(places, moved.positions() @ Z_UP * 0.01, atol=1e-4)
    rig = glb(person, frames="random", armature=(Z_UP, 0.01)).save(tmp_path / "rig.glb")
    moved = motion.retarget_to(rig)
    for units, scale in (("cm", 100), ("m", 1), ("in", 1 / 0.0254)):
        clip = load_rig(moved.save(tmp_path / "out.bvh", units=units))
        order = [clip.names.index(name) for name in moved.names]
        assert_allclose(clip.global_pose()[0][:, order], scale * moved.positions(), atol=1e-4 * scale)


def test_a_bvh_may_begin_with_the_rest_pose(tmp_path: Path) -> None:
    person, motion = character("mixamo"), random_motion(40, 30)
    rig = tmp_path / "rig.bvh"
    rig.write_text(bvh_text(person), encoding="utf-8")
    moved = motion.retarget_to(rig)
    clip = load_rig(moved.save(tmp_path / "out.bvh", t_pose=True))
    assert clip.frames == 41
    assert_allclose(clip.rotations[0], np.broadcast_to(np.eye(3), clip.rotations[0].shape), atol=1e-6)
    assert load_motion(tmp_path / "out.bvh").frames == 40


def test_root_motion_carries_the_way_and_the_pelvis_keeps_the_rest(tmp_path: Path) -> None:
    person, walk = character("unreal", root="root"), walking(60, 30, turn=0.8)
    rig = glb(person, frames="random", armature=(Z_UP, 0.01)).save(tmp_path / "rig.glb")
    paths = [
        walk.retarget_to(rig, root_motion=wanted).save(tmp_path / f"{wanted}.glb") for wanted in (False, True, "root")
    ]
    plain, rooted, named = (Player(path) for path in paths)
    assert_allclose(rooted.places(person.names[1:]), plain.places(person.names[1:]), atol=1e-4)
    assert_allclose(named.places(person.names), rooted.places(person.names), atol=1e-6)
    roots = rooted.places(["root"])[:, 0]
    pelvis = rooted.places(["pelvis"])[:, 0]
    assert_allclose(roots[:, 1], 0, atol=1e-5)
    assert_allclose(roots[:, [0, 2]], pelvis[:, [0, 2]], atol=1e-4)
    assert_allclose(plain.places(["root"])[:, 0], 0, atol=1e-5)
    turned = np.array([rooted.matrices(f)["root"][:3, :3] for f in (10, 50)]) / np.linalg.norm(
        rooted.matrices(0)["root"][:3, 0]
    )
    assert_allclose(Rotation.from_matrix(turned[1] @ turned[0].T).as_rotvec(), [0, 0.8 * 40 / 30, 0], atol=0.02)


def test_travel_goes_to_the_joint_that_the_file_lets_travel(tmp_path: Path) -> None:
    person, walk = character("mixamo", root="reference"), walking(10, 30)
    rig = tmp_path / "rig.bvh"
    rig.write_text(bvh_text(person), encoding="utf-8")  # only the ROOT, above the hips, has position channels
    moved = walk.retarget_to(rig)
    clip = load_rig(moved.save(tmp_path / "out.bvh"))
    assert_allclose(clip.global_pose()[0], moved.positions(), atol=1e-3)
    hips = moved.positions()[:, person.roles["pelvis"]]
    assert np.ptp(hips[:, 2]) > 30


def test_a_character_without_toes_stands_on_its_ankles(tmp_path: Path) -> None:
    person = character("mixamo", toes=False, ankle=0.08)
    walk, _ = gait(2.0)
    path = walk.retarget_to(glb(person, frames="bone").save(tmp_path / "rig.glb")).save(tmp_path / "out.glb")
    ankles = role_places(person, path, "left_ankle", "right_ankle")
    assert_allclose(ankles, 0.90 / LEG * source(walk, "left_ankle", "right_ankle"), atol=2e-3)


def test_a_pose_other_than_the_rest_pose_may_be_the_t_pose(tmp_path: Path) -> None:
    """Every bone of the rest pose points up; the nodes stand in the T-pose."""
    person, motion = character("mixamo"), random_motion(4, 30)
    rig = tmp_path / "rig.bvh"
    text = bvh_text(person)
    rig.write_text(text, encoding="utf-8")
    expected = motion.retarget_to(rig).positions()
    crouched = posed_rest(person, text)
    rig.write_text(crouched, encoding="utf-8")
    assert_allclose(motion.retarget_to(rig).positions(), expected, atol=1e-2)


def posed_rest(person: Character, text: str) -> str:
    """The BVH with both thighs of the rest pose pointing up, and a first frame that turns them down again."""
    joints = [line.split()[1] for line in text.splitlines() if line.split()[:1] in (["ROOT"], ["JOINT"])]
    head, row = text.rstrip("\n").rsplit("\n", 1)
    values, lines = row.split(), head.splitlines()
    turned = [person.names[person.roles[f"{side}_hip"]] for side in ("left", "right")]
    for name in turned:
        values[3 + 3 * joints.index(name) + 1] = "180.000000"  # Yrotation Xrotation Zrotation
        start = next(i for i, line in enumerate(lines) if line.split()[-1] == name)
        depth = 0
        for i in range(start + 1, len(lines)):
            depth += lines[i].count("{") - lines[i].count("}")
            words = lines[i].split()
            if words[0] == "OFFSET" and i > start + 2:
                x, y, z = map(float, words[1:])
                lines[i] = f"OFFSET {x:.6f} {-y:.6f} {-z:.6f}"
            if depth == 0:
                break
    return "\n".join([*lines, " ".join(values), ""])


@pytest.mark.parametrize("degrees", [90, 180, 37])
def test_the_motion_faces_as_it_does_whichever_way_the_character_faces(tmp_path: Path, degrees: float) -> None:
    person, motion = character("mixamo", pose="a"), random_motion(5, 30)
    expected = motion.retarget_to(glb(person, frames="random").save(tmp_path / "rig.glb")).positions()
    turned = person.turned(Rotation.from_euler("y", degrees, degrees=True).as_matrix())
    moved = motion.retarget_to(glb(turned, frames="random", seed=1).save(tmp_path / "turned.glb"))
    driven = list(person.roles.values())
    assert_allclose(moved.positions()[:, driven], expected[:, driven], atol=1e-3)


@pytest.mark.parametrize("trial", ["02_01", "10_01", "131_01"])
def test_a_recorded_walk_on_a_recorded_rig_keeps_its_contacts(trial: str) -> None:
    folder = DATA / "cmu" / "bvh"
    if not folder.exists():
        pytest.skip(f"the shared recordings are not here: {folder}")
    walk = flat_ground(load_motion(folder / "16_15.bvh").resample(30))
    rig = load_target(folder / f"{trial}.bvh")
    moved = walk.retarget_to(rig)
    joints = assign_roles(RigTree(rig.clip), None).joints
    places = moved.positions() / moved.units_per_metre
    toes = places[:, [joints["left_foot"], joints["right_foot"]]].astype(np.float64)
    assert toes_skate(toes, moved.sole / moved.units_per_metre) <= 1.2 * foot_skate(walk.positions())
    hips = places[:, [joints["left_hip"], joints["right_hip"]], 1].mean()
    assert hips == pytest.approx(source(walk, "left_hip", "right_hip")[..., 1].mean(), rel=0.05)


def test_names_that_say_nothing_are_told_by_a_mapping(tmp_path: Path) -> None:
    person = character("mixamo", extras=False)
    out: Glb = glb(person, frames="world")
    for i, node in enumerate(out.document["nodes"]):
        node["name"] = f"b{i}"
    rig = out.save(tmp_path / "rig.glb")
    roles = {role: f"b{joint}" for role, joint in person.roles.items() if not role.startswith("spine")}
    motion = random_motion(3, 30)
    expected = motion.retarget_to(glb(person, frames="world").save(tmp_path / "named.glb")).positions()
    assert_allclose(motion.retarget_to(rig, mapping=roles).positions(), expected, atol=1e-4)
    assert_allclose(motion.retarget_to(rig).positions(), expected, atol=1e-4)  # found by structure


def test_one_target_serves_many_motions(tmp_path: Path) -> None:
    rig = load_target(glb(character("mixamo")).save(tmp_path / "rig.glb"))
    first, second = walking(10, 30).retarget_to(rig), walking(20, 24).retarget_to(rig)
    assert (first.frames, second.frames, second.fps) == (10, 20, 24)
    assert repr(second) == f"RigMotion(20 frames at 24 fps, {len(rig.clip.names)} joints)"
    assert second.duration == pytest.approx(20 / 24)


def test_the_rate_and_the_length_are_those_of_the_motion(tmp_path: Path) -> None:
    path = walking(48, 24).retarget_to(glb(character("mixamo")).save(tmp_path / "rig.glb")).save(tmp_path / "out.glb")
    assert_allclose(Player(path).times, np.arange(48) / 24, atol=1e-6)
