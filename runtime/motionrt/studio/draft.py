"""A script in the making: what clicks add to it, as immutable values, so that undo is the value before."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.locomotion import Act, Action, Do, Follow, Goal, Path, Stand, Wait, WalkTo
from motionrt.locomotion.bearings import apart
from motionrt.motion import SMPL24
from motionrt.studio import postures
from motionrt.studio.postures import Place, Point

WALK, PATH, SIT, GRAB_RIGHT, GRAB_LEFT, JOINT, START = (
    "Walk here",
    "Draw a path",
    "Sit down here",
    "Grab, right hand",
    "Grab, left hand",
    "Place a joint",
    "Start here",
)
TOOLS = (WALK, PATH, SIT, GRAB_RIGHT, GRAB_LEFT, JOINT, START)
Free = Callable[[Place], bool]


@dataclass(frozen=True)
class Options:
    """How clicks are understood.

    Attributes:
        joint: for "Place a joint", which.
        hold_s: seconds that a pose is held.
        height: metres at which hands grab where the click met only the ground.
        seat: height in metres of a seat where the click met only the ground.
    """

    joint: str = "right_hand"
    hold_s: float = 2.0
    height: float = 1.1
    seat: float = 0.45


@dataclass(frozen=True)
class Draft:
    """What is to happen.

    Attributes:
        start: where the character stands at first.
        steps: the actions so far.
        path: points (x, z) of a path that is still being drawn; it is a step as soon as there are two.
    """

    start: Goal = field(default_factory=lambda: Goal(0.0, 0.0))
    steps: tuple[Action, ...] = ()
    path: tuple[Place, ...] = ()

    @property
    def actions(self) -> tuple[Action, ...]:
        """The steps, with the path that is being drawn."""
        drawn = (Follow(Path(np.array(self.path, dtype=np.float32))),) if len(self.path) > 1 else ()
        return (*self.steps, *drawn)

    @property
    def place(self) -> Place:
        """Where the character is after the last step."""
        if self.path:
            return self.path[-1]
        return next((p for p in map(end_of, reversed(self.steps)) if p is not None), (self.start.x, self.start.z))

    @property
    def keypoints(self) -> int:
        """How many keypoints there are in all."""
        return sum(len(step.keypoints) for step in self.steps if isinstance(step, Act))

    def finished(self) -> Draft:
        """With the path as a step."""
        return replace(self, steps=self.actions, path=())

    def clicked(self, tool: str, point: Point, options: Options, free: Free | None = None) -> Draft:
        """What a click at a point (x, y, z) does.

        Raises:
            InvalidInputError: an unknown tool.
        """
        place = (point[0], point[2])
        if tool == PATH:
            return replace(self, path=(*self.path, place))
        done = self.finished()
        if tool == START:
            return replace(done, start=Goal(*place, self.start.heading))
        if tool == WALK:
            return done.added(WalkTo(*place))
        if tool == JOINT:
            return _with_joint(done, options, point)
        if tool == SIT:
            return done.added(postures.sit(point, done.place, options.seat, options.hold_s, free))
        if tool in {GRAB_RIGHT, GRAB_LEFT}:
            side = "right" if tool == GRAB_RIGHT else "left"
            return done.added(postures.grab(point, done.place, side, options.height, options.hold_s, free))
        raise InvalidInputError(f"unknown tool '{tool}'; there are: {', '.join(TOOLS)}")

    def added(self, action: Action) -> Draft:
        """With one more step."""
        done = self.finished()
        return replace(done, steps=(*done.steps, action))

    def without(self, index: int) -> Draft:
        """Without a step."""
        steps = self.finished().steps
        return replace(self.finished(), steps=steps[:index] + steps[index + 1 :])

    def moved(self, index: int, joint: str, point: Point) -> Draft:
        """With a keypoint of a step somewhere else."""
        step = self.steps[index]
        if not isinstance(step, Act) or joint not in step.keypoints:
            raise InvalidInputError(f"step {index + 1} has no keypoint '{joint}'")
        changed = replace(step, keypoints={**step.keypoints, joint: point})
        return replace(self, steps=(*self.steps[:index], changed, *self.steps[index + 1 :]))


def end_of(action: Action) -> Place | None:
    """Where an action ends on the ground; None where it stays."""
    if isinstance(action, WalkTo):
        return action.x, action.z
    if isinstance(action, Follow):
        x, z = action.path.points[-1]
        return float(x), float(z)
    if isinstance(action, Act):
        return postures.foothold(action.keypoints)
    return None


def described(action: Action) -> str:
    """One line about a step."""
    if isinstance(action, Act):
        joints = ", ".join(joint.replace("_", " ") for joint in action.keypoints)
        return f"{action.name}: {joints}; hold {action.hold_s:g} s"
    if isinstance(action, Stand):
        return f"stand {action.hold_s:g} s"
    if isinstance(action, Wait):
        return f"wait {action.seconds:g} s"
    return f"{action.text}; hold {action.hold_s:g} s" if isinstance(action, Do) else action.name


def nearest_joint(step: Act, point: Sequence[float]) -> str:
    """The keypoint of a step that is nearest to a point (x, y, z)."""
    return min(step.keypoints, key=lambda joint: float(np.linalg.norm(np.subtract(step.keypoints[joint], point))))


def same_place(a: Mapping[str, Sequence[float]], b: Mapping[str, Sequence[float]]) -> bool:
    """Whether two poses stand in one place."""
    return apart(postures.foothold(a), postures.foothold(b)) < 0.05


def _with_joint(draft: Draft, options: Options, point: Point) -> Draft:
    """The joint joins the pose that is being made, unless that has it already: then a new pose begins."""
    joint = options.joint
    if joint not in SMPL24.names:
        raise InvalidInputError(f"no joint '{joint}'; joints are: {', '.join(SMPL24.names)}")
    last = draft.steps[-1] if draft.steps else None
    if isinstance(last, Act) and last.name == "pose" and joint not in last.keypoints:
        pose = replace(last, keypoints={**last.keypoints, joint: point}, hold_s=options.hold_s)
        return replace(draft, steps=(*draft.steps[:-1], pose))
    return draft.added(Act({joint: point}, hold_s=options.hold_s, name="pose"))
