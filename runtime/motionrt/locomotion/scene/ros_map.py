"""Occupancy maps as ROS keeps them: an image, and a YAML file that says what its pixels mean.

The map's plane is x right, y up the image, z towards the reader; motionrt's ground has Y up. Both are right-handed, so
the one is turned into the other without mirroring: **map x is x, map y is -z**. An image row further down is a larger
z, and a map heading ``yaw`` (from x towards y) is the heading ``yaw + pi/2`` (from +Z towards +X).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, cast

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError, SceneError
from motionrt.limits import how_to_raise, limits
from motionrt.locomotion.scene.grid import BoolArray, Points
from motionrt.locomotion.scene.images import Grey, read_grey
from motionrt.locomotion.scene.optional import require_scene_file
from motionrt.motion.skeleton import FloatArray
from motionrt.untrusted import yaml_text
from motionrt.untrusted.files import beside, read_utf8
from motionrt.untrusted.words import shown

Mode = Literal["trinary", "scale", "raw"]
_BATCH = 1_000_000  # cells of a turned map in memory at once


@dataclass(frozen=True)
class MapInfo:
    """What a map's YAML says.

    Attributes:
        image: the picture.
        resolution: metres per pixel.
        origin: map x and y in metres, and yaw in radians, of the lower left corner of the picture.
        negate: light is occupied, dark is free.
        occupied: occupancy above which a pixel is an obstacle; nothing between the two thresholds is free either.
        free: occupancy below which a pixel is free. 0.196 leaves the customary grey 205 unknown.
        mode: what a pixel means. ``raw`` pixels are occupancies in percent, above 100 unknown; the others are shades.
    """

    image: Path
    resolution: float
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    negate: bool = False
    occupied: float = 0.65
    free: float = 0.196
    mode: Mode = "trinary"

    def __post_init__(self) -> None:
        if not (math.isfinite(self.resolution) and self.resolution > 0):
            raise SceneError(f"resolution must be a positive number of metres per pixel, not {self.resolution}")
        if not all(map(math.isfinite, self.origin)):
            raise SceneError(f"origin must be three finite numbers (x, y, yaw), not {self.origin}")
        if max(self.resolution, *map(abs, self.origin)) > limits().metres:
            raise SceneError(f"resolution or origin is too large to be metres: {how_to_raise('metres')}")
        if not 0 <= self.free <= self.occupied <= 1:
            raise SceneError(f"need 0 <= free_thresh <= occupied_thresh <= 1, not {self.free} and {self.occupied}")


def from_map(xy: npt.ArrayLike) -> FloatArray:
    """Map coordinates ``[..., 2]`` (x, y) metres to the ground plane (x, z)."""
    return (np.asarray(xy, dtype=np.float64) * (1, -1)).astype(np.float32)


def to_map(xz: npt.ArrayLike) -> FloatArray:
    """Ground plane ``[..., 2]`` (x, z) metres to map coordinates (x, y): the inverse of :func:`from_map`."""
    return from_map(xz)


def read_map_info(path: Path) -> MapInfo:
    """Read and check a map's YAML.

    Raises:
        MotionFileNotFoundError: there is no such file.
        SceneError: a key is missing or has a wrong value; names file and key.
    """
    import yaml

    def fail(reason: str, line: int | None) -> SceneError:
        return SceneError(f"{path}{f':{line}' if line else ''}: {reason}")

    require_scene_file(path)
    fields = yaml_text.parse(read_utf8(path, fail, "yaml_bytes"), yaml.SafeLoader, fail)
    if not isinstance(fields, dict) or not {"image", "resolution"} <= fields.keys():
        raise SceneError(f"{path} is not a map: it needs at least the keys image and resolution")
    try:
        return _info(fields, path)
    except SceneError as error:
        raise SceneError(f"{path}: {error}") from error


def _info(fields: dict[str, Any], path: Path) -> MapInfo:
    origin = fields.get("origin", (0, 0, 0))
    if not isinstance(origin, list | tuple) or len(origin) != 3:
        raise SceneError(f"origin must be three numbers (x, y, yaw), not {shown(origin)}")
    mode = fields.get("mode", "trinary")
    if mode not in ("trinary", "scale", "raw"):
        raise SceneError(f"mode {shown(mode)} is none of trinary, scale, raw")
    image = fields["image"]
    if not isinstance(image, str) or not image.strip():
        raise SceneError(f"image must be the name of a picture, not {shown(image)}")
    x, y, yaw = (_number(value, "origin", "three finite numbers (x, y, yaw)") for value in origin)
    return MapInfo(
        image=beside(path.parent, image, lambda reason, _: SceneError(reason)),
        resolution=_number(fields["resolution"], "resolution"),
        origin=(x, y, yaw),
        negate=bool(_number(fields.get("negate", 0), "negate")),
        occupied=_number(fields.get("occupied_thresh", 0.65), "occupied_thresh"),
        free=_number(fields.get("free_thresh", 0.196), "free_thresh"),
        mode=cast("Mode", mode),
    )


def _number(value: object, key: str, what: str = "a finite number") -> float:
    """A finite number; one in quotes counts, as do true and false for ``negate``."""
    try:
        number = float(value) if isinstance(value, str | int | float) else math.nan
    except (ValueError, OverflowError):
        number = math.nan
    if not math.isfinite(number):
        raise SceneError(f"{key} must be {what}, not {shown(value)}")
    return number


def free_pixels(grey: Grey, info: MapInfo, *, unknown_free: bool = False) -> BoolArray:
    """Which pixels ``(H, W)`` of a map are free ground: ``p = (255 - grey) / 255`` below the threshold.

    Args:
        grey: 0..255; NaN is unknown.
        info: thresholds and mode.
        unknown_free: take unknown ground, all that is neither free nor occupied, for free.
    """
    if info.mode == "raw":
        occupancy = np.where(grey > 100.5, np.nan, grey / 100)
    else:
        occupancy = grey / 255 if info.negate else (255 - grey) / 255
    if unknown_free:
        return np.asarray(~(occupancy > info.occupied))
    return np.asarray(occupancy < info.free)


def read_map(info: MapInfo, *, unknown_free: bool = False) -> tuple[BoolArray, Points]:
    """Free cells ``(H, W)`` of a map, rows along z, and origin (x, z); turned upright if the map has a yaw."""
    free = free_pixels(read_grey(info.image), info, unknown_free=unknown_free)
    x, y, yaw = info.origin
    if abs(math.remainder(yaw, 2 * math.pi)) < 1e-9:
        return free, np.array([x, -y - len(free) * info.resolution])
    return _turned(free, info)


def _turned(free: BoolArray, info: MapInfo) -> tuple[BoolArray, Points]:
    """A turned map on upright cells: each takes the pixel under its centre, rows in batches."""
    x, y, yaw = info.origin
    right, up = np.array([math.cos(yaw), -math.sin(yaw)]), np.array([-math.sin(yaw), -math.cos(yaw)])  # as (x, z)
    height, width = free.shape
    edges = [a * width * info.resolution * right + b * height * info.resolution * up for a in (0, 1) for b in (0, 1)]
    low = np.array([x, -y]) + np.min(edges, axis=0)
    columns, rows = np.ceil(np.ptp(edges, axis=0) / info.resolution - 1e-6).astype(int)
    if columns * rows > limits().cells:
        raise SceneError(f"the turned map needs {columns} x {rows} cells: {how_to_raise('cells')}")
    turned = np.zeros((rows, columns), dtype=bool)
    for first in range(0, rows, step := max(1, _BATCH // columns)):
        places = np.stack(np.meshgrid(np.arange(columns), np.arange(first, min(first + step, rows))), axis=-1) + 0.5
        offsets = low + places * info.resolution - (x, -y)
        column = np.floor(offsets @ right / info.resolution).astype(int)
        row = height - 1 - np.floor(offsets @ up / info.resolution).astype(int)
        inside = (column >= 0) & (row >= 0) & (column < width) & (row < height)
        turned[first : first + step] = inside & free[np.where(inside, row, 0), np.where(inside, column, 0)]
    return turned, low


def map_info(path: Path, resolution: float | None) -> MapInfo:
    """What to know about a map file: a YAML says it itself, an image is explained by ``resolution`` or its YAML."""
    if path.suffix.lower() in {".yaml", ".yml"}:
        if resolution is not None:
            raise InvalidInputError("resolution= is for images without a YAML file; the YAML says it itself")
        return read_map_info(path)
    require_scene_file(path)
    if resolution is not None:
        return MapInfo(path, resolution)
    for described in (path.with_suffix(".yaml"), path.with_suffix(".yml")):
        if described.exists():
            return read_map_info(described)
    raise SceneError(f"{path} has no YAML file beside it: give resolution= in metres per pixel")
