"""``Scene``: ground that a character walks on, with everything that stands in its way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path as FilePath

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError, SceneError
from motionrt.locomotion.path import Path
from motionrt.locomotion.scene import building
from motionrt.locomotion.scene.agent import Agent
from motionrt.locomotion.scene.grid import BoolArray, Grid
from motionrt.locomotion.scene.mesh import MeshArrays, UpAxis
from motionrt.locomotion.scene.penalty import Penalty
from motionrt.locomotion.scene.planner import Planner
from motionrt.locomotion.scene.polygons import Polygons
from motionrt.locomotion.scene.routes import random_route
from motionrt.motion.skeleton import FloatArray
from motionrt.untrusted.arguments import (
    check_flags,
    check_kind,
    checked_array,
    checked_number,
    checked_up,
    listed,
    real,
)
from motionrt.untrusted.files import as_path
from motionrt.untrusted.words import shown

MESH_SUFFIXES = (".obj", ".ply", ".glb", ".gltf", ".stl", ".off")
MAP_SUFFIXES = (".yaml", ".yml", ".pgm", ".png", ".bmp", ".jpg", ".jpeg", ".tif", ".tiff")


@dataclass(frozen=True, eq=False)
class Scene:
    """Walkable ground in cells. Places are (x, z) metres on the ground plane, Y is up.

    Attributes:
        grid: walkable and free cells, heights, clearances.
        agent: who walks there.

    Raises:
        SceneError: nothing in it is walkable.
    """

    grid: Grid
    agent: Agent

    def __post_init__(self) -> None:
        if not self.grid.walkable.any():
            raise SceneError("nothing in the scene is walkable")

    def __repr__(self) -> str:
        area = self.grid.free.sum() * self.grid.cell**2
        return f"Scene({area:.1f} m2 free for a radius of {self.agent.radius:g} m, cells of {self.grid.cell:g} m)"

    @classmethod
    def open(
        cls,
        path: str | FilePath,
        *,
        agent: Agent | None = None,
        resolution: float | None = None,
        cell: float | None = None,
        start: npt.ArrayLike | None = None,
        up: UpAxis = "y",
        scale: float = 1.0,
    ) -> Scene:
        """Read a mesh or an occupancy map, whichever the suffix says; see :meth:`from_mesh` and :meth:`from_map`.

        Raises:
            MotionFileNotFoundError: there is no such file.
            SceneError: it cannot be read, or nothing in it is walkable.
            InvalidInputError: an unknown suffix, or an option that does not belong to such files.
        """
        suffix = as_path(path).suffix.lower()
        if suffix in MESH_SUFFIXES:
            if resolution is not None:
                raise InvalidInputError("resolution= is for maps; the cells of a mesh are set by cell=")
            size = building.MESH_CELL if cell is None else cell
            return cls.from_mesh(path, agent=agent, cell=size, start=start, up=up, scale=scale)
        if suffix not in MAP_SUFFIXES:
            known = ", ".join(MESH_SUFFIXES + MAP_SUFFIXES)
            raise InvalidInputError(f"cannot tell what kind of scene {path} is: known suffixes are {known}")
        checked_up(up)
        if cell is not None or start is not None or up != "y" or real(scale) != 1:
            raise InvalidInputError("cell=, start=, up= and scale= are for meshes; a map's scale is its resolution")
        return cls.from_map(path, agent=agent, resolution=resolution)

    @classmethod
    def from_mesh(
        cls,
        source: str | FilePath | MeshArrays,
        *,
        agent: Agent | None = None,
        cell: float = building.MESH_CELL,
        start: npt.ArrayLike | None = None,
        up: UpAxis = "y",
        scale: float = 1.0,
        double_sided: bool = False,
    ) -> Scene:
        """The floor of a triangle mesh that is connected, by steps and ramps that the agent can take, to ``start``.

        Args:
            source: a file (OBJ, PLY, GLB, ...; needs ``pip install "motionrt[scene]"``), or vertices ``(V, 3)`` and
                faces ``(T, 3)``.
            agent: sizes of the walker.
            cell: edge of the grid's cells, metres.
            start: (x, z) or, where storeys lie above one another, (x, y, z), metres, on the wanted floor. Without it
                the largest connected floor is taken. Of storeys that stairs join, a place keeps the one nearer to the
                start.
            up: "y" or "z", the axis of the source that points up; z becomes y, and y becomes -z.
            scale: metres per unit of the source.
            double_sided: take faces that look down for ground too, for meshes wound the wrong way round.
        """
        who = _agent(agent)
        check_flags(double_sided=double_sided)
        grid = building.mesh_grid(source, who, cell=cell, start=start, up=up, scale=scale, double_sided=double_sided)
        return cls(grid, who)

    @classmethod
    def from_map(
        cls,
        path: str | FilePath,
        *,
        agent: Agent | None = None,
        resolution: float | None = None,
        unknown_free: bool = False,
    ) -> Scene:
        """An occupancy map as in ROS: map x is x, map y is -z (:mod:`motionrt.locomotion.scene.ros_map`).

        Args:
            path: the YAML, or its image (PGM; PNG and others need ``pip install "motionrt[scene]"``).
            agent: sizes of the walker; only radius and comfort matter.
            resolution: metres per pixel, for an image without YAML; its lower left corner is the origin.
            unknown_free: walk on unexplored ground too.
        """
        who = _agent(agent)
        check_flags(unknown_free=unknown_free)
        return cls(building.map_grid(as_path(path), who, resolution, unknown_free=unknown_free), who)

    @classmethod
    def from_polygons(
        cls, outlines: Polygons, obstacles: Polygons = (), *, agent: Agent | None = None, cell: float = 0.05
    ) -> Scene:
        """Flat ground inside any of ``outlines`` and outside all ``obstacles``: polygons ``(N, 2)``, (x, z) metres."""
        who, outlines, obstacles = _agent(agent), _listed(outlines, "outlines"), _listed(obstacles, "obstacles")
        return cls(building.polygon_grid(outlines, obstacles, who, cell), who)

    @classmethod
    def from_cells(
        cls, walkable: BoolArray, cell: float, *, origin: tuple[float, float] = (0.0, 0.0), agent: Agent | None = None
    ) -> Scene:
        """Flat ground where ``walkable`` ``(H, W)`` says so: rows along z, columns along x, from ``origin`` (x, z)."""
        who = _agent(agent)
        walkable = checked_array(walkable, "walkable", "truth values (H, W)") != 0
        corner = checked_array(origin, "origin", "(x, z) in metres")
        if corner.shape != (2,) or not np.isfinite(corner).all():
            raise InvalidInputError(f"origin must be two finite numbers, not {shown(origin)}")
        return cls(building.flat_grid(walkable, corner, cell, who), who)

    @property
    def bounds(self) -> FloatArray:
        """``(2, 2)`` lowest and highest (x, z) of the grid, metres."""
        low = self.grid.origin
        return np.stack([low, low + np.array(self.grid.shape[::-1]) * self.grid.cell]).astype(np.float32)

    def free(self, xz: npt.ArrayLike) -> BoolArray:
        """Whether the agent may stand at places ``[..., 2]``: no obstacle is within its radius."""
        return self.grid.is_free(xz)

    def clearance(self, xz: npt.ArrayLike) -> FloatArray:
        """Metres ``[...]`` from places ``[..., 2]`` to the next obstacle or edge, to half a cell; 0 in and outside."""
        return self.grid.clearance_at(xz)

    def height(self, xz: npt.ArrayLike) -> FloatArray:
        """Height in metres ``[...]`` of the ground at places ``[..., 2]``; NaN where there is none."""
        return self.grid.height_at(xz)

    @cached_property
    def _planner(self) -> Planner:
        return Planner(self.grid, Penalty(max(self.agent.comfort, self.agent.radius)))

    def plan(
        self, start: npt.ArrayLike, goal: npt.ArrayLike, *, via: Sequence[npt.ArrayLike] = (), snap: float = 0.5
    ) -> Path:
        """A path from ``start`` to ``goal``, both (x, z) metres, that keeps away from obstacles where there is room.

        A* over 8 neighbours, shortcuts where the straight way is no worse, corners rounded. A start or goal on open
        ground but nearer to an obstacle than the radius is walked to nevertheless; one inside an obstacle is moved to
        the next free ground. Either is said in the path's ``notes``.

        Args:
            start: where to begin.
            goal: where to arrive.
            via: places to pass on the way; corners there are rounded too, so the path may miss them by a little.
            snap: metres within which the start and the goal may be moved.

        Raises:
            PathError: there is no way; the message says whether an end is in an obstacle or outside, or else how wide
                the narrowest place of the widest way is.
        """
        places = [start, *listed(via, "via", "places (x, z)"), goal]
        return self._planner.plan(places, checked_number(snap, "snap", 0.0))

    def random_path(self, length: float, seed: int = 0) -> Path:
        """A path of ``length`` metres through random free places of the largest area, the same for the same seed."""
        return random_route(self._planner, length, seed)


def _agent(agent: Agent | None) -> Agent:
    if agent is None:
        return Agent()
    check_kind(agent, Agent, "agent", "an Agent")
    return agent


def _listed(polygons: Polygons, name: str) -> Polygons:
    return listed(polygons, name, "polygons (N, 2)")
