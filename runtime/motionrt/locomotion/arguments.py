"""What callers may give for a path, a scene or a start, made into one thing each."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.locomotion.bearings import Place, heading_along
from motionrt.locomotion.character import Planner
from motionrt.locomotion.goal_frame import Goal
from motionrt.locomotion.path import Path
from motionrt.motion import Motion
from motionrt.untrusted.arguments import checked_number, listed
from motionrt.untrusted.words import shown

if TYPE_CHECKING:
    from motionrt.locomotion.words import SemanticCloud

PathLikes = Path | str | FilePath | npt.ArrayLike
SceneLike = Planner | str | FilePath
StartLike = Goal | Sequence[float] | Motion


def as_path(path: PathLikes) -> Path:
    """A path, its file (CSV of x and z), or its points ``(N, 2)``."""
    if isinstance(path, Path):
        return path
    return Path.from_csv(path) if isinstance(path, str | PathLike) else Path(path)  # type: ignore[arg-type]


def as_scene(scene: SceneLike | None) -> Planner | None:
    """A scene, or its file: a mesh or an occupancy map; None for open ground."""
    return None if scene is None else opened_scene(scene)


def opened_scene(scene: SceneLike) -> Planner:
    """A scene, or its file: a mesh or an occupancy map."""
    if isinstance(scene, str | PathLike):
        from motionrt.locomotion.scene import Scene

        return Scene.open(scene)
    if isinstance(scene, type) or not callable(getattr(scene, "plan", None)):
        raise InvalidInputError(f"a scene is a Scene, or the file of a mesh or a map, not {shown(scene)}")
    return scene


def as_cloud(cloud: SemanticCloud | str | FilePath | None) -> SemanticCloud | None:
    """A semantic point cloud, or its file."""
    from motionrt.locomotion.words import SemanticCloud, load_cloud

    if cloud is None or isinstance(cloud, SemanticCloud):
        return cloud
    return load_cloud(cloud)


def as_place(place: Sequence[float], what: str = "a place") -> Place:
    """Two finite numbers, x and z; InvalidInputError otherwise."""
    numbers = _numbers(place)
    if len(numbers) != 2:
        raise InvalidInputError(f"{what} is x and z in metres, as in (2.0, 5.5), not {shown(place)}")
    return numbers[0], numbers[1]


def as_goal(goal: Goal | Sequence[float]) -> Goal:
    """A goal, or (x, z), or (x, z, heading)."""
    found = as_start(goal)
    if not isinstance(found, Goal):
        raise InvalidInputError("a goal is a place (x, z) or (x, z, heading), not a motion")
    return found


def as_start(start: StartLike | None, path: Path | None = None) -> Goal | Motion:
    """Where a character begins: without a heading along ``path``, without a place at the start of ``path``."""
    if isinstance(start, Goal | Motion):
        return start
    if start is None:
        start = (0.0, 0.0) if path is None else [float(x) for x in path.points[0]]
    numbers = _numbers(start)
    if len(numbers) not in {2, 3}:
        raise InvalidInputError(
            f"a start is (x, z) in metres, (x, z, heading) with radians, a Goal or a Motion, not {shown(start)}"
        )
    along = 0.0 if path is None else heading_along(path, 0.0)
    return Goal(numbers[0], numbers[1], numbers[2] if len(numbers) == 3 else along)


def _numbers(values: Sequence[float]) -> list[float]:
    try:
        return [checked_number(value, "a place") for value in listed(values, "a place", "numbers")]
    except InvalidInputError:
        return []
