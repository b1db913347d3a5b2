"""Other spellings of what people have on disk: text without marks, other names in archives, more than four limbs."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fbx_files import write_fbx
from limb_check import furthest, limbs, places_of
from retarget_rigs import person, rig
from scipy.spatial.transform import Rotation

from motionrt import SMPL24, Motion, load_motion
from motionrt.errors import FormatError, MotionFileWarning, RigError

Z_UP = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])


@pytest.fixture(scope="module")
def walk() -> Motion:
    return person()


@pytest.fixture(scope="module")
def text(walk: Motion, tmp_path_factory: pytest.TempPathFactory) -> str:
    return walk.save(tmp_path_factory.mktemp("bvh") / "walk.bvh").read_text(encoding="utf-8")


def read(path: Path, **options: Any) -> Motion:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MotionFileWarning)
        return load_motion(path, **options)


def same(found: Motion, truth: Motion) -> bool:
    """Whether limbs point as they should, and the head is above the feet."""
    places = places_of(found)
    upright = np.median(places[:, SMPL24.index("head"), 1] - places[:, SMPL24.index("left_foot"), 1]) > 1.0
    return bool(upright) and furthest(limbs(places), limbs(places_of(truth))) < 3.0


@pytest.mark.parametrize(
    "spelt",
    [
        pytest.param(lambda t: t.encode("utf-16-le"), id="UTF-16 without a mark"),
        pytest.param(lambda t: t.replace("\n", "\r\n").encode("utf-16-be"), id="big-endian UTF-16 without a mark"),
        pytest.param(lambda t: t.encode() + b"\x1a", id="Ctrl-Z at the end"),
        pytest.param(lambda t: t.encode() + b"\x1a" + b"\0" * 100, id="Ctrl-Z and padding"),
        pytest.param(lambda t: _rows(t, lambda row: row.replace(" ", ", ")), id="commas between numbers"),
        pytest.param(lambda t: _rows(t, lambda row: row.replace(" ", ";")), id="semicolons between numbers"),
        pytest.param(lambda t: _rows(t, lambda row: row.replace(".", ",").replace(" ", ";")), id="decimal commas"),
    ],
)
def test_a_bvh_in_another_spelling_reads_as_the_same_motion(
    walk: Motion, text: str, tmp_path: Path, spelt: Callable[[str], bytes]
) -> None:
    (tmp_path / "walk.bvh").write_bytes(spelt(text))
    assert same(read(tmp_path / "walk.bvh", fps=30), walk)


def _rows(text: str, change: Callable[[str], str]) -> bytes:
    """``text`` with its rows of numbers, and its frame time where they hold no point any more, changed."""
    head, numbers = text.split("Frame Time:")
    first, *rows = numbers.split("\n")
    rows = [change(row.strip()) for row in rows]
    first = first if any("." in row for row in rows) else first.replace(".", ",")
    return "\n".join([head + "Frame Time:" + first, *rows]).encode()


@pytest.fixture(scope="module")
def body(walk: Motion) -> dict[str, np.ndarray]:
    """Rotation vectors and matrices of the 22 joints of SMPL, and the place, Z up."""
    turns = Rotation.from_matrix(walk.rotations.reshape(-1, 3, 3).astype(float)).as_rotvec().reshape(walk.frames, 24, 3)
    turns[:, 0] = (Rotation.from_matrix(Z_UP) * Rotation.from_rotvec(turns[:, 0])).as_rotvec()
    matrices = Rotation.from_rotvec(turns.reshape(-1, 3)).as_matrix().reshape(walk.frames, 24, 3, 3)
    return {"turns": turns, "matrices": matrices, "place": walk.root @ Z_UP.T}


ARCHIVES: dict[str, Callable[[np.ndarray, np.ndarray, np.ndarray], dict[str, Any]]] = {
    "another name of the place": lambda turns, _, place: {
        "global_orient": turns[:, 0], "body_pose": turns[:, 1:22].reshape(-1, 63), "trans": place, "fps": 30},
    "AMASS with transl": lambda turns, _, place: {
        "root_orient": turns[:, 0], "pose_body": turns[:, 1:22], "transl": place, "frame_rate": 30},
    "pose": lambda turns, _, place: {"pose": turns.reshape(-1, 72), "trans": place, "framerate": 30},
    "root_pose": lambda turns, _, place: {
        "root_pose": turns[:, 0], "body_pose": turns[:, 1:24].reshape(-1, 69), "trans": place, "fps": 30},
    "matrices": lambda _, matrices, place: {
        "global_orient": matrices[:, :1], "body_pose": matrices[:, 1:22], "transl": place, "fps": 30},
    "a batch of one": lambda turns, _, place: {
        "global_orient": turns[None, :, 0], "body_pose": turns[None, :, 1:22].reshape(1, -1, 63),
        "transl": place[None], "fps": 30},
}  # fmt: skip


@pytest.mark.parametrize("layout", ARCHIVES)
def test_poses_of_smpl_are_known_by_other_names(
    walk: Motion, body: dict[str, np.ndarray], tmp_path: Path, layout: str
) -> None:
    np.savez(tmp_path / "poses.npz", **ARCHIVES[layout](body["turns"], body["matrices"], body["place"]))
    found = read(tmp_path / "poses.npz")
    assert same(found, walk)
    travelled = found.root[-1] - found.root[0], walk.root[-1] - walk.root[0]
    np.testing.assert_allclose(*travelled, atol=0.02)


def test_matrices_that_are_no_rotations_are_refused(body: dict[str, np.ndarray], tmp_path: Path) -> None:
    np.savez(tmp_path / "poses.npz", poses=1.2 * body["matrices"], trans=body["place"], fps=30)
    with pytest.raises(FormatError, match="no rotations"):
        load_motion(tmp_path / "poses.npz")


def test_who_walks_along_z_far_above_zero_is_upright(walk: Motion, tmp_path: Path) -> None:
    turns = Rotation.from_matrix(walk.rotations.reshape(-1, 3, 3).astype(float)).as_rotvec().reshape(-1, 72)
    away = np.linspace(0, 3, walk.frames)
    place = np.stack([walk.root[:, 0], walk.root[:, 1] + 5, away], axis=1)
    np.savez(tmp_path / "poses.npz", poses=turns, trans=place, fps=30)
    assert same(read(tmp_path / "poses.npz"), walk)


@pytest.mark.parametrize("options", [{}, {"up": "z"}])
def test_joints_that_stand_along_z_are_turned_upright(walk: Motion, tmp_path: Path, options: dict[str, str]) -> None:
    np.save(tmp_path / "joints.npy", walk.grounded().positions()[:, :22] @ Z_UP.T)
    assert same(read(tmp_path / "joints.npy", **options), walk)


def test_the_vertical_of_the_caller_is_believed_where_the_body_does_not_tell(walk: Motion, tmp_path: Path) -> None:
    np.save(tmp_path / "joints.npy", (walk.positions()[:, :22] + [0, 7, 0]) @ Z_UP.T)
    assert same(read(tmp_path / "joints.npy", up="z"), walk)


def test_joints_of_a_frame_may_stand_in_one_row(walk: Motion, tmp_path: Path) -> None:
    np.save(tmp_path / "joints.npy", walk.positions()[:, :22].reshape(-1, 66))
    assert same(read(tmp_path / "joints.npy"), walk)


Tree = tuple[str, tuple[float, float, float], list["Tree"]]  # type: ignore[misc]


def creature(tree: Tree, frames: int = 30) -> str:
    """A BVH file whose joints swing."""
    lines, columns = ["HIERARCHY"], [0]

    def block(node: Tree, indent: str) -> None:
        name, offset, children = node
        lines.extend([f"{indent}{'JOINT' if indent else 'ROOT'} {name}", indent + "{"])
        lines.append(f"{indent} OFFSET {offset[0]:g} {offset[1]:g} {offset[2]:g}")
        places = "3" if indent else "6 Xposition Yposition Zposition"
        lines.append(f"{indent} CHANNELS {places} Zrotation Xrotation Yrotation")
        columns[0] += 3 if indent else 6
        for child in children:
            block(child, indent + " ")
        if not children:
            lines.extend([indent + s for s in (" End Site", " {", "  OFFSET 0 1 0", " }")])
        lines.append(indent + "}")

    block(tree, "")
    values = 15 * np.sin(np.linspace(0, 6, frames)[:, None] + 0.7 * np.arange(columns[0]))
    values[:, :3] = tree[1]
    rows = [" ".join(f"{value:.4f}" for value in row) for row in values]
    return "\n".join([*lines, "MOTION", f"Frames: {frames}", "Frame Time: 0.033333", *rows, ""])


def leg(name: str, x: float, z: float) -> Tree:
    foot: Tree = (f"{name}Foot", (0, -15, -2), [(f"{name}Tip", (0, -4, 3), [])])
    return (f"{name}", (x, 0, z), [(f"{name}Shin", (0, -5, 2), [foot])])


def swarm(names: list[str], *more: Tree) -> str:
    limbs = [leg(name, 8 if i % 2 else -8, 4 * (i - 4)) for i, name in enumerate(names)]
    return creature(("Body", (0, 20, 0), [*limbs, ("Head", (0, 2, 16), []), *more]))


@pytest.mark.parametrize(
    "names",
    [
        [f"Leg{i}" for i in range(8)],
        [f"T{i}" for i in range(6)],
        [f"{'L' if i % 2 else 'R'}_Leg{i // 2}" for i in range(6)],
        [f"{'Left' if i % 2 else 'Right'}Leg{i // 2}" for i in range(8)],
    ],
)
def test_a_creature_of_six_or_eight_legs_is_no_person(tmp_path: Path, names: list[str]) -> None:
    (tmp_path / "creature.bvh").write_text(swarm(names), encoding="utf-8")
    with pytest.raises(RigError):
        load_motion(tmp_path / "creature.bvh")


def test_an_fbx_of_few_keys_and_many_hours_is_refused_at_once(tmp_path: Path) -> None:
    pytest.importorskip("ufbx", reason='needs the extra fbx: pip install "motionrt[fbx]"')
    clip = rig(person(2), {name: name for name in SMPL24.names})
    object.__setattr__(clip, "fps", 1 / 25_000)
    write_fbx(clip, tmp_path / "long.fbx", centimetres_per_unit=100, up="y")
    with pytest.raises(FormatError, match="stretched_values"):
        load_motion(tmp_path / "long.fbx")
