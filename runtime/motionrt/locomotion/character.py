"""A character that walks, changes its pose and holds it; remembers all that it did."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np

from motionrt.locomotion.bearings import (
    Place,
    ahead_of,
    apart,
    facing_of,
    heading_along,
    joined,
    over_feet,
    place_of,
)
from motionrt.locomotion.character_models import CharacterModels
from motionrt.locomotion.crowd import FPS, at_30_fps
from motionrt.locomotion.goal_frame import Goal, uncanonicalise
from motionrt.locomotion.lying import lie_back, reversed_in_time
from motionrt.locomotion.path import Path
from motionrt.locomotion.path_following import Pace, Progress, walk
from motionrt.locomotion.performance import Aim, Performance, Segment, performance_of
from motionrt.locomotion.stepped_transitions import with_steps
from motionrt.locomotion.stepping import set_off, step_to
from motionrt.locomotion.terrain import Heights, Terrain, raised
from motionrt.locomotion.transitions import LONGEST, placed, speed_of
from motionrt.motion import Motion
from motionrt.motion.rotations import wrapped
from motionrt.motion.skeleton import FloatArray

SEED = 60  # frames that a transition starts from
NEAR = 1.6  # metres that a transition covers without a walk before it
EASY_TURN = 0.4  # radians that a transition into a stride or a pose turns on the way
UPRIGHT = 0.12  # metres that the pelvis of somebody who stands is off the standing height
STOPS_S = 0.6  # seconds of its speed before a stand at which a walk gives way to steps
LOOKS_AHEAD = 0.9  # metres of a path that the first step looks ahead
SETTLE_S = 0.2  # seconds that the first pose is held
MOVING = 0.4  # m/s above which a motion that is gone on from counts as a walk
UNLIKE = 0.15  # metres that joints of a held pose are from those of a stand, on average, before one stands up to walk
BESIDE = 0.3  # metres from where somebody stands up over its feet that a stand may be reached without steps


class Planner(Protocol):
    """Finds ways: a :class:`motionrt.locomotion.scene.Scene`."""

    def plan(self, start: Sequence[float], goal: Sequence[float], /) -> Path:
        """A path between two places (x, z)."""


class Character:
    """What the character did so far, and the few things that it can do next.

    Args:
        models: the models.
        start: where it stands at first, or what it did before (which is not part of what it does then).
        scene: finds ways round obstacles; without one it walks straight.
        pace: how it walks.
        seed: of the small movements of held poses.
        level: height of the ground where there is no scene, metres.
    """

    def __init__(
        self,
        models: CharacterModels,
        start: Goal | Motion,
        scene: Planner | None,
        pace: Pace,
        seed: int,
        level: float = 0.0,
    ) -> None:
        self.models, self.scene, self.pace = models, scene, pace
        self._seed = seed
        self._segments: list[Segment] = []
        self._aims: list[Aim] = []
        self.terrain = Terrain(scene, level)
        before = at_30_fps(start) if isinstance(start, Motion) else uncanonicalise(models.standing, start)
        self._level = self.terrain.at(place_of(before))
        self._levels: list[Heights] = []
        if isinstance(start, Motion):
            before = raised(start, np.full(start.frames, -self._level))
        self._parts: list[Motion] = [before]  # on the plane, as all that follows
        self._pose = before[-1:]
        self.moving = speed_of(before) > MOVING
        self._posed = False  # whether it holds a pose that it took
        self._risen: tuple[Motion, Motion] | None = None  # of somebody who lies: the way up, and the seat
        if isinstance(start, Goal):
            self.hold(SETTLE_S, "start")

    # -- where it is

    @property
    def place(self) -> Place:
        """(x, z) metres."""
        return place_of(self._parts[-1])

    @property
    def facing(self) -> float:
        """Radians from +Z towards +X."""
        return facing_of(self._parts[-1])

    @property
    def braking(self) -> float:
        """Metres before a stand at which a walk gives way to steps."""
        return STOPS_S * self.pace.speed

    def way(self, goal: Place) -> Path | None:
        """A path from here to a place; None if that is here."""
        if apart(goal, self.place) < 0.05:
            return None
        if self.scene is not None:
            return self.scene.plan(self.place, goal)
        return Path(np.array([self.place, goal], dtype=np.float32))

    def way_along(self, path: Path) -> Path:
        """A given path, from here."""
        first = (float(path.points[0, 0]), float(path.points[0, 1]))
        if apart(first, self.place) <= NEAR:
            here = np.array([self.place], dtype=np.float32)
            return Path(np.concatenate([here, path.points[1:]]))
        way = self.way(first)
        return path if way is None else Path(np.concatenate([way.points[:-1], path.points]))

    # -- what it can do

    def go(self, path: Path | None, name: str, until: float, progress: Progress | None = None) -> None:
        """Walk along a path up to so many metres before its end; short ways are left to the transition that follows."""
        rest = self.leave(path, name, until)
        if rest is not None:
            self.walked(walk(self.models.walk, self.tail, rest, self.pace.before_end(until), progress), rest, name)

    def leave(self, path: Path | None, name: str, until: float) -> Path | None:
        """Get into a stride; what is left of the path to walk, if anything."""
        if path is None or path.length <= max(until, 0.3) or (not self.moving and path.length < NEAR):
            return None
        rest = path if self.moving else self._set_off(path, name, until)
        return rest if rest is not None and rest.length > until + 0.05 else None

    def walked(self, motion: Motion, path: Path, name: str) -> None:
        """Remember a walk along a path."""
        self._add("walk", name, motion, path)
        self.moving, self._posed = True, False

    def stop(self, place: Place, facing: float, name: str) -> None:
        """Come to a stand at a place, facing a heading."""
        self._stand(Goal(*place, facing), name)

    def turn(self, facing: float, name: str, place: Place | None = None) -> None:
        """Turn by steps, standing at a place or where the feet are, unless one transition can do it on the way."""
        if abs(wrapped(facing - self.facing)) > EASY_TURN:
            self._stand(Goal(*(place or over_feet(self._parts[-1])), facing), name)

    def get_up(self, name: str) -> None:
        """Stand upright over the feet, if a pose is held that nobody walks away from."""
        if self._posed and _apart(self._pose, self.models.standing) > UNLIKE:
            self.stand_here(name)

    def stand_here(self, name: str) -> None:
        """Stand upright where the feet are; a walking character stops ahead."""
        ahead = self.braking if self.moving else 0.0
        place = self.place if self.moving else over_feet(self._parts[-1])
        self._stand(Goal(*ahead_of(place, self.facing, ahead), self.facing), name)

    def into(self, pose: Motion, name: str, level: float | None = None) -> None:
        """The transition into a pose that will be held, on ground that is ``level`` metres high."""
        self._pose = pose
        made = with_steps(self.tail, self.models.transition(self.tail, pose, held=True))
        self._add("transition", name, made, pose, level=level)
        self.moving, self._posed = False, True

    def lie(self, seat: Motion, pose: Motion, name: str, level: float) -> None:
        """From standing before an edge to sitting on it, and back into a pose that lies."""
        self.into(seat, name, level)
        back = lie_back(seat, pose)
        self._add("transition", name, back, pose, level=level)
        self._pose, self._risen = pose, (reversed_in_time(back, seat), seat)

    def rise(self, name: str) -> None:
        """Sit up, if it lies: as it lay down, the other way round."""
        if self._risen is not None:
            (up, seat), self._risen = self._risen, None
            self._add("transition", name, up, seat, level=self._level)
            self._pose = seat

    def show(self, motion: Motion, name: str) -> None:
        """A motion that begins where the character stands, facing as it does, and a stand behind it."""
        if self.moving:
            self.stand_here(name)
        shown = placed(motion, Goal(*self.place, self.facing))
        into = shown[: min(LONGEST, shown.frames)]
        made = self.models.transition(self.tail, into)
        gap = made.frames - into.frames + 1  # the last of these frames is the first that is given
        self._add("transition", name, joined([with_steps(self.tail, made[:gap]), made[gap:]]), into)
        if shown.frames > into.frames:
            self._add("generated", name, shown[into.frames :], None)
        self._pose, self.moving = shown[-1:], False
        self.stand_here(name)

    def hold(self, seconds: float, name: str, keypoints: Mapping[str, Sequence[float]] | None = None) -> None:
        """Stay in the present pose."""
        if round(seconds * FPS) > 0:
            self._seed += 1
            self._add("hold", name, self.models.hold(self._pose, seconds, self._seed), None, keypoints)

    # -- what it did

    @property
    def tail(self) -> Motion:
        """The last two seconds, or all there are."""
        frames, first = 0, len(self._parts)
        while first > 0 and frames < SEED:
            first -= 1
            frames += self._parts[first].frames
        return joined(self._parts[first:])[-SEED:]

    def performance(self, *, foot_lock: bool, surfaces: FloatArray | None = None) -> Performance:
        """All that it did since the start; ``surfaces`` (N, 3) are those that it should have kept out of."""
        levels = np.concatenate(self._levels)
        done, aims = joined(self._parts[1:]), self._aims
        return performance_of(
            done, self._segments, aims, levels, terrain=self.terrain, surfaces=surfaces, foot_lock=foot_lock
        )

    def _set_off(self, path: Path, name: str, until: float) -> Path | None:
        """The first step from a held pose along the path; the rest of the path."""
        facing = heading_along(path, min(LOOKS_AHEAD, path.length - until))
        self.get_up(name)
        self.turn(facing, name)
        before = self.place
        self._add("transition", name, set_off(self.tail, self.models.standing, facing), None)
        self.moving = True
        ahead = apart(before, self.place)
        return path.part(ahead, path.length) if path.length - ahead > 0.05 else None

    def _ground(self, kind: str, motion: Motion, level: float | None) -> Heights:
        """(F,) how high the ground is under a part: a walk is above it, a transition leads from level to level."""
        if kind == "walk":
            return self.terrain.under(motion.root[:, [0, 2]], self._level)
        if kind in ("hold", "generated"):
            return np.full(motion.frames, self._level)
        aim = self.terrain.at(place_of(motion), self._level) if level is None else level
        return np.linspace(self._level, aim, motion.frames + 1)[1:]

    def _stand(self, goal: Goal, name: str) -> None:
        """By steps from a stand or a walk; by a transition from anything else."""
        pose = uncanonicalise(self.models.standing, goal)
        if abs(self.models.standing.root[0, 1] - self._parts[-1].root[-1, 1]) > UPRIGHT:
            over = over_feet(self._parts[-1])
            if apart(over, (goal.x, goal.z)) <= BESIDE and abs(wrapped(goal.heading - self.facing)) <= EASY_TURN:
                self.into(pose, name)
                self._posed = False
                return
            self.into(uncanonicalise(self.models.standing, Goal(*over, self.facing)), name)
        self._pose, self.moving, self._posed = pose, False, False
        self._add("transition", name, step_to(self.tail, pose).motion, pose)

    def _add(
        self,
        kind: str,
        name: str,
        motion: Motion,
        aim: Aim,
        keypoints: Mapping[str, Sequence[float]] | None = None,
        level: float | None = None,
    ) -> None:
        self._levels.append(self._ground(kind, motion, level))
        self._level = float(self._levels[-1][-1])
        start = self._segments[-1].end if self._segments else 0
        self._parts.append(motion)
        self._segments.append(Segment(kind, name, start, start + motion.frames, dict(keypoints or {})))
        self._aims.append(aim)


def _apart(pose: Motion, standing: Motion) -> float:
    """Metres between the joints of two poses that stand in one place and face one way, on average."""
    here = Goal(0.0, 0.0)
    found, wanted = (placed(each[-1:], here).positions()[0] for each in (pose, standing))
    return float(np.linalg.norm(found - wanted, axis=1).mean())
