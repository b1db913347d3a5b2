"""Files as people have them, rebuilt from public reports: each must read as the motion that it was made from."""

from __future__ import annotations

import base64
import json
import re
import struct
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from retarget_rigs import named, person, renamed, rig

from motionrt.errors import FormatError, InvalidInputError, MotionFileWarning, RigError
from motionrt.formats import animations_of, load_motion, load_rig
from motionrt.formats.bvh.write import write_rig_bvh
from motionrt.formats.gltf.container import pack_container, read_container
from motionrt.motion import SMPL24, Motion
from motionrt.motion.features import guo263
from motionrt.motion.rotations import matrix_to_axis_angle

FRAMES = 24
NAMES = renamed(
    named("{}UpLeg", "{}Leg", "{}Foot", "{}ToeBase", "{}Shoulder", "{}Arm", "{}ForeArm", "{}Hand", "{}HandMiddle1"),
    pelvis="Hips",
    spine1="Spine",
    spine2="Spine1",
    spine3="Spine2",
    neck="Neck",
    head="Head",
)


@pytest.fixture
def walk() -> Motion:
    return person(FRAMES)


@pytest.fixture
def text(walk: Motion, tmp_path: Path) -> str:
    """The walk as a BVH in centimetres, a line a frame."""
    return write_rig_bvh(rig(walk, NAMES), tmp_path / "base.bvh", scale=100).read_text()


def assert_same(found: Motion, truth: Motion, degrees: float = 1.0, *, turned: bool = False) -> None:
    """All bones of ``found`` point as those of ``truth``, upright, with the same path."""
    assert found.frames == truth.frames
    assert found.fps == pytest.approx(truth.fps, rel=1e-3)
    one, two = found.positions().astype(float), truth.positions().astype(float)
    parents = list(SMPL24.parents[1:22])
    a, b = one[:, 1:22] - one[:, parents], two[:, 1:22] - two[:, parents]
    if turned:  # another way to face is as good
        a, b = np.linalg.norm(a[..., [0, 2]], axis=-1), np.linalg.norm(b[..., [0, 2]], axis=-1)
        assert np.abs(a - b).max() < 0.01
    else:
        cosine = (a * b).sum(-1) / np.linalg.norm(a, axis=-1) / np.linalg.norm(b, axis=-1)
        assert np.degrees(np.arccos(np.clip(cosine, -1, 1))).mean(0).max() < degrees
    travel = [np.linalg.norm(places[-1, 0, [0, 2]] - places[0, 0, [0, 2]]) for places in (one, two)]
    assert travel[0] == pytest.approx(travel[1], abs=0.03)
    assert np.median(one[:, 15, 1] - one[:, [10, 11], 1].min(1)) > 1.2


def saved(tmp_path: Path, content: str | bytes, name: str = "case.bvh") -> Path:
    path = tmp_path / name
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


def head_and_rows(text: str) -> tuple[str, list[str]]:
    head, rest = re.split(r"(?<=Frame Time: )", text)
    time, *rows = rest.strip().split("\n")
    return head + time + "\n", rows


@pytest.mark.parametrize("declared", [FRAMES - 1, FRAMES + 1, 0])
def test_whole_rows_count_where_the_declared_number_is_off(
    walk: Motion, text: str, tmp_path: Path, declared: int
) -> None:
    path = saved(tmp_path, text.replace(f"Frames: {FRAMES}", f"Frames: {declared}"))
    with pytest.warns(MotionFileWarning, match=f"declares {declared} frames but holds {FRAMES} whole ones"):
        assert_same(load_motion(path), walk)


def test_an_interrupted_export_keeps_its_whole_frames(walk: Motion, text: str, tmp_path: Path) -> None:
    path = saved(tmp_path, text.rstrip()[:-60])
    with pytest.warns(MotionFileWarning, match=f"holds {FRAMES - 1} whole ones and ends within another"):
        assert_same(load_motion(path), walk[: FRAMES - 1])


@pytest.mark.parametrize(
    "encode",
    [
        lambda text: text.encode("utf-16"),
        lambda text: b"\xfe\xff" + text.encode("utf-16-be"),
        lambda text: b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode(),
        lambda text: text.replace("\n", "\r").encode(),
        lambda text: text.encode() + b"\0" * 512,
        lambda text: text.replace("Hips", "腰").encode("shift-jis"),
        lambda text: text.replace(".", ",").encode(),
        lambda text: text.replace("Frame Time:", "Frames Time:").encode(),
        lambda text: text.replace(" ", "\t").replace("\n", "\n\n").encode(),
    ],
    ids=["utf-16", "utf-16-be", "bom-crlf", "cr", "nul-padding", "shift-jis", "commas", "frames-time", "tabs"],
)
def test_text_variants_read_as_the_same_motion(walk: Motion, text: str, tmp_path: Path, encode: object) -> None:
    assert_same(load_motion(saved(tmp_path, encode(text))), walk)  # type: ignore[operator]


def test_a_pointer_of_git_lfs_is_called_by_its_name(tmp_path: Path) -> None:
    pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 4\n"
    for name in ("a.bvh", "b.glb", "c.amc"):
        with pytest.raises(FormatError, match="git LFS"):
            load_motion(saved(tmp_path, pointer, name))


def test_a_file_without_a_frame_time_reads_with_a_rate_of_the_caller(walk: Motion, text: str, tmp_path: Path) -> None:
    path = saved(tmp_path, re.sub(r"Frame Time.*\n", "", text))
    with pytest.raises(FormatError, match="Frame Time"):
        load_motion(path)
    assert_same(load_motion(path, fps=30), walk)


def test_channels_lean_on_no_order_and_positions_may_repeat_offsets(walk: Motion, text: str, tmp_path: Path) -> None:
    head, rows = head_and_rows(text)
    offsets = [tuple(map(float, line.split()[1:])) for line in re.findall(r"OFFSET .*", head)]
    joints = [
        offset
        for offset, kind in zip(offsets, re.findall(r"JOINT|ROOT|End Site", head), strict=True)
        if kind != "End Site"
    ]
    six = head.replace("CHANNELS 3 ", "CHANNELS 6 Xposition Yposition Zposition ")
    out = []
    for row in rows:
        numbers = row.split()
        parts = [" ".join(numbers[:6])]
        for joint, offset in enumerate(joints[1:], start=1):
            parts.append(" ".join([*map(str, offset), *numbers[3 + 3 * joint : 6 + 3 * joint]]))
        out.append(" ".join(parts))
    assert_same(load_motion(saved(tmp_path, six + "\n".join(out))), walk)


def test_five_toes_side_by_side_are_one_foot(walk: Motion, text: str, tmp_path: Path) -> None:
    for side in ("Left", "Right"):
        toe = re.search(rf"[ \t]*JOINT {side}ToeBase\n.*?\n([ \t]*)}}\n([ \t]*)}}\n", text, re.DOTALL)
        assert toe is not None
        block = toe.group(0)
        more = "".join(
            re.sub(
                r"OFFSET ([-\d.]+)", lambda found, k=k: f"OFFSET {float(found[1]) + 2 * (k - 3):.6f}", block, count=1
            )
            .replace(f"{side}ToeBase", f"toe{k}-1.{side[0]}")
            .replace(re.search(r"CHANNELS.*", block)[0], "CHANNELS 0")  # type: ignore[index]
            for k in (1, 2, 4, 5)
        )
        text = text.replace(
            block, more.replace("CHANNELS 0", "CHANNELS 0") + block.replace(f"{side}ToeBase", f"toe3-1.{side[0]}")
        )
    assert_same(load_motion(saved(tmp_path, text)), walk, 3.0)


def gltf(walk: Motion, tmp_path: Path) -> tuple[dict, bytes]:
    return read_container(walk.save(tmp_path / "base.glb"))


def test_the_suffix_of_a_vrm_and_the_text_of_a_gltf_do_not_matter(walk: Motion, tmp_path: Path) -> None:
    document, binary = gltf(walk, tmp_path)
    whole = pack_container(document, binary)
    document["buffers"][0]["uri"] = "some%20where/data.bin"
    (tmp_path / "some where").mkdir()
    (tmp_path / "some where" / "data.bin").write_bytes(binary)
    inside = json.loads(json.dumps(document))
    inside["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
    for name, content in (
        ("a.vrm", whole),
        ("a.vrma", whole),
        ("a.gltf", json.dumps(document).encode()),
        ("b.gltf", json.dumps(inside).encode()),
    ):
        assert_same(load_motion(saved(tmp_path, content, name)), walk)


@pytest.mark.parametrize("uri", ["../secret.bin", "/etc/hostname", "http://localhost/x.bin", "gone.bin"])
def test_a_gltf_reads_no_file_outside_its_folder(walk: Motion, tmp_path: Path, uri: str) -> None:
    (tmp_path / "secret.bin").write_bytes(b"x" * 100)
    document, _ = gltf(walk, tmp_path)
    document["buffers"][0]["uri"] = uri
    (tmp_path / "inner").mkdir()
    path = saved(tmp_path / "inner", json.dumps(document).encode(), "a.gltf")
    with pytest.raises(FormatError, match="lies in"):
        load_motion(path)


def test_a_sparse_accessor_reads_as_a_full_one(walk: Motion, tmp_path: Path) -> None:
    document, binary = gltf(walk, tmp_path)
    channel = next(c for c in document["animations"][0]["channels"] if c["target"]["path"] == "translation")
    entry = document["accessors"][document["animations"][0]["samplers"][channel["sampler"]]["output"]]
    view = document["bufferViews"][entry.pop("bufferView")]
    at, count = view.get("byteOffset", 0) + entry.pop("byteOffset", 0), entry["count"]
    values = binary[at : at + 12 * count]
    binary += b"\0" * (-len(binary) % 4)
    indices = struct.pack(f"<{count}I", *range(count))
    first = len(document["bufferViews"])
    document["bufferViews"] += [
        {"buffer": 0, "byteOffset": len(binary), "byteLength": len(indices)},
        {"buffer": 0, "byteOffset": len(binary) + len(indices), "byteLength": len(values)},
    ]
    entry["sparse"] = {
        "count": count,
        "indices": {"bufferView": first, "componentType": 5125},
        "values": {"bufferView": first + 1},
    }
    document["buffers"][0]["byteLength"] = len(binary) + len(indices) + len(values)
    path = saved(tmp_path, pack_container(document, binary + indices + values), "sparse.glb")
    assert_same(load_motion(path), walk)


def test_a_skin_of_the_upper_body_does_not_hide_the_legs(walk: Motion, tmp_path: Path) -> None:
    document, binary = gltf(walk, tmp_path)
    names = [node.get("name") for node in document["nodes"]]
    upper = [n for n in document["skins"][0]["joints"] if not re.search("hip|knee|ankle|foot|pelvis", names[n])]
    document["skins"][0] = {"joints": upper}
    for node in document["nodes"]:
        node.pop("mesh", None), node.pop("skin", None)
    assert_same(load_motion(saved(tmp_path, pack_container(document, binary), "part.glb")), walk)


def test_the_humanoid_map_of_a_vrm_tells_the_joints_whatever_they_are_called(walk: Motion, tmp_path: Path) -> None:
    document, binary = gltf(walk, tmp_path)
    bones = {"hip": "UpperLeg", "knee": "LowerLeg", "ankle": "Foot", "foot": "Toes", "collar": "Shoulder"}
    bones |= {"shoulder": "UpperArm", "elbow": "LowerArm", "wrist": "Hand"}
    human = {}
    for i, node in enumerate(document["nodes"]):
        side, _, part = str(node.get("name", "")).partition("_")
        if part in bones:
            human[side + bones[part]] = {"node": i}
        elif node.get("name") in {"pelvis", "head"}:
            human["hips" if node["name"] == "pelvis" else "head"] = {"node": i}
        node["name"] = f"x{i}"
    document["extensions"] = {"VRMC_vrm": {"humanoid": {"humanBones": human}}}
    path = saved(tmp_path, pack_container(document, binary), "avatar.vrm")
    assert load_rig(path).known["left_knee"] != ""
    assert_same(load_motion(path), walk)


def test_animations_of_one_file_are_motions_of_their_own(walk: Motion, tmp_path: Path) -> None:
    document, binary = gltf(walk, tmp_path)
    document["animations"] = [{**document["animations"][0], "name": name} for name in ("Walk", "Run")]
    saved(tmp_path, pack_container(document, binary), "two.glb")
    assert animations_of(tmp_path / "two.glb") == ["Walk", "Run"]
    assert_same(load_motion(tmp_path / "two.glb", animation="Run"), walk)


def test_animations_of_one_name_are_called_by_their_index(walk: Motion, tmp_path: Path) -> None:
    document, binary = gltf(walk, tmp_path)
    document["animations"] = [{**document["animations"][0], "name": name} for name in ("Walk", "Run", "Walk", "7")]
    saved(tmp_path, pack_container(document, binary), "four.glb")
    assert animations_of(tmp_path / "four.glb") == ["0", "Run", "2", "7"]
    for name in ("0", 2, "7", "3"):
        assert_same(load_motion(tmp_path / "four.glb", animation=name), walk)
    with pytest.raises(FormatError, match="more than one animation 'Walk'; it has: 0, Run, 2, 7"):
        load_motion(tmp_path / "four.glb", animation="Walk")


def poses_of(walk: Motion, *, z_up: bool) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Rotation vectors ``(F, 22, 3)`` and places of a body model's file."""
    turn = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]) if z_up else np.eye(3)
    rotations = walk.rotations.astype(np.float64).copy()
    rotations[:, 0] = turn @ rotations[:, 0]
    return matrix_to_axis_angle(rotations)[:, :22], walk.root.astype(np.float64) @ turn.T


@pytest.mark.parametrize("z_up", [True, False])
@pytest.mark.parametrize("layout", ["amass", "3d", "159", "smplx", "stage2", "wham"])
def test_layouts_of_body_models_read_upright_whichever_axis_is_up(
    walk: Motion, tmp_path: Path, layout: str, z_up: bool
) -> None:
    poses, trans = poses_of(walk, z_up=z_up)
    flat = poses.reshape(FRAMES, 66)
    arrays = {
        "amass": {"poses": np.pad(flat, ((0, 0), (0, 90))), "trans": trans, "mocap_framerate": b"30"},
        "3d": {"poses": poses, "trans": trans, "fps": 30},
        "159": {"poses": np.pad(flat, ((0, 0), (0, 93))), "trans": trans, "mocap_frame_rate": 30.0},
        "smplx": {"global_orient": flat[:, :3], "body_pose": flat[:, 3:], "transl": trans, "fps": 30},
        "stage2": {"root_orient": flat[:, :3], "pose_body": flat[:, 3:], "trans": trans, "fps": 30},
        "wham": {"pose_world": np.pad(flat, ((0, 0), (0, 6))), "trans_world": trans, "fps": 30},
    }[layout]
    np.savez(tmp_path / "a.npz", **arrays)
    assert_same(load_motion(tmp_path / "a.npz"), walk)


def test_somebody_who_lies_in_a_z_up_file_stays_lying(tmp_path: Path) -> None:
    still = np.zeros((FRAMES, 22, 3))  # a T-pose along Y is a body that lies on its back where Z is up
    np.savez(tmp_path / "a.npz", poses=still, trans=np.tile([0.0, 5.0, 0.2], (FRAMES, 1)), fps=30)
    lying = load_motion(tmp_path / "a.npz").positions()
    assert np.ptp(lying[0, :, 1]) < 0.5
    standing = load_motion(tmp_path / "a.npz", up="y").positions()
    assert np.ptp(standing[0, :, 1]) > 1.4


def test_what_a_body_models_file_lacks_is_said_in_words(walk: Motion, tmp_path: Path) -> None:
    poses, _ = poses_of(walk, z_up=True)
    path = tmp_path / "a.npz"
    np.savez(path, poses=poses.reshape(FRAMES, 66), trans=np.zeros((FRAMES, 3)))
    with pytest.raises(FormatError, match=r"no frame rate.*give fps="):
        load_motion(path)
    np.savez(path, poses=poses.reshape(FRAMES, 66), fps=30)
    with pytest.warns(MotionFileWarning, match="stays on the spot"):
        load_motion(path)
    np.savez(path, poses=poses[:, 1:].reshape(FRAMES, 63), trans=np.zeros((FRAMES, 3)), fps=30)
    with pytest.raises(FormatError, match="body without its root"):
        load_motion(path)


def test_features_and_joints_of_humanml3d_are_motions(walk: Motion, tmp_path: Path) -> None:
    slow = walk.resample(20)
    joints = slow.positions()[:, :22]
    np.save(tmp_path / "joints.npy", joints)
    np.save(tmp_path / "sample.npy", joints.transpose(1, 2, 0))
    for name in ("joints.npy", "sample.npy"):
        assert_same(load_motion(tmp_path / name), slow, 3.0)
    np.save(tmp_path / "features.npy", guo263.encode(slow))
    assert_same(load_motion(tmp_path / "features.npy"), slow, 3.0, turned=True)
    np.savez(tmp_path / "generated.npz", posed_joints=walk.positions()[:, :22])
    assert_same(load_motion(tmp_path / "generated.npz"), walk, 3.0)


def test_pickled_results_are_refused_with_the_way_out(tmp_path: Path) -> None:
    np.save(tmp_path / "results.npy", np.array({"motion": 1}, dtype=object), allow_pickle=True)
    with pytest.raises(FormatError, match=r"can run any program.*np.save"):
        load_motion(tmp_path / "results.npy")


def test_the_vertical_of_the_caller_is_believed(text: str, tmp_path: Path) -> None:
    path = saved(tmp_path, text)
    assert load_rig(path, up="z").up == "z"
    assert np.ptp(load_motion(path, up="z").positions()[0, :, 1]) < 1.2  # he lies
    with pytest.raises(InvalidInputError, match="up must be"):
        load_rig(path, up="x")


def test_one_hand_is_no_person(text: str, tmp_path: Path) -> None:
    fingers = ("Thumb", "Index", "Middle", "Ring", "Pinky")
    lines = ["HIERARCHY", "ROOT Hand", "{", "OFFSET 0 0 0", "CHANNELS 3 Zrotation Xrotation Yrotation"]
    for k, finger in enumerate(fingers):
        for part in (1, 2, 3):
            offset = f"{k - 2} 0 4" if part == 1 else "0 0 3"
            lines += [f"JOINT {finger}{part}", "{", f"OFFSET {offset}", "CHANNELS 3 Zrotation Xrotation Yrotation"]
        lines += ["End Site", "{", "OFFSET 0 0 2", "}", "}", "}", "}"]
    lines += ["}", "MOTION", "Frames: 5", "Frame Time: 0.0333333", *[" ".join(["0"] * 48)] * 5]
    with pytest.raises(RigError):
        load_motion(saved(tmp_path, "\n".join(lines), "hand.bvh"))


@pytest.mark.parametrize("suffix", [".gltf", ".vrma"])
def test_what_is_written_as_gltf_text_or_vrm_animation_comes_back(walk: Motion, tmp_path: Path, suffix: str) -> None:
    path = walk.save(tmp_path / f"walk{suffix}")
    assert_same(load_motion(path), walk, 0.01)
    if suffix == ".vrma":
        document, _ = read_container(path)
        bones = document["extensions"]["VRMC_vrm_animation"]["humanoid"]["humanBones"]
        names = {bone: document["nodes"][entry["node"]]["name"] for bone, entry in bones.items()}
        assert names["hips"] == "pelvis"
        assert names["leftUpperLeg"] == "left_hip"
        assert names["rightHand"] == "right_wrist"
        assert len(names) == 22
