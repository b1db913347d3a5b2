"""Whole walks: from a start, standing or in motion, along a path, to a stand at its end."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path as FilePath

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.limits import check_place
from motionrt.locomotion.arguments import PathLikes, StartLike, as_path, as_place, as_start
from motionrt.locomotion.bearings import Place, apart, heading_along, place_of
from motionrt.locomotion.character import Character, Planner
from motionrt.locomotion.character_models import CharacterModels
from motionrt.locomotion.goal_frame import Goal
from motionrt.locomotion.path import Path, Waypoints
from motionrt.locomotion.path_following import Pace, Progress, walk_together
from motionrt.locomotion.terrain import Heights, on_plane
from motionrt.metrics.walk_report import LocomotionMeasures
from motionrt.motion import Motion
from motionrt.untrusted.arguments import check_flags, check_functions, checked_whole

_NAME = "walk"


@dataclass(frozen=True, eq=False, repr=False)
class Walk:
    """A walk along a path.

    Attributes:
        motion: all frames, 30 fps, in the world.
        path: where it should go.
        waypoints: the places along the path that it walked to one after the other.
        radius: metres within which a waypoint counted as reached.
        ground: ``(F,)`` metres, height of the ground under the character.
    """

    motion: Motion
    path: Path
    waypoints: Waypoints
    radius: float
    ground: Heights

    def __repr__(self) -> str:
        return f"Walk({self.path.length:.2f} m in {self.motion.duration:.2f} s, {len(self.waypoints)} waypoints)"

    def _repr_html_(self) -> str:
        """Measures and a strip of poses, for notebooks."""
        from motionrt.metrics.labelled import HEADER, labelled
        from motionrt.motion.notebook import page, strip, table

        return page(repr(self), strip(self.motion), table(HEADER, labelled(self.measures.as_dict())))

    @cached_property
    def measures(self) -> LocomotionMeasures:
        """How well it was walked."""
        return LocomotionMeasures.of(
            on_plane(self.motion.positions(), self.ground),
            self.motion.fps,
            self.path.points,
            self.waypoints.positions,
            radius=self.radius,
        )

    def save(self, path: str | FilePath) -> FilePath:
        """Write the motion (.bvh, .glb, .npz); returns the path."""
        return self.motion.save(path)


@dataclass(frozen=True, eq=False)
class WalkRequest:
    """Where a character is, and where it shall walk.

    Attributes:
        start: where it stands, or the motion that it goes on from.
        path: from there.
        heading: radians to face at the end; by default along the path.
    """

    start: Goal | Motion
    path: Path
    heading: float | None = None


def walk_request(
    start: StartLike | None,
    to: Sequence[float] | None = None,
    path: PathLikes | None = None,
    heading: float | None = None,
    scene: Planner | None = None,
) -> WalkRequest:
    """What somebody asks for: a walk to a place, or along a path.

    Raises:
        InvalidInputError: both or neither of ``to`` and ``path``, or the character is there already.
        PathError: there is no way.
    """
    check_place("heading", (), heading)
    if (to is None) == (path is None):
        raise InvalidInputError("say where to walk: either to=(x, z) or path=, one of them")
    given = as_path(path) if path is not None else None
    here = _place(as_start(start, given))
    found = given if given is not None else _way(here, as_place(() if to is None else to, "where to walk to"), scene)
    return WalkRequest(as_start(start, found), found, heading)


def run_walks(
    models: CharacterModels,
    requests: Sequence[WalkRequest],
    scene: Planner | None = None,
    *,
    pace: Pace | None = None,
    stop: bool = True,
    foot_lock: bool = True,
    seed: int = 0,
    progress: Progress | None = None,
) -> list[Walk]:
    """Let every character walk as asked; all walk together, one call of the model per frame.

    Args:
        models: the models.
        requests: one for each character.
        scene: finds the way to a path that begins elsewhere.
        pace: how they walk.
        stop: stand at the end; otherwise end in stride.
        foot_lock: let standing feet stand still.
        seed: of the small movements of those who stand.
        progress: told how many metres of how many are walked.
    """
    check_flags(stop=stop, foot_lock=foot_lock)
    check_functions(progress=progress)
    seed, pace = checked_whole(seed, "seed", 0), pace or Pace()
    characters = [Character(models, each.start, scene, pace, seed + i) for i, each in enumerate(requests)]
    ways = [who.way_along(each.path) for who, each in zip(characters, requests, strict=True)]
    until = characters[0].braking if stop else 0.0
    left = [who.leave(way, _NAME, until) for who, way in zip(characters, ways, strict=True)]
    _walk_rest(models, characters, left, pace.before_end(until), progress)
    if stop:
        for who, way, each in zip(characters, ways, requests, strict=True):
            x, z = way.points[-1]
            facing = heading_along(way, way.length) if each.heading is None else each.heading
            who.stop((float(x), float(z)), facing, _NAME)
    return [_walk_of(who, each, pace, foot_lock) for who, each in zip(characters, requests, strict=True)]


def _walk_rest(
    models: CharacterModels,
    characters: Sequence[Character],
    left: Sequence[Path | None],
    pace: Pace,
    progress: Progress | None,
) -> None:
    """All who have a way left to walk do so, together."""
    going = [(who, rest) for who, rest in zip(characters, left, strict=True) if rest is not None]
    if not going:
        return
    paths = [rest for _, rest in going]
    motions = walk_together(models.walk, [who.tail for who, _ in going], paths, pace, progress)
    for (who, rest), motion in zip(going, motions, strict=True):
        who.walked(motion, rest, _NAME)


def _walk_of(who: Character, asked: WalkRequest, pace: Pace, foot_lock: bool) -> Walk:
    done = who.performance(foot_lock=foot_lock)
    return Walk(done.motion, asked.path, asked.path.waypoints(pace.spacing), pace.radius, done.ground)


def _place(start: Goal | Motion) -> Place:
    return place_of(start) if isinstance(start, Motion) else (start.x, start.z)


def _way(start: Place, goal: Place, scene: Planner | None) -> Path:
    if apart(start, goal) < 0.05:
        raise InvalidInputError(f"the character is at x {goal[0]:.2f}, z {goal[1]:.2f} already: nothing to walk")
    return scene.plan(start, goal) if scene is not None else Path(np.array([start, goal], dtype=np.float32))
