"""One character, one frame at a time, for a game's loop: goes to its goal or where a stick points, stands, goes on.

Goals and sticks may change before every frame. What is far is walked to by WalkNet, which is led there
(:mod:`motionrt.locomotion.leading`); what is near is stepped to (:mod:`motionrt.locomotion.stepping`), and so is the
last bit of every way, and every turn on the spot.
"""

from __future__ import annotations

from collections.abc import Generator
from math import hypot
from types import TracebackType

import numpy as np
import numpy.typing as npt

from motionrt.locomotion.arguments import as_goal
from motionrt.locomotion.bearings import Place, ahead_of, apart, facing_of, over_feet, place_of
from motionrt.locomotion.character import MOVING, SEED
from motionrt.locomotion.character_models import CharacterModels
from motionrt.locomotion.crowd import FPS, SPEED, Crowd, at_30_fps, takes_wishes, to_motion
from motionrt.locomotion.goal_frame import Goal, uncanonicalise
from motionrt.locomotion.leading import ASIDE, STANDS, THERE, WALKS_FROM, Lead, asked_for, by_stick, helped, towards
from motionrt.locomotion.path_following import Pace
from motionrt.locomotion.stepping import set_off, step_to
from motionrt.locomotion.transitions import speed_of
from motionrt.locomotion.wishes import Wish
from motionrt.models.walknet import HISTORY
from motionrt.motion import Motion
from motionrt.motion.features import ccf219
from motionrt.motion.feet.live_lock import FootLocker
from motionrt.motion.rotations import wrapped
from motionrt.untrusted.arguments import check_flags, checked_whole

STEPPED = 2.2  # metres that are stepped, in any direction, instead of walked
ON = 6.0  # metres that are stepped on sideways or back while a stick says so
STOPS = 0.35  # seconds of its speed that a walk goes on until it stands
LOOKS, LEFT = 0.9, 0.85  # radians between facing and way: more is turned to by steps before a walk, up to what is left
SWAYS = 2  # frames behind the last landing of such a turn after which the walk begins
CLOSE, CLOSE_TURN = 0.02, 0.06  # metres and radians: somebody who stands this near to a goal stays
QUICKEST, FASTEST_TURN = 6.0, 400.0  # m/s and degrees/s between frames: more is no walk
LOWEST, HIGHEST = 0.7, 1.1  # of the standing height: lower or higher is no walk
GRACE_S, ENDS_S = 3.0, 1.9  # seconds beside the way that a goal may take, and those of them for the last steps
LATE = 1.25  # of the speed: who turned for long walks this much faster at most
IDLE_S = 2.0  # seconds of standing that are made at once

Frames = npt.NDArray[np.float64]


class Stroller:
    """A character that is asked for its next frame again and again; what it shall do may change between any two.

    Args:
        models: the models.
        start: where it stands, or what it did before.
        goal: where to go first.
        speed: metres per second.
        seed: of the small movements while it stands.
    """

    def __init__(
        self, models: CharacterModels, start: Goal | Motion, goal: Goal, speed: float = SPEED, seed: int = 0
    ) -> None:
        self.models, self.goal, self.speed = models, goal, Pace(speed=speed).speed
        self.stick: Wish | None = None
        before = at_30_fps(start) if isinstance(start, Motion) else uncanonicalise(models.standing, start)
        frames = ccf219.encode(before)[-SEED:].astype(np.float64)
        self._last: Frames = np.pad(frames, ((SEED - len(frames), 0), (0, 0)), mode="edge")
        self._ready: list[Frames] = []
        self._breaks: list[int] = []  # how many of the frames that are ready may be left when something else begins
        self._walks = speed_of(before) > MOVING
        self._seed = checked_whole(seed, "seed", 0)
        self._due_s = self._takes()

    def aim(self, goal: Goal) -> None:
        """A new goal, from the next frame on, or from where the foot that is in the air lands."""
        if goal != self.goal or self.stick is not None:
            self.goal, self.stick = goal, None
            self._due_s = self._takes()
            self._break_off()

    def steer(self, wish: Wish) -> None:
        """A velocity, and a facing that may be another, instead of a goal; as :meth:`aim`."""
        if wish != self.stick:
            self.stick = wish
            self._break_off()

    def step(self) -> Motion:
        """The next frame."""
        if not self._ready:
            self._ready = list(self._next())
        frame = self._ready.pop(0)
        self._due_s -= 1 / FPS
        self._last = np.concatenate([self._last[1:], frame[None]])
        return to_motion(frame[None])

    def _break_off(self) -> None:
        """Leave out what is ready behind the next frame in which both feet stand."""
        left = len(self._ready)
        keep = next((left - rest for rest in self._breaks if rest <= left), 0 if not self._breaks else left)
        self._ready = self._ready[:keep]

    def _next(self) -> Frames:
        """What comes next: a frame of a walk, or a number of steps, or a pause."""
        self._breaks = []
        seen = self._seen()
        return self._walk(seen) if self._walks else self._from_stand(seen)

    def _walk(self, seen: Motion) -> Frames:
        lead = self._lead(seen)
        if lead is None:
            return self._end_of_walk(seen)
        wishes = np.array([lead.wish().row()]) if self._strafes and lead.faces_aside else None
        aim = np.array([lead.goal(place_of(seen)).row()])
        history = self._last[None, -HISTORY:]
        crowd = Crowd(self.models.walk, history if lead.faces_aside else helped(aim, history))
        made = crowd.step(aim, asked_for(lead.speed, speed_of(seen)), wishes)
        return made if self._is_walk(made[0]) else self._step(seen, Goal(*over_feet(seen), facing_of(seen)))

    def _lead(self, seen: Motion) -> Lead | None:
        facing, now = facing_of(seen), speed_of(seen, 0.2)
        if self.stick is None:
            return None if self._creeps else towards(self.goal, place_of(seen), facing, now, self._pace(seen))
        wanted = self.stick.velocity or (0.0, 0.0)
        return by_stick(wanted, self.stick.facing, facing, now, strafes=self._strafes)

    @property
    def _strafes(self) -> bool:
        """Whether the network walks sideways and backwards: it was trained with wishes."""
        return takes_wishes(self.models.walk)

    @property
    def _creeps(self) -> bool:
        """Whether it goes to goals too slowly for a walk, and so by steps."""
        return self.speed < WALKS_FROM

    def _takes(self) -> float:
        """Seconds in which the goal shall be reached."""
        return apart(place_of(self._seen()), (self.goal.x, self.goal.z)) / self.speed + GRACE_S

    def _pace(self, seen: Motion) -> float:
        """The speed, or a little more for who is late."""
        left = apart(place_of(seen), (self.goal.x, self.goal.z)) - THERE
        needed = left / max(self._due_s - ENDS_S, 0.1)
        return float(np.clip(needed, self.speed, LATE * self.speed))

    def _end_of_walk(self, seen: Motion) -> Frames:
        """Steps to the goal if that is near, else to a stand a little ahead."""
        facing = facing_of(seen)
        ahead = ahead_of(place_of(seen), facing, STOPS * speed_of(seen, 0.2))
        if self.stick is None:
            near = apart(place_of(seen), (self.goal.x, self.goal.z)) < STEPPED
            return self._step(seen, self.goal if near else Goal(*ahead, facing))
        return self._by_stick(seen, self.stick, ahead)

    def _from_stand(self, seen: Motion) -> Frames:
        x, z = place_of(seen)
        facing = facing_of(seen)
        if self.stick is not None:
            return self._by_stick(seen, self.stick, over_feet(seen))
        away = apart((x, z), (self.goal.x, self.goal.z))
        if away <= STEPPED:
            if away > CLOSE or abs(wrapped(self.goal.heading - facing)) > CLOSE_TURN:
                return self._step(seen, self.goal, self.speed if self._creeps else np.inf)
            return self._pause(seen)
        way = float(np.arctan2(self.goal.x - x, self.goal.z - z))
        if self._creeps:
            return self._step(seen, Goal(*ahead_of((x, z), way, min(ON, away)), way), self.speed)
        return self._set_off(seen, way)

    def _by_stick(self, seen: Motion, stick: Wish, place: Place) -> Frames:
        """From a stand, or to one at ``place``: steps sideways or back, a turn, the first step of a walk, a pause."""
        velocity, facing = stick.velocity or (0.0, 0.0), facing_of(seen)
        wanted, way = hypot(*velocity), float(np.arctan2(velocity[0], velocity[1]))
        looks = facing if stick.facing is None else stick.facing
        if wanted <= STANDS:
            turns = abs(wrapped(looks - facing)) > 2 * CLOSE_TURN
            return self._step(seen, Goal(*place, looks)) if turns or self._walks else self._pause(seen)
        aside = stick.facing is not None and abs(wrapped(way - looks)) > ASIDE
        if aside and self._strafes and wanted >= WALKS_FROM:
            self._walks = True
            return self._walk(seen)
        if wanted < WALKS_FROM or aside:
            x, z = place_of(seen)
            looks = way if stick.facing is None else looks
            goal = Goal(x + ON * velocity[0] / wanted, z + ON * velocity[1] / wanted, looks)
            return self._step(seen, goal, wanted)
        return self._set_off(seen, way)

    def _set_off(self, seen: Motion, way: float) -> Frames:
        """A step along the way; who looks elsewhere turns first, all but what the step turns."""
        turn = float(wrapped(way - facing_of(seen)))
        if abs(turn) > LOOKS:
            return self._cut(self._step(seen, Goal(*over_feet(seen), way - float(np.copysign(LEFT, turn)))))
        self._walks = True
        self._breaks = [0]
        return _rows(set_off(seen, self.models.standing, way))

    def _step(self, seen: Motion, goal: Goal, pace: float = np.inf) -> Frames:
        self._walks = False
        steps = step_to(seen, uncanonicalise(self.models.standing, goal), pace)
        self._breaks = [steps.motion.frames - landing for landing in steps.landings]
        return _rows(steps.motion)

    def _cut(self, rows: Frames) -> Frames:
        """Steps without the rest behind the last landing."""
        rest = max(0, self._breaks[-2] - SWAYS) if len(self._breaks) > 1 else 0
        self._breaks = [max(0, left - rest) for left in self._breaks]
        return rows[: len(rows) - rest]

    def _pause(self, seen: Motion) -> Frames:
        self._seed += 1
        return _rows(self.models.hold(seen[-1:], IDLE_S, self._seed))

    def _is_walk(self, frame: Frames) -> bool:
        """Whether a frame can follow the last one."""
        now, before = to_motion(frame[None]), self._seen()[-1:]
        way = float(np.linalg.norm(now.root[0] - before.root[0])) * FPS
        turn = abs(float(wrapped(facing_of(now) - facing_of(before)))) * FPS
        height = float(now.root[0, 1] / self.models.standing.root[0, 1])
        return way < QUICKEST and turn < np.radians(FASTEST_TURN) and LOWEST < height < HIGHEST

    def _seen(self) -> Motion:
        return to_motion(self._last)


class Stream(Generator[Motion, Goal | None, None]):
    """Frames for ever, one :class:`Motion` of one frame at 30 fps each.

    ``next`` goes on, :meth:`send` gives a new goal, :meth:`steer` a stick's wish; each gives the next frame.
    """

    def __init__(self, walker: Stroller, *, foot_lock: bool = True) -> None:
        self._walker, self._closed = walker, False
        self._locker = FootLocker(FPS) if foot_lock else None

    def send(self, value: Goal | None) -> Motion:
        """The next frame; on the way to a new goal, if one is given."""
        if self._closed:
            raise StopIteration
        if value is not None:
            self._walker.aim(as_goal(value))
        frame = self._walker.step()
        if self._locker is None:
            return frame
        rotations, root = self._locker.step(frame.rotations[0], frame.root[0])
        return Motion(rotations[None], root[None], FPS)

    def steer(self, velocity: tuple[float, float], facing: float | None = None) -> Motion:
        """The next frame, led by a stick until the next :meth:`steer` or goal.

        Args:
            velocity: (x, z) m/s over the ground, in the world; (0, 0) stands still. At most 6 m/s.
            facing: radians from +Z towards +X that the body shall look at, whichever way it goes; by default it looks
                where it goes.

        Raises:
            InvalidInputError: numbers that are not finite, or too fast.
        """
        self._walker.steer(Wish((float(velocity[0]), float(velocity[1])), facing))
        return self.send(None)

    def throw(
        self,
        typ: type[BaseException] | BaseException,
        val: BaseException | object = None,
        tb: TracebackType | None = None,  # noqa: ARG002  # as every generator
    ) -> Motion:
        """As of any generator: raised here, which ends the stream."""
        self._closed = True
        if isinstance(typ, BaseException):
            raise typ
        raise typ() if val is None else val if isinstance(val, BaseException) else typ(val)

    def close(self) -> None:
        """No more frames."""
        self._closed = True


def stream(
    models: CharacterModels,
    start: Goal | Motion,
    goal: Goal,
    *,
    speed: float = SPEED,
    foot_lock: bool = True,
    seed: int = 0,
) -> Stream:
    """A character for a game's loop; see :class:`Stream`."""
    check_flags(foot_lock=foot_lock)
    return Stream(Stroller(models, start, goal, speed, seed), foot_lock=foot_lock)


def _rows(motion: Motion) -> Frames:
    return ccf219.encode(motion).astype(np.float64)
