"""One character, one frame at a time, for a game's loop: walks to its goal, stands there, sets off to the next."""

from __future__ import annotations

from collections.abc import Generator

import numpy as np
import numpy.typing as npt

from motionrt.locomotion.arguments import as_goal
from motionrt.locomotion.bearings import apart, facing_of, over_feet, place_of
from motionrt.locomotion.character import MOVING, NEAR, SEED, SHARPEST, STRIDE
from motionrt.locomotion.character_models import CharacterModels
from motionrt.locomotion.crowd import FPS, SPEED, Crowd, at_30_fps, to_motion
from motionrt.locomotion.goal_frame import Goal, uncanonicalise
from motionrt.locomotion.path_following import Pace
from motionrt.locomotion.transitions import distance, speed_of
from motionrt.models.walknet import HISTORY
from motionrt.motion import Motion
from motionrt.motion.features import ccf219
from motionrt.motion.feet.live_lock import FootLocker
from motionrt.motion.rotations import wrapped
from motionrt.untrusted.arguments import check_flags, checked_whole

THERE = 0.3  # metres and radians: somebody who stands this near to a goal stays
IDLE_S = 2.0  # seconds of standing that are made at once

Frames = npt.NDArray[np.float64]


class Stroller:
    """A character that is asked for its next frame again and again; its goal may change between any two frames.

    Args:
        models: the models.
        start: where it stands, or what it did before.
        goal: where to walk first.
        speed: metres per second.
        seed: of the small movements while it stands.
    """

    def __init__(
        self, models: CharacterModels, start: Goal | Motion, goal: Goal, speed: float = SPEED, seed: int = 0
    ) -> None:
        self.models, self.goal, self.speed = models, goal, Pace(speed=speed).speed
        before = at_30_fps(start) if isinstance(start, Motion) else uncanonicalise(models.standing, start)
        frames = ccf219.encode(before)[-SEED:].astype(np.float64)
        self._last: Frames = np.pad(frames, ((SEED - len(frames), 0), (0, 0)), mode="edge")
        self._ready: list[Frames] = []
        self._walks = speed_of(before) > MOVING
        self._seed = checked_whole(seed, "seed", 0)

    def aim(self, goal: Goal) -> None:
        """A new goal, from the next frame on."""
        if goal != self.goal:
            self.goal, self._ready = goal, []
            self._walks = speed_of(self._seen(), 0.2) > MOVING

    def step(self) -> Motion:
        """The next frame."""
        if not self._ready:
            self._ready = list(self._next())
        frame = self._ready.pop(0)
        self._last = np.concatenate([self._last[1:], frame[None]])
        return to_motion(frame[None])

    def _next(self) -> Frames:
        """What comes next: a frame of a walk, or a whole transition or pause."""
        seen = self._seen()
        away = apart(place_of(seen), (self.goal.x, self.goal.z))
        if not self._walks:
            return self._from_stand(seen, away)
        if away <= distance(self.speed, 0.0):
            return self._stand(seen, Goal(self.goal.x, self.goal.z, self._turned(seen, self.goal.heading)))
        crowd = Crowd(self.models.walk, self._last[None, -HISTORY:])
        return crowd.step(np.array([self.goal.row()]), self.speed)

    def _from_stand(self, seen: Motion, away: float) -> Frames:
        x, z = place_of(seen)
        ahead = float(np.arctan2(self.goal.x - x, self.goal.z - z))
        off = abs(wrapped(ahead - facing_of(seen)))
        if away > NEAR and off > SHARPEST:
            return self._stand(seen, Goal(*over_feet(seen), self._turned(seen, ahead)))
        if away > NEAR:
            return self._set_off(seen, ahead, away)
        if away > THERE or abs(wrapped(self.goal.heading - facing_of(seen))) > THERE:
            return self._stand(seen, Goal(self.goal.x, self.goal.z, self._turned(seen, self.goal.heading)))
        self._seed += 1
        return _rows(self.models.hold(seen[-1:], IDLE_S, self._seed))

    def _set_off(self, seen: Motion, ahead: float, away: float) -> Frames:
        self._walks = True
        far = min(distance(0.0, self.speed), away)
        x, z = place_of(seen)
        place = Goal(x + far * float(np.sin(ahead)), z + far * float(np.cos(ahead)), ahead)
        return _rows(self.models.transition(seen, uncanonicalise(self.models.stride[-STRIDE:], place)))

    def _stand(self, seen: Motion, goal: Goal) -> Frames:
        self._walks = False
        return _rows(self.models.transition(seen, uncanonicalise(self.models.standing, goal), held=True))

    def _turned(self, seen: Motion, facing: float) -> float:
        """As far towards a heading as one transition turns."""
        now = facing_of(seen)
        return now + float(np.clip(wrapped(facing - now), -SHARPEST, SHARPEST))

    def _seen(self) -> Motion:
        return to_motion(self._last)


def stream(
    models: CharacterModels,
    start: Goal | Motion,
    goal: Goal,
    *,
    speed: float = SPEED,
    foot_lock: bool = True,
    seed: int = 0,
) -> Generator[Motion, Goal | None, None]:
    """Frames for ever, one :class:`Motion` of one frame at 30 fps each: ``next`` goes on, ``send`` gives a new goal."""
    check_flags(foot_lock=foot_lock)
    return _frames(Stroller(models, start, goal, speed, seed), foot_lock=foot_lock)


def _frames(walker: Stroller, *, foot_lock: bool) -> Generator[Motion, Goal | None, None]:
    locker = FootLocker(FPS)
    while True:
        frame = walker.step()
        if foot_lock:
            rotations, root = locker.step(frame.rotations[0], frame.root[0])
            frame = Motion(rotations[None], root[None], FPS)
        told = yield frame
        if told is not None:
            walker.aim(as_goal(told))


def _rows(motion: Motion) -> Frames:
    return ccf219.encode(motion).astype(np.float64)
