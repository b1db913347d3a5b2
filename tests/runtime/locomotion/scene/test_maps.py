"""Maps as in ROS: every rule of the YAML on hand-written images."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from motionrt.errors import InvalidInputError, MotionFileNotFoundError, SceneError
from motionrt.locomotion.scene import Scene, from_map, to_map
from motionrt.locomotion.scene.images import read_grey

PIXELS = np.array([[254, 0, 254, 254], [254, 205, 254, 100], [254, 254, 254, 254]], dtype=np.uint8)
FREE = np.array([[1, 0, 1, 1], [1, 0, 1, 0], [1, 1, 1, 1]], dtype=bool)  # 205 is unknown ground


def pgm(path: Path, pixels: np.ndarray = PIXELS, *, plain: bool = False, largest: int = 255) -> Path:
    height, width = pixels.shape
    header = f"P{2 if plain else 5}\n# by hand\n{width} {height}\n{largest}\n".encode()
    body = (
        " ".join(map(str, pixels.ravel())).encode()
        if plain
        else pixels.astype(">u2" if largest > 255 else "u1").tobytes()
    )
    path.write_bytes(header + body)
    return path


def described(folder: Path, **fields: object) -> Path:
    pgm(folder / "map.pgm")
    known = {"image": "map.pgm", "resolution": 0.5, "origin": [0, 0, 0], "negate": 0, "occupied_thresh": 0.65}
    path = folder / "map.yaml"
    path.write_text(yaml.safe_dump({**known, "free_thresh": 0.196, **fields}), encoding="utf-8")
    return path


def test_pixels_become_cells_with_image_rows_along_z(tmp_path: Path) -> None:
    grid = Scene.open(described(tmp_path, origin=[1, 2, 0])).grid
    np.testing.assert_array_equal(grid.walkable, FREE)
    assert grid.cell == 0.5
    np.testing.assert_allclose(grid.origin, [1, -2 - 3 * 0.5])  # the lowest z is the top of the image


def test_a_place_of_the_map_is_found_on_the_ground_without_mirroring(tmp_path: Path) -> None:
    scene = Scene.open(described(tmp_path, origin=[1, 2, 0]))
    blocked_in_map = (1 + 1.5 * 0.5, 2 + 2.5 * 0.5)  # the pixel in column 1 of the top row
    row, column, _ = scene.grid.cells(from_map(blocked_in_map))
    assert (row, column) == (0, 1)
    x, y = np.array([1.0, 0.0]), np.array([0.0, 1.0])
    across = np.cross([from_map(x)[0], 0, from_map(x)[1]], [from_map(y)[0], 0, from_map(y)[1]])
    np.testing.assert_allclose(across, [0, 1, 0])  # x cross y is up, as on the map
    np.testing.assert_allclose(to_map(from_map([[3, -4]])), [[3, -4]])


@pytest.mark.parametrize(
    ("quarter", "turned"), [(0, FREE), (1, np.rot90(FREE, 1)), (2, np.rot90(FREE, 2)), (3, np.rot90(FREE, 3))]
)
def test_a_yaw_turns_the_map_counter_clockwise_about_its_origin(
    tmp_path: Path, quarter: int, turned: np.ndarray
) -> None:
    scene = Scene.open(described(tmp_path, origin=[5, 5, quarter * np.pi / 2]))
    np.testing.assert_array_equal(scene.grid.walkable, turned)
    corner = np.array([0.25, 0.25])  # in the lower left pixel
    turn = np.array(
        [
            [np.cos(quarter * np.pi / 2), -np.sin(quarter * np.pi / 2)],
            [np.sin(quarter * np.pi / 2), np.cos(quarter * np.pi / 2)],
        ]
    )
    assert scene.grid.is_walkable(from_map(np.array([5, 5]) + turn @ corner))


def test_a_skew_yaw_keeps_the_area(tmp_path: Path) -> None:
    pgm(tmp_path / "map.pgm", np.full((80, 120), 254))
    path = tmp_path / "skew.yaml"
    path.write_text("image: map.pgm\nresolution: 0.05\norigin: [1, 2, 0.4]\n", encoding="utf-8")
    scene = Scene.open(path)
    assert scene.grid.walkable.sum() * 0.05**2 == pytest.approx(4 * 6, rel=0.01)
    middle = [[1 + np.cos(0.4) * 3 - np.sin(0.4) * 2, 2 + np.sin(0.4) * 3 + np.cos(0.4) * 2]]
    assert scene.clearance(from_map(middle)) == pytest.approx([2.0], abs=0.06)


def test_negate_swaps_light_and_dark(tmp_path: Path) -> None:
    path = described(tmp_path, negate=1)
    np.testing.assert_array_equal(Scene.open(path).grid.walkable, PIXELS < 255 * 0.196)


def test_thresholds_decide_what_is_free(tmp_path: Path) -> None:
    np.testing.assert_array_equal(Scene.open(described(tmp_path, free_thresh=0.25)).grid.walkable, PIXELS >= 205)
    loose = Scene.from_map(described(tmp_path), unknown_free=True)
    np.testing.assert_array_equal(loose.grid.walkable, PIXELS > 0.35 * 255)


def test_raw_pixels_are_percentages(tmp_path: Path) -> None:
    path = described(tmp_path, mode="raw")
    pgm(tmp_path / "map.pgm", np.array([[0, 19], [20, 100], [101, 255]]))
    np.testing.assert_array_equal(Scene.open(path).grid.walkable, [[1, 1], [0, 0], [0, 0]])


@pytest.mark.parametrize("plain", [True, False])
@pytest.mark.parametrize("largest", [255, 1000, 100])
def test_pgm_images_of_either_kind_and_any_depth(tmp_path: Path, plain: bool, largest: int) -> None:
    values = np.array([[0, largest // 2, largest], [1, 2, 3]])
    grey = read_grey(pgm(tmp_path / "a.pgm", values, plain=plain, largest=largest))
    np.testing.assert_allclose(grey, values * 255 / largest)


def test_png_images_are_read_too(tmp_path: Path) -> None:
    image = pytest.importorskip("PIL.Image", reason="Pillow (extra 'scene') is not installed")
    image.fromarray(PIXELS).save(tmp_path / "map.png")
    np.testing.assert_array_equal(Scene.open(tmp_path / "map.png", resolution=0.5).grid.walkable, FREE)
    transparent = np.stack([PIXELS, PIXELS, PIXELS, np.where(FREE, 255, 0).astype(np.uint8)], axis=-1)
    image.fromarray(transparent).save(tmp_path / "map.png")
    np.testing.assert_array_equal(np.isnan(read_grey(tmp_path / "map.png")), ~FREE)


def test_an_image_takes_its_resolution_from_the_caller_or_the_yaml_beside_it(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="give resolution="):
        Scene.open(pgm(tmp_path / "map.pgm"))
    scene = Scene.open(tmp_path / "map.pgm", resolution=0.1)
    np.testing.assert_allclose(scene.bounds, [[0, -0.3], [0.4, 0]], atol=1e-6)
    described(tmp_path)
    assert Scene.open(tmp_path / "map.pgm").grid.cell == 0.5


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"resolution": 0}, "resolution must be a positive"),
        ({"resolution": "fine"}, "fine"),
        ({"origin": [1, 2]}, "three numbers"),
        ({"origin": [1, 2, float("nan")]}, "three finite numbers"),
        ({"mode": "colour"}, "none of trinary, scale, raw"),
        ({"free_thresh": 0.9}, "free_thresh <= occupied_thresh"),
        ({"negate": "maybe"}, "maybe"),
    ],
)
def test_a_wrong_value_names_the_file_and_the_value(tmp_path: Path, fields: dict[str, object], message: str) -> None:
    path = described(tmp_path, **fields)
    with pytest.raises(SceneError, match=message) as caught:
        Scene.open(path)
    assert "map.yaml" in str(caught.value)


@pytest.mark.parametrize("content", [b"P5 4 4 255\nabc", b"P6 1 1 255\nabc", b"", b"P2 2 1 255\n1 x", b"P5 0 4 255\n"])
def test_a_broken_pgm_is_a_scene_error_with_its_name(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "bad.pgm").write_bytes(content)
    with pytest.raises(SceneError, match=r"bad\.pgm"):
        Scene.open(tmp_path / "bad.pgm", resolution=0.1)


def test_a_yaml_that_is_no_map_and_files_that_are_missing(tmp_path: Path) -> None:
    (tmp_path / "other.yaml").write_text("- 1\n", encoding="utf-8")
    with pytest.raises(SceneError, match="image and resolution"):
        Scene.open(tmp_path / "other.yaml")
    with pytest.raises(MotionFileNotFoundError, match=r"gone\.pgm"):
        Scene.open(described(tmp_path, image="gone.pgm"))
    with pytest.raises(MotionFileNotFoundError):
        Scene.open(tmp_path / "gone.yaml")


def test_options_of_the_other_kind_and_unknown_suffixes_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match="are for meshes"):
        Scene.open(described(tmp_path), scale=0.01)
    with pytest.raises(InvalidInputError, match="resolution= is for images without"):
        Scene.open(described(tmp_path), resolution=0.1)
    with pytest.raises(InvalidInputError, match="resolution= is for maps"):
        Scene.open("room.obj", resolution=0.1)
    with pytest.raises(InvalidInputError, match=r"known suffixes are \.obj"):
        Scene.open("room.docx")


def test_a_map_without_free_ground_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="nothing in the scene is walkable"):
        Scene.open(pgm(tmp_path / "wall.pgm", np.zeros((4, 4), dtype=int)), resolution=0.1)
