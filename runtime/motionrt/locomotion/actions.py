"""What a character can be told to do, as immutable values."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from motionrt.errors import InvalidInputError
from motionrt.limits import check_place, how_to_raise, limits
from motionrt.locomotion.path import Path
from motionrt.untrusted.arguments import check_kind, real
from motionrt.untrusted.words import shown

HOLD_S = 2.0  # seconds that a pose is held if nothing else is said
NEAREST_EDGE, FARTHEST_EDGE = 0.05, 1.5  # metres from where somebody lies to the edge that it sits down on


@dataclass(frozen=True)
class WalkTo:
    """Walk to a place, round the obstacles of the scene, and stand there unless another walk follows.

    Attributes:
        x, z: metres.
        heading: radians from +Z towards +X to face at the end; by default the way it came.

    Raises:
        InvalidInputError: a number that is not finite.
    """

    x: float
    z: float
    heading: float | None = None

    def __post_init__(self) -> None:
        check_place("a place to walk to (x, z, heading)", (self.x, self.z), self.heading)

    @property
    def name(self) -> str:
        """What it is called in the timeline."""
        return f"walk to {self.x:.1f}, {self.z:.1f}"


@dataclass(frozen=True)
class Follow:
    """Walk along a path that is given; from where the character is to its start it finds the way by itself.

    Attributes:
        path: where to walk.
        heading: radians from +Z towards +X to face at the end; by default along the path.
    """

    path: Path
    heading: float | None = None

    def __post_init__(self) -> None:
        check_kind(self.path, Path, "path", "a motionrt.Path")
        check_place("a heading (x, z, heading)", (), self.heading)

    @property
    def name(self) -> str:
        """What it is called in the timeline."""
        return f"follow {self.path.length:.1f} m"


@dataclass(frozen=True)
class Act:
    """Walk near, take the pose that meets keypoints, hold it.

    Attributes:
        keypoints: ``{joint of smpl24: (x, y, z) metres in the world}``.
        heading: radians to face in the pose; by default what the keypoints suggest.
        hold_s: seconds to stay in it.
        approach: (x, z) to walk to first, where the way ends before the pose is taken; by default below the pose.
        name: what to call it in the timeline.
    """

    keypoints: Mapping[str, Sequence[float]]
    heading: float | None = None
    hold_s: float = HOLD_S
    approach: tuple[float, float] | None = None
    name: str = "act"

    def __post_init__(self) -> None:
        _check_seconds(self.hold_s, self.name)
        check_kind(self.keypoints, Mapping, "keypoints", "like {'right_wrist': (0.2, 1.2, 0.4)}")
        check_place("a heading (x, z, heading)", (), self.heading)


@dataclass(frozen=True)
class Do:
    """An instruction in words, as in "sit on the sofa"; needs a semantic point cloud.

    Attributes:
        text: verb, object, height, hand.
        hold_s: seconds to stay in the pose.
    """

    text: str
    hold_s: float = HOLD_S

    def __post_init__(self) -> None:
        _check_seconds(self.hold_s, self.text)

    @property
    def name(self) -> str:
        """What it is called in the timeline."""
        return self.text


@dataclass(frozen=True)
class Lie:
    """Sit down on an edge, lie back, stay there; whatever follows gets up the same way.

    Attributes:
        at: (x, y, z) metres of the surface where the pelvis shall lie.
        edge: (x, z) where to sit down first: the edge of the surface beside ``at``.
        heading: radians from +Z towards +X that the feet point to, seen from the head.
        hold_s: seconds to lie.
        name: what to call it in the timeline.

    Raises:
        InvalidInputError: numbers that are not finite, or an edge more than 1.5 m or less than 5 cm from ``at``.
    """

    at: tuple[float, float, float]
    edge: tuple[float, float]
    heading: float
    hold_s: float = HOLD_S
    name: str = "lie down"

    def __post_init__(self) -> None:
        _check_seconds(self.hold_s, self.name)
        check_place("where to lie (x, y, z, heading)", self.at, self.heading)
        check_place("the edge to sit down on (x, z)", self.edge, None)
        away = math.hypot(self.edge[0] - self.at[0], self.edge[1] - self.at[2])
        if not NEAREST_EDGE <= away <= FARTHEST_EDGE:
            raise InvalidInputError(
                f"the edge is {away:.2f} m from where the pelvis shall lie; give one between {NEAREST_EDGE:g} and "
                f"{FARTHEST_EDGE:g} m away"
            )


@dataclass(frozen=True)
class Generate:
    """A motion that is made from a text where the character stands, as in "wave with the right hand".

    Attributes:
        text: what to do.
        seconds: how long, 0.5 to 10 s.
    """

    text: str
    seconds: float = 3.0

    def __post_init__(self) -> None:
        _check_seconds(self.seconds, self.text)

    @property
    def name(self) -> str:
        """What it is called in the timeline."""
        return self.text


@dataclass(frozen=True)
class Stand:
    """Stand up, or stand still: upright over the feet."""

    hold_s: float = HOLD_S
    name: str = "stand"

    def __post_init__(self) -> None:
        _check_seconds(self.hold_s, self.name)


@dataclass(frozen=True)
class Wait:
    """Stay in the present pose; a walking character stops first."""

    seconds: float = HOLD_S
    name: str = "wait"

    def __post_init__(self) -> None:
        _check_seconds(self.seconds, self.name)


Action = WalkTo | Follow | Act | Lie | Do | Generate | Stand | Wait


def _check_seconds(seconds: float, name: str) -> None:
    check_kind(name, str, "a name, or what to do,", "a text")
    if not 0 <= real(seconds) < math.inf:
        raise InvalidInputError(f"'{shown(name)}' cannot last {shown(seconds)} s; give 0 or more seconds")
    if seconds > limits().seconds:
        raise InvalidInputError(f"'{name}' cannot last {seconds:g} s: {how_to_raise('seconds')}")
