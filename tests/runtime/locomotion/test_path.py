"""Paths: places, directions and projections against hand-worked numbers, SciPy and brute force."""

from __future__ import annotations

from pathlib import Path as FilePath

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from motionrt.errors import FormatError, InvalidInputError, MotionFileNotFoundError
from motionrt.locomotion.path import Path

ELL = np.array([[0, 0], [0, 3], [4, 3]], dtype=np.float32)  # 3 m ahead (+Z), then 4 m to the left (+X)
POLYLINES = arrays(np.float32, st.tuples(st.integers(2, 12), st.just(2)), elements=st.integers(-20, 20))


def test_length_places_and_directions_of_a_hand_worked_path() -> None:
    path = Path(ELL)
    assert path.length == pytest.approx(7)
    np.testing.assert_allclose(path.at([0, 2, 3, 5, 7]), [[0, 0], [0, 2], [0, 3], [2, 3], [4, 3]], atol=1e-6)
    np.testing.assert_allclose(path.tangent([0, 2.9, 3, 7]), [[0, 1], [0, 1], [1, 0], [1, 0]], atol=1e-6)
    assert path.at(2.0).shape == path.tangent(2.0).shape == (2,)


def test_arc_lengths_beyond_the_ends_give_the_ends() -> None:
    np.testing.assert_allclose(Path(ELL).at([-1, 99]), [[0, 0], [4, 3]])


def test_projection_of_points_beside_before_and_behind() -> None:
    s, distance = Path(ELL).project([[-1, 1], [2, 5], [-3, -4], [6, 3]])
    np.testing.assert_allclose(s, [1, 5, 0, 7], atol=1e-6)
    np.testing.assert_allclose(distance, [1, 2, 5, 2], atol=1e-6)


@given(POLYLINES.filter(lambda p: bool(np.any(p != p[0]))), arrays(np.float32, (5, 2), elements=st.integers(-30, 30)))
def test_projection_is_the_nearest_of_densely_sampled_places(points: np.ndarray, queries: np.ndarray) -> None:
    path = Path(points)
    s, distance = path.project(queries)
    dense = path.at(np.linspace(0, path.length, 4000))
    nearest = np.linalg.norm(queries[:, None] - dense[None], axis=-1).min(axis=1)
    assert (distance <= nearest + 1e-3).all()
    np.testing.assert_allclose(np.linalg.norm(path.at(s) - queries, axis=-1), distance, atol=1e-3)


def test_projection_keeps_the_shape_of_its_points_and_takes_thousands() -> None:
    path = Path(np.stack([np.linspace(0, 100, 3000), np.zeros(3000)], axis=1))
    s, distance = path.project(np.tile([50.0, 2.0], (40, 30, 1)))
    assert s.shape == distance.shape == (40, 30)
    np.testing.assert_allclose(s, 50, atol=1e-3)
    np.testing.assert_allclose(distance, 2, atol=1e-4)
    assert path.project(np.zeros((0, 2)))[0].shape == (0,)


def test_waypoints_are_even_end_at_the_end_and_look_along_the_path() -> None:
    waypoints = Path(ELL).waypoints(2.0)
    assert len(waypoints) == 4
    np.testing.assert_allclose(waypoints.positions, [[0, 1.75], [0.5, 3], [2.25, 3], [4, 3]], atol=1e-6)
    np.testing.assert_allclose(waypoints.headings, [0, np.pi / 2, np.pi / 2, np.pi / 2], atol=1e-6)


def test_a_spacing_longer_than_the_path_gives_its_end_alone() -> None:
    np.testing.assert_allclose(Path(ELL).waypoints(100).positions, [[4, 3]])


@pytest.mark.parametrize("spacing", [0, -1, float("nan")])
def test_a_spacing_that_is_not_positive_is_refused(spacing: float) -> None:
    with pytest.raises(InvalidInputError, match="spacing"):
        Path(ELL).waypoints(spacing)


def test_repeated_points_are_dropped_and_a_path_is_read_only() -> None:
    path = Path(np.repeat(ELL, 3, axis=0))
    np.testing.assert_array_equal(path.points, ELL)
    with pytest.raises(ValueError, match="read-only"):
        path.points[0] = 1


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ([[0, 0]], "two different points"),
        ([[1, 1], [1, 1]], "two different points"),
        (np.zeros((0, 2)), "two different points"),
        ([[0, 0, 0], [1, 1, 1]], r"\(N, 2\)"),
        ([[0, 0], [np.nan, 1]], "first in point 1"),
    ],
)
def test_points_that_make_no_path_are_refused(points: object, message: str) -> None:
    with pytest.raises(InvalidInputError, match=message):
        Path(np.asarray(points, dtype=np.float32))


def test_a_part_keeps_the_corners_between_its_ends() -> None:
    part = Path(ELL).part(1, 5)
    np.testing.assert_allclose(part.points, [[0, 1], [0, 3], [2, 3]], atol=1e-6)


def test_rounding_a_right_angle_gives_the_quarter_circle() -> None:
    path = Path(ELL).rounded(1.0)
    assert path.length == pytest.approx(7 - 2 + np.pi / 2, abs=0.01)
    inner = path.points[1:-1]
    np.testing.assert_allclose(np.linalg.norm(inner - [1, 2], axis=1), 1, atol=1e-5)
    np.testing.assert_allclose(path.points[[0, -1]], ELL[[0, -1]])


@given(POLYLINES.filter(lambda p: bool((np.abs(np.diff(p, axis=0)).sum(axis=1) > 0).all())))
def test_rounding_never_lengthens_and_stays_near(points: np.ndarray) -> None:
    path = Path(points)
    rounded = path.rounded(0.8)
    assert rounded.length <= path.length + 1e-3
    _, distance = path.project(rounded.at(np.linspace(0, rounded.length, 500)))
    assert distance.max() <= 0.8 + 1e-3  # an arc is never farther than its radius from the corner's legs


@given(POLYLINES.filter(lambda p: bool(np.any(p != p[0]))))
def test_a_path_survives_a_csv_file(tmp_path_factory: pytest.TempPathFactory, points: np.ndarray) -> None:
    path = Path(points)
    file = tmp_path_factory.mktemp("csv") / "points.csv"
    np.savetxt(file, path.points, delimiter=",", header="x,z", comments="")
    np.testing.assert_allclose(Path.from_csv(file).points, path.points)


@pytest.mark.parametrize(
    "text",
    [
        "0,0\n0,3\n4,3\n",
        "x,z\n0,0\n0,3\n4,3\n",
        "\ufeffX;Z\r\n0;0\r\n\r\n0;3\r\n4;3\r\n",
        "# a walk\n0 0\n0\t3\n  4   3 # the end\n".replace("\t", " "),
        "t,x,y,z\n0,0,9,0\n1,0,9,3\n2,4,9,3\n",
        '"x","z"\n0,0,7\n0,3,7\n4,3,7\n',
    ],
)
def test_csv_with_and_without_header(tmp_path: FilePath, text: str) -> None:
    file = tmp_path / "points.csv"
    file.write_text(text, encoding="utf-8", newline="")
    np.testing.assert_allclose(Path.from_csv(file).points, ELL)


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("0,0\n1,oops\n", 2, "'oops'"),
        ("x,z\n0,0\n\n1\n", 4, "found 1"),
        ("0,0\nnan,1\n", 2, "not a finite number"),
        ("x,y\n0,0\n1,1\n", 1, "x and z, found x, y"),
        ("0,0\n0,0\n", None, "two different points"),
        ("# nothing\n", None, "no points"),
        ("", None, "empty"),
    ],
)
def test_a_broken_csv_names_file_and_line(tmp_path: FilePath, text: str, line: int | None, message: str) -> None:
    file = tmp_path / "my points.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(FormatError, match=message) as caught:
        Path.from_csv(file)
    assert caught.value.line == line
    assert str(file) in str(caught.value)


def test_a_missing_csv_is_a_file_not_found(tmp_path: FilePath) -> None:
    with pytest.raises(MotionFileNotFoundError, match=r"none\.csv"):
        Path.from_csv(tmp_path / "none.csv")
