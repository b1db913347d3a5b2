"""From meshes, maps and polygons to grids."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError, SceneError
from motionrt.limits import how_to_raise, limits
from motionrt.locomotion.scene.agent import Agent
from motionrt.locomotion.scene.floors import nearest_floor, reachable_floor, standing_places
from motionrt.locomotion.scene.grid import BoolArray, Grid, Points
from motionrt.locomotion.scene.mesh import MeshArrays, UpAxis, read_triangles
from motionrt.locomotion.scene.polygons import Polygons, draw_polygons
from motionrt.locomotion.scene.ros_map import map_info, read_map
from motionrt.locomotion.scene.surface import sample_surface
from motionrt.untrusted.arguments import checked_array, real
from motionrt.untrusted.words import shown

MESH_CELL = 0.1


def flat_grid(walkable: BoolArray, origin: Points, cell: float, agent: Agent) -> Grid:
    """Ground at height 0."""
    if walkable.ndim != 2 or not walkable.size:
        raise InvalidInputError(f"walkable cells must have the shape (H, W), not {walkable.shape}")
    if not 0 < real(cell) < np.inf:
        raise InvalidInputError(f"cell must be a positive number of metres, not {shown(cell)}")
    if walkable.size > limits().cells:
        raise SceneError(f"{walkable.shape[1]} x {walkable.shape[0]} cells are too many: {how_to_raise('cells')}")
    return Grid(walkable, np.where(walkable, 0, np.nan).astype(np.float32), origin, cell, agent.radius)


def map_grid(path: Path, agent: Agent, resolution: float | None, *, unknown_free: bool) -> Grid:
    """The ground of an occupancy map."""
    info = map_info(path, resolution)
    walkable, origin = read_map(info, unknown_free=unknown_free)
    return flat_grid(walkable, origin, info.resolution, agent)


def polygon_grid(outlines: Polygons, obstacles: Polygons, agent: Agent, cell: float) -> Grid:
    """The ground of outlines with obstacles."""
    walkable, origin = draw_polygons(outlines, obstacles, cell)
    return flat_grid(walkable, origin, cell, agent)


def mesh_grid(
    source: str | Path | MeshArrays,
    agent: Agent,
    *,
    cell: float,
    start: npt.ArrayLike | None,
    up: UpAxis,
    scale: float,
    double_sided: bool,
) -> Grid:
    """The ground of a mesh that is connected to ``start``."""
    triangles = read_triangles(source, up=up, scale=scale)
    patches = sample_surface(triangles, cell, agent.max_slope, double_sided=double_sided)
    floors = standing_places(patches, cell, agent)
    first = None if start is None else nearest_floor(floors, patches.centres(floors.cell, cell), _start(start))
    walkable, height = reachable_floor(floors, patches.shape, agent, first)
    return Grid(walkable, height, patches.origin, cell, agent.radius)


def _start(start: npt.ArrayLike) -> Points:
    place = checked_array(start, "start", "(x, z) or (x, y, z) in metres")
    if place.shape not in {(2,), (3,)} or not np.isfinite(place).all():
        raise InvalidInputError(f"start must be (x, z) or (x, y, z) in metres, not {shown(start)}")
    return place
