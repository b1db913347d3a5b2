"""Semantic point clouds and their files."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

from motionrt.errors import FormatError, InvalidInputError, MotionFileNotFoundError
from motionrt.locomotion.words import SemanticCloud, load_cloud

POINTS = np.array([[0, 0, 0], [1, 0.5, 2], [-1.25, 2, 3]], np.float32)
LABELS = (7, 3, 3)
NAMES = {3: "sofa", 7: "floor"}
HEADER = "ply\nformat {}\ncomment label 3 sofa\ncomment label 7 floor\nelement vertex {}\n"
PROPERTIES = "property float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty int label\n"


def checked(cloud: SemanticCloud) -> None:
    np.testing.assert_array_equal(cloud.points, POINTS)
    assert [cloud.names[i] for i in cloud.index] == ["floor", "sofa", "sofa"]


def ply(folder: Path, order: str) -> Path:
    """A PLY with a colour between the coordinates and the label, and faces behind the vertices."""
    path = folder / "cloud.ply"
    head = (
        HEADER.format(f"{order} 1.0", 3)
        + PROPERTIES
        + "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    )
    if order == "ascii":
        rows = [f"{x:g} {y:g} {z:g} 255 {label}" for (x, y, z), label in zip(POINTS, LABELS, strict=True)]
        path.write_bytes((head + "\n".join([*rows, "3 0 1 2"]) + "\n").encode())
        return path
    mark = "<" if "little" in order else ">"
    body = b"".join(
        struct.pack(f"{mark}fffBi", *row, 255, label) for row, label in zip(POINTS.tolist(), LABELS, strict=True)
    )
    path.write_bytes(head.encode() + body + struct.pack(f"{mark}Biii", 3, 0, 1, 2))
    return path


@pytest.mark.parametrize("order", ["ascii", "binary_little_endian", "binary_big_endian"])
def test_a_ply_is_read_in_every_format(tmp_path: Path, order: str) -> None:
    checked(load_cloud(ply(tmp_path, order)))


def test_names_that_are_given_replace_those_of_the_file(tmp_path: Path) -> None:
    assert set(load_cloud(ply(tmp_path, "ascii"), {3: "bench", 7: "lawn"}).names) == {"bench", "lawn"}


def test_a_csv_is_read_with_a_byte_order_mark_and_words(tmp_path: Path) -> None:
    path = tmp_path / "cloud.csv"
    rows = "\n".join(f"{x},{y},{z},{NAMES[label]}" for (x, y, z), label in zip(POINTS, LABELS, strict=True))
    path.write_text("x,y,z,label\n" + rows, encoding="utf-8-sig")
    checked(load_cloud(path))


@pytest.mark.parametrize("labels", [np.array(["floor", "sofa", "sofa"]), np.array([1, 0, 0])])
def test_an_npz_is_read_with_words_or_numbers(tmp_path: Path, labels: np.ndarray) -> None:
    path = tmp_path / "cloud.npz"
    np.savez(path, points=POINTS, labels=labels, names=np.array(["sofa", "floor"]))
    checked(load_cloud(path))


@pytest.mark.parametrize(
    ("name", "content", "reason"),
    [
        ("a.ply", "plywood", "is no PLY file"),
        ("a.ply", "ply\nformat zip 1.0\nend_header\n", "format 'zip' is none of"),
        ("a.ply", "ply\nformat ascii 1.0\nelement face 1\nend_header\n", "first element must be 'vertex'"),
        ("a.ply", HEADER.format("ascii 1.0", 2) + PROPERTIES + "end_header\n0 0 0 1 7\n", "ends before its 2 vertices"),
        (
            "a.ply",
            HEADER.format("ascii 1.0", 1) + PROPERTIES + "end_header\n0 0 zero 1 7\n",
            "a.ply:12: expected 5 numbers",
        ),
        (
            "a.ply",
            HEADER.format("binary_little_endian 1.0", 9) + PROPERTIES + "end_header\n0",
            "ends before its 9 vertices",
        ),
        ("a.ply", HEADER.format("ascii 1.0", 0) + "property float x\nend_header\n", "needs x, y, z and a label"),
        ("a.ply", HEADER.format("ascii 1.0", 0) + PROPERTIES + "end_header\n", "a cloud needs points"),
        ("a.ply", HEADER.format("ascii 1.0", 1) + "property list uchar int x\nend_header\n", "not a plain property"),
        ("a.csv", "x,y,label\n0,0,sofa\n", "needs the columns x, y, z and label"),
        ("a.csv", "x,y,z,label\n0,0,0,sofa\n0,zero,0,sofa\n", "a.csv:3: expected three numbers and a label"),
        ("a.csv", "x,y,z,label\n0,0\n", "a.csv:2: expected three numbers and a label"),
        ("a.npz", "nothing", "no npz file"),
        ("a.xyz", "0 0 0", "a semantic cloud is one of .ply, .csv, .npz"),
    ],
)
def test_a_broken_file_is_refused_with_its_name_and_the_reason(
    tmp_path: Path, name: str, content: str, reason: str
) -> None:
    path = tmp_path / name
    path.write_text(content, encoding="utf-8", newline="\n")
    with pytest.raises(FormatError) as caught:
        load_cloud(path)
    assert reason in str(caught.value)
    assert name in str(caught.value)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(MotionFileNotFoundError, match=r"nowhere\.ply"):
        load_cloud(tmp_path / "nowhere.ply")


@pytest.mark.parametrize(
    ("points", "labels", "names", "reason"),
    [
        (np.zeros((0, 3)), [], None, "a cloud needs points"),
        (np.zeros((2, 2)), ["a", "b"], None, "a cloud needs points"),
        (np.zeros((2, 3)), ["a"], None, "a cloud needs points"),
        ([[np.nan, 0, 0]], ["a"], None, "finite"),
        (np.zeros((1, 3)), [5], ["sofa"], r"labels \[5\] have no name"),
        (np.zeros((1, 3)), [0.5], None, "labels must be strings or integers"),
    ],
)
def test_what_is_no_cloud_is_refused(
    points: object, labels: list[object], names: list[str] | None, reason: str
) -> None:
    with pytest.raises(InvalidInputError, match=reason):
        SemanticCloud(points, labels, names)  # type: ignore[arg-type]


def test_the_floor_is_what_is_called_so_else_the_lowest_point() -> None:
    assert SemanticCloud(POINTS + np.array([0, 0.3, 0]), LABELS, NAMES).floor == pytest.approx(0.3)
    assert SemanticCloud(POINTS[1:], LABELS[1:], NAMES).floor == pytest.approx(0.5)
    assert SemanticCloud([[0, -1, 0], [0, 0.1, 0], [1, 0.1, 0]], ["well", "Ground", "Ground"]).floor == pytest.approx(
        0.1
    )


def test_things_that_share_a_label_are_told_apart_largest_first() -> None:
    line = np.zeros((21, 3))
    line[:, 0] = np.linspace(0, 2, 21)
    cloud = SemanticCloud(
        np.concatenate([line[:11], line + np.array([0, 0, 1]), line[:5] + np.array([5, 0, 0])]), ["bench"] * 37
    )
    assert [len(thing) for thing in cloud.instances("bench")] == [21, 11, 5]
    np.testing.assert_array_equal(cloud.instances("bench")[1], np.arange(11))


def test_unnamed_numbers_are_their_own_names() -> None:
    assert SemanticCloud(POINTS, LABELS).names == ("3", "7")


OBJ = """# a table on a floor, Y up
v -2 0 -2
v 2 0 -2
v 2 0 2
v -2 0 2
{kind} floor
f 1 2 3 4
v -0.5 0.75 -0.5
v 0.5 0.75 -0.5
v 0.5 0.75 0.5
v -0.5 0.75 0.5
{kind} dining table
f -4/1/1 -3//2 -2 -1
"""


@pytest.mark.parametrize("kind", ["o", "g", "usemtl"])
def test_faces_of_a_semantic_obj_become_labelled_points(tmp_path: Path, kind: str) -> None:
    file = tmp_path / "room.obj"
    file.write_text(OBJ.format(kind=kind), encoding="utf-8")
    cloud = load_cloud(file)
    assert cloud.names == ("dining table", "floor")
    table, floor = cloud.of("dining table"), cloud.of("floor")
    np.testing.assert_allclose(table[:, 1], 0.75)
    np.testing.assert_allclose(np.ptp(floor[:, [0, 2]], axis=0), 4.0)
    assert cloud.floor == 0.0
    gaps = np.linalg.norm(table[:, None, [0, 2]] - np.random.default_rng(0).uniform(-0.5, 0.5, (50, 2)), axis=2)
    assert gaps.min(axis=0).max() < 0.05


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("v 0 0\n", r":1: a vertex"),
        ("v 0 0 0\nf 1 2 3\n", r":2: corner 2"),
        ("f x y z\n", "no corner"),
        ("", "no faces"),
    ],
)
def test_a_broken_obj_is_refused_with_its_line(tmp_path: Path, text: str, reason: str) -> None:
    file = tmp_path / "room.obj"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(FormatError, match=reason):
        load_cloud(file)
