"""A scene as the page draws it and as clicks meet it: floor, obstacles, a mesh, named points."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.locomotion.script_scene import SceneSpec
from motionrt.motion.skeleton import FloatArray
from motionrt.studio import picking, shapes

if TYPE_CHECKING:
    from motionrt.locomotion import Scene, Script, SemanticCloud
    from motionrt.locomotion.scene import Grid

SCRIPT_SUFFIXES = (".yaml", ".yml")
WALL, FOOTPRINT = 0.35, 0.02  # metres that obstacles are drawn high; only marked where points show what stands there
EDGE = 0.12  # metres of a wall that are drawn round a floor
_MAX_BOXES = 20_000


@dataclass(frozen=True, eq=False)
class Scenery:
    """A scene that is open.

    Attributes:
        spec: what a script says of it.
        scene: the ground.
        cloud: points with names, or None.
        cloud_file: where they were read.
    """

    spec: SceneSpec
    scene: Scene
    cloud: SemanticCloud | None = None
    cloud_file: Path | None = None

    @property
    def name(self) -> str:
        """What to call it on the page."""
        area = float(self.scene.grid.free.sum()) * self.scene.grid.cell**2
        what = self.spec.file.name if self.spec.file is not None else "floor plan"
        return f"{what}, {area:.0f} m² to walk on"

    @cached_property
    def triangles(self) -> FloatArray | None:
        """Corners ``(T, 3, 3)`` of the mesh, metres, Y up; None for maps and polygons."""
        from motionrt.locomotion.scene.mesh import read_triangles
        from motionrt.locomotion.scene.scene import MESH_SUFFIXES

        if self.spec.file is None or self.spec.file.suffix.lower() not in MESH_SUFFIXES:
            return None
        options = {key: self.spec.options[key] for key in ("up", "scale") if key in self.spec.options}
        return read_triangles(self.spec.file, **options).astype(np.float32)

    @cached_property
    def floor(self) -> shapes.Mesh:
        """The walkable ground, a little above itself."""
        grid = self.scene.grid
        return floor_mesh(grid.walkable, grid.height, grid.origin, grid.cell)

    @cached_property
    def obstacles(self) -> shapes.Mesh:
        """What stands in the way, as boxes; nothing for a mesh, which is drawn itself."""
        if self.triangles is not None:
            return shapes.joined([])
        height = WALL if self.cloud is None else FOOTPRINT
        return obstacle_mesh(self.scene.grid, height)

    @cached_property
    def things(self) -> FloatArray:
        """``(N, 3)`` points of the cloud that are not ground."""
        if self.cloud is None:
            return np.zeros((0, 3), np.float32)
        return self.cloud.obstacles(np.zeros(0, dtype=np.int64))

    def hit(self, origin: npt.ArrayLike, direction: npt.ArrayLike) -> FloatArray | None:
        """``(3,)`` where a ray first meets a thing, the mesh or the ground; None where it meets nothing."""
        level = float(np.nanmedian(self.scene.grid.height))
        found = [picking.ground_hit(origin, direction, level)]
        if len(self.things):
            found.append(picking.point_hit(origin, direction, self.things))
        if self.triangles is not None:
            found[0] = picking.triangle_hit(origin, direction, self.triangles)
        return picking.nearest(origin, found)


def open_scenery(file: Path) -> tuple[Scenery | None, Script | None]:
    """A scene and a script out of a file: a script (``.yaml`` with ``steps``), a map, or a mesh.

    Raises:
        ScriptError, SceneError, MotionFileNotFoundError, InvalidInputError: it cannot be read; the message says why.
    """
    if not file.is_file():
        raise InvalidInputError(f"there is no file {file}")
    if file.suffix.lower() in SCRIPT_SUFFIXES and is_script(file):
        from motionrt.locomotion import Script, load_cloud

        script = Script.read(file)
        if script.scene is None:
            return None, script
        cloud = None if script.cloud is None else load_cloud(script.cloud)
        return Scenery(script.scene, script.scene.open(), cloud, script.cloud), script
    spec = SceneSpec(file=file)
    return Scenery(spec, spec.open()), None


def is_script(file: Path) -> bool:
    """Whether a YAML file holds a script rather than a map."""
    from motionrt.locomotion.script_nodes import read_nodes

    value = read_nodes(file).value
    return isinstance(value, dict) and not ("image" in value and "steps" not in value)


def is_plan(file: Path) -> bool:
    """Whether a file holds a plan of texts rather than a script, a map or a mesh."""
    from motionrt.locomotion.script_nodes import read_nodes

    if file.suffix.lower() == ".json":
        return True
    if file.suffix.lower() not in SCRIPT_SUFFIXES:
        return False
    value = read_nodes(file).value
    return isinstance(value, dict) and "steps" not in value and bool({"timeline", "targets", "keyframes"} & set(value))


def floor_mesh(
    walkable: npt.NDArray[np.bool_], height: npt.NDArray[np.float32], origin: npt.NDArray[np.float64], cell: float
) -> shapes.Mesh:
    """Rectangles over all walkable cells: few where the ground is flat, one a cell where it is not."""
    blocks = rectangles(walkable, np.nan_to_num(height).round(2).astype(np.float32))
    if not len(blocks):
        return shapes.joined([])
    level = height[blocks[:, 0], blocks[:, 1]]
    low, high = origin + cell * blocks[:, [1, 0]], origin + cell * blocks[:, [3, 2]]
    corners = [(low[:, 0], low[:, 1]), (low[:, 0], high[:, 1]), (high[:, 0], high[:, 1]), (high[:, 0], low[:, 1])]
    vertices = np.stack([np.stack([x, level, z], axis=1) for x, z in corners], axis=1).reshape(-1, 3)
    quad = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32)
    faces = quad[None] + 4 * np.arange(len(blocks), dtype=np.uint32)[:, None, None]
    return vertices.astype(np.float32), faces.reshape(-1, 3).astype(np.uint32)


def obstacle_mesh(grid: Grid, height: float) -> shapes.Mesh:
    """Boxes over the cells that are not walkable: those inside the floor whole, those around it as an edge."""
    from scipy.ndimage import binary_dilation, label

    blocked = np.pad(~grid.walkable, 1, constant_values=True)
    regions, _ = label(blocked)
    outside = regions == regions[0, 0]
    reach = max(1, round(EDGE / grid.cell))
    edge = outside & binary_dilation(~blocked, iterations=reach)
    shown = (blocked & ~outside) | edge
    blocks = rectangles(shown, np.where(outside, np.float32(1), np.float32(0)))[:_MAX_BOXES]
    low = grid.origin + grid.cell * (blocks[:, [1, 0]] - 1)
    high = grid.origin + grid.cell * (blocks[:, [3, 2]] - 1)
    level = float(np.nanmedian(grid.height))
    tops = level + np.where(outside[blocks[:, 0], blocks[:, 1]], min(height, 0.08), height)
    lows = np.insert(low, 1, level, axis=1).astype(np.float32)
    return shapes.boxes(lows, np.stack([high[:, 0], tops, high[:, 1]], axis=1).astype(np.float32))


def rectangles(cells: npt.NDArray[np.bool_], kinds: npt.NDArray[np.float32]) -> npt.NDArray[np.int64]:
    """``(N, 4)`` blocks (first row, first column, end row, end column) that cover the true ``cells`` once.

    A block has one value of ``kinds``. Runs of a row are joined with equal runs of the rows above.
    """
    done: list[tuple[int, int, int, int]] = []
    open_runs: dict[tuple[int, int, float], int] = {}
    for row in range(len(cells) + 1):
        runs = _runs(cells[row], kinds[row]) if row < len(cells) else set()
        ended = [run for run in open_runs if run not in runs]
        done += [(open_runs.pop(run), run[0], row, run[1]) for run in ended]
        for run in runs:
            open_runs.setdefault(run, row)
    return np.array(sorted(done), dtype=np.int64).reshape(-1, 4)


def _runs(cells: npt.NDArray[np.bool_], kinds: npt.NDArray[np.float32]) -> set[tuple[int, int, float]]:
    """Stretches (first, end, kind) of true cells of one kind."""
    key = np.where(cells, kinds, np.inf)
    edges = np.flatnonzero(np.append(True, key[1:] != key[:-1]))
    ends = np.append(edges[1:], len(cells))
    return {(int(a), int(b), float(key[a])) for a, b in zip(edges, ends, strict=True) if cells[a]}
