"""``Look``: how a picture is to look, checked once."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

from motionrt.errors import InvalidInputError
from motionrt.rendering.camera import checked_camera
from motionrt.rendering.colours import Colours, chosen
from motionrt.untrusted.arguments import check_flags, checked_whole, real
from motionrt.untrusted.words import shown

Layout = Literal["strip", "path"]
LAYOUTS: tuple[Layout, ...] = ("strip", "path")
MIN_SIDE, MAX_SIDE, MAX_POSES = 64, 8192, 200


@dataclass(frozen=True)
class Look:
    """How a picture is to look.

    Attributes:
        camera: front, three-quarter, side, back, left or top, as the character is seen in its first frame; or degrees
            from its front to its right. None is three-quarter.
        elevation: degrees that the eye is above the horizon; None is what suits the camera.
        follow: animations: the camera goes along with the character; None is yes where it leaves its place. In strips:
            every pose is seen from the same side of the character; by default from the same side of the world.
        layout: pictures: ``"strip"``, poses side by side, or ``"path"``, poses where they happen.
        poses: pictures: how many; None is as many as there is room for.
        size: pixels (width, height); a height of 0 is what is needed. None is 1600 wide for pictures, and 400 by 400
            for each clip of an animation.
        columns: how many clips stand side by side; None is 1 in pictures, and up to 3 in animations.
        fps: animations: frames per second; a .gif has 25 at most, the rate that every program plays as it is. None is
            20 for a .gif and 30 for a video.
        theme: ``"light"`` or ``"dark"``.
        colours: changes of the theme: names of :class:`Colours` and ``#rrggbb``.
        grid: draw the floor.
        shadow: draw shadows.
        times: write seconds.
        trails: draw the ways of wrists and ankles.

    Raises:
        InvalidInputError: anything out of range; the message says what is possible.
    """

    camera: str | float | None = None
    elevation: float | None = None
    follow: bool | None = None
    layout: Layout = "strip"
    poses: int | None = None
    size: tuple[int, int] | None = None
    columns: int | None = None
    fps: float | None = None
    theme: str = "light"
    colours: Mapping[str, str] | None = field(default=None)
    grid: bool = True
    shadow: bool = True
    times: bool = True
    trails: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "camera", checked_camera("three-quarter" if self.camera is None else self.camera))
        check_flags(grid=self.grid, shadow=self.shadow, times=self.times, trails=self.trails)
        if self.follow is not None:
            check_flags(follow=self.follow)
        for name, most in (("poses", MAX_POSES), ("columns", math.inf)):
            if getattr(self, name) is not None:
                checked_whole(getattr(self, name), name, 1, most)
        elevated = self.elevation is None or -5 <= real(self.elevation) <= 90
        _require(elevated, "elevation: -5 to 90 degrees", self.elevation)
        _require(
            isinstance(self.layout, str) and self.layout in LAYOUTS, f"layout: {' or '.join(LAYOUTS)}", self.layout
        )
        _require(self.fps is None or 1 <= real(self.fps) <= 120, "fps: 1 to 120", self.fps)
        if self.size is not None:
            _require(isinstance(self.size, tuple | list) and len(self.size) == 2, "size: (width, height)", self.size)
            wide, high = (checked_whole(side, "size") for side in self.size)
            _require(MIN_SIDE <= wide <= MAX_SIDE and (high == 0 or MIN_SIDE <= high <= MAX_SIDE),
                     f"size: {MIN_SIDE} to {MAX_SIDE} pixels each", self.size)  # fmt: skip
        _ = self.palette

    @cached_property
    def palette(self) -> Colours:
        """The colours of the theme with the changes."""
        return chosen(self.theme, self.colours)

    @property
    def view(self) -> str | float:
        """The camera, never None."""
        return "three-quarter" if self.camera is None else self.camera


def _require(fine: bool, expected: str, value: object) -> None:
    if not fine:
        raise InvalidInputError(f"{expected}; not {shown(value)}")
