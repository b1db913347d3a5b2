"""Walks along paths, from a start to an end: the loop around :class:`motionrt.locomotion.crowd.Crowd`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError, WalkError
from motionrt.locomotion.crowd import FPS, SPEED, Crowd, NextFrame, history_of, to_motion
from motionrt.locomotion.gliding import Gait
from motionrt.locomotion.leading import MOST, MOST_HURRIED, helped, led, slowed
from motionrt.locomotion.path import Path
from motionrt.locomotion.waypoints import RADIUS, WaypointTargets
from motionrt.motion import Motion
from motionrt.motion.rotations import wrapped
from motionrt.untrusted.arguments import real
from motionrt.untrusted.words import shown

WALKS_TO = 1.5  # m/s: feet of who runs glide more, and that is no reason to change the gait
SPACING = 1.0  # metres between waypoints
ARRIVED = 0.1  # metres from the end of a path that are as good as there
CIRCLES_S, TURNED = 1.0, 1.5  # such seconds after which who circles is helped more, and how much
PATIENCE_S = 8.0  # seconds without coming nearer to a waypoint after which a character is stuck
BEHIND, MISSED = 1.3, 2.0  # radians aside that are behind, and radii from a waypoint that are missed by little
LEAVING = 0.05  # metres farther than before that somebody is who leaves
_STRAIGHT = 75  # per cent of the seconds of a walk that are not the straightest and quickest
NEARER = 0.02  # metres that count as nearer

Progress = Callable[[int, int, str], None]
"""Told now and then how much is done, of how much (metres of a walk, per cent of actions), and what is being done."""


@dataclass(frozen=True)
class Pace:
    """How a path is walked.

    Attributes:
        speed: metres per second.
        spacing: metres between the waypoints that the path is cut into.
        radius: metres within which a waypoint counts as reached.
        until: metres before the end of the path at which the walk breaks off; 0 walks to the end.
    """

    speed: float = SPEED
    spacing: float = SPACING
    radius: float = RADIUS
    until: float = 0.0

    def before_end(self, metres: float) -> Pace:
        """The same, breaking off so many metres before the end."""
        return replace(self, until=metres)

    def __post_init__(self) -> None:
        if not (0.3 <= real(self.speed) <= 5.0):
            raise InvalidInputError(
                f"speed must lie between 0.3 and 5 m/s (walking: 0.8 to 1.6), not {shown(self.speed)}"
            )
        if not (real(self.spacing) > 0 and real(self.radius) > 0 and real(self.until) >= 0):
            raise InvalidInputError("spacing and radius must be above 0 m, until not below")


def walk(
    model: NextFrame, start: Motion, path: Path, pace: Pace | None = None, progress: Progress | None = None
) -> Motion:
    """Walk along a path; see :func:`walk_together`."""
    return walk_together(model, [start], [path], pace, progress)[0]


def walk_together(
    model: NextFrame,
    starts: Sequence[Motion],
    paths: Sequence[Path],
    pace: Pace | None = None,
    progress: Progress | None = None,
) -> list[Motion]:
    """Let characters walk, each along its path, all in one call of the model per frame.

    Args:
        model: predicts next frames.
        starts: what each did in the last second, 30 fps, in the world.
        paths: where each walks.
        pace: how, the same for all.
        progress: told every second how many metres are walked.

    Returns:
        The new frames of each, 30 fps; a walk ends at the end of its path, or where that has just been passed.

    Raises:
        WalkError: a character does not come nearer to its next waypoint for eight seconds, or walks off the numbers.
        InvalidInputError: not as many starts as paths, or a start at another rate than 30 fps.
    """
    if len(starts) != len(paths) or not paths:
        raise InvalidInputError(f"give one start for every path: {len(starts)} for {len(paths)}")
    pace = pace or Pace()
    trips = [_Trip(path, pace, motion.root[-1, [0, 2]]) for path, motion in zip(paths, starts, strict=True)]
    crowd = Crowd(model, np.stack([history_of(motion) for motion in starts]))
    walking = list(trips)
    while walking:
        stays = np.array([trip.goes_on(xz) for trip, xz in zip(walking, crowd.positions, strict=True)])
        if not stays.all():
            crowd.keep(stays)
            walking = [trip for trip, stay in zip(walking, stays, strict=True) if stay]
            continue
        aims = np.stack([trip.goal for trip in walking])
        crowd.history = helped(aims, crowd.history, np.array([trip.help for trip in walking]))
        goals = led(aims, crowd.history[:, -1])
        speeds = slowed(aims, crowd.history[:, -1], max(pace.speed, SPEED))
        for trip, frame in zip(walking, crowd.step(goals, speeds), strict=True):
            trip.gait.show(frame)
        if pace.speed <= WALKS_TO:
            revived = [trip.gait.revived(seen) for trip, seen in zip(walking, crowd.history, strict=True)]
            crowd.history = np.stack(revived)
        _tell(progress, trips)
    return [in_time(trip.walked(), pace.speed) for trip in trips]


def in_time(motion: Motion, speed: float) -> Motion:
    """``motion`` played so much faster or slower that it goes at ``speed`` m/s where nothing slows it.

    Networks walk best at the speeds of their training data: asked for less they glide, and all are a little slow.
    """
    share = min(1.0, speed / SPEED)
    second = int(FPS)
    if motion.frames > 2 * second:
        way = np.cumsum(np.linalg.norm(np.diff(motion.root[:, [0, 2]], axis=0), axis=1))
        share = min(MOST_HURRIED, speed / float(np.percentile(way[second:] - way[:-second], _STRAIGHT)))
    return motion if share == 1.0 else replace(motion, fps=FPS * share).resample(FPS)


class _Trip:
    """One character's way: its waypoints, what it walked, and whether it is there."""

    def __init__(self, path: Path, pace: Pace, place: npt.NDArray[np.floating]) -> None:
        marks = path.waypoints(pace.spacing)
        self.pace, self.path = pace, path
        self.routes = WaypointTargets([np.column_stack([marks.positions, marks.headings])], pace.radius)
        self.end = path.at(path.length)
        self.gait = Gait()
        self.goal = self.routes.goals(place[None])[0]
        self._best, self._best_frame, self._mark = np.inf, 0, -1

    @property
    def frames(self) -> list[npt.NDArray[np.float64]]:
        """What was walked."""
        return self.gait.frames

    def goes_on(self, xz: npt.NDArray[np.float64]) -> bool:
        """Whether there is more to walk from here; picks the next goal."""
        self._leave_behind(xz)
        self.goal = self.routes.goals(xz[None])[0]
        away = float(np.hypot(*(self.goal[:2] - xz)))
        if self.routes.index[0] != self._mark:
            self._mark, self._best = self.routes.index[0], np.inf
        if away < self._best - NEARER:
            self._best, self._best_frame = away, len(self.frames)
        if self._there(away, xz):
            return False
        self._check_progress(away, xz)
        return True

    def _leave_behind(self, xz: npt.NDArray[np.float64]) -> None:
        """A waypoint that was missed by little and lies behind is not turned round for, unless it is the last."""
        if not self.frames or self.routes.ends()[0]:
            return
        way = self.goal[:2] - xz
        behind = abs(float(wrapped(np.arctan2(way[0], way[1]) - np.arctan2(*self.frames[-1][[2, 8]])))) > BEHIND
        away = float(np.hypot(*way))
        if behind and self._best + LEAVING < away < MISSED * self.pace.radius:
            self.routes.index[0] += 1

    def _there(self, away: float, xz: npt.NDArray[np.float64]) -> bool:
        """Within reach of the end, or just past it."""
        if away + self.path.length - self.done(1) <= max(self.pace.until, ARRIVED):
            return True
        if not self.routes.ends()[0]:
            return False
        x, z = xz - self.goal[:2]
        passed = x * np.sin(self.goal[2]) + z * np.cos(self.goal[2]) > 0
        return bool(passed and away < self.pace.radius * 3 and len(self.frames) > self._best_frame)

    @property
    def help(self) -> float:
        """Radians a frame by which the walk may be bent: more for who circles round a waypoint."""
        idle = (len(self.frames) - self._best_frame) / FPS
        return MOST * (1.0 + min(1.0, max(0.0, idle - CIRCLES_S)) * (TURNED - 1.0))

    def _check_progress(self, away: float, xz: npt.NDArray[np.float64]) -> None:
        if len(self.frames) - self._best_frame > PATIENCE_S * FPS:
            raise WalkError(
                f"the character stays {away:.2f} m from waypoint {self._mark + 1} of "
                f"{len(self.routes.waypoints[0])} at x {self.goal[0]:.2f}, z {self.goal[1]:.2f} (it is at {xz[0]:.2f}, "
                f"{xz[1]:.2f}); give the path wider turns, waypoints further apart, or a larger radius"
            )

    def done(self, more: int = 0) -> float:
        """Metres of the path that lie behind, and those to so many waypoints on."""
        return self.path.length * (self.routes.index[0] + more) / len(self.routes.waypoints[0])

    def walked(self) -> Motion:
        """The walk, at least one frame."""
        if not self.frames:
            raise InvalidInputError("the path ends where the character already is: nothing to walk")
        return to_motion(np.stack(self.frames))


def _tell(progress: Progress | None, trips: Sequence[_Trip]) -> None:
    if progress is not None and max(len(trip.frames) for trip in trips) % int(FPS) == 0:
        done, total = sum(trip.done() for trip in trips), sum(trip.path.length for trip in trips)
        progress(round(done), max(1, round(total)), f"walked {done:.0f} m")
