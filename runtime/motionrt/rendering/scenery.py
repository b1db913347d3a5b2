"""A whole scene on a canvas: the floor with all that lies on it, then shadows, then all that has a body."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from motionrt.rendering import stage
from motionrt.rendering.camera import Camera
from motionrt.rendering.canvas import Canvas, joined
from motionrt.rendering.framing import extent
from motionrt.rendering.look import Look
from motionrt.rendering.solids import Floats, Solids
from motionrt.rendering.takes import Take

_MARGIN, _REACH = 0.7, 9.0  # metres of floor around a motion, and at most around a following camera
_THINGS = 4000
_LIMBS = ("left_wrist", "right_wrist", "left_ankle", "right_ankle")


def paint(canvas: Canvas, camera: Camera, take: Take, look: Look, frames: Sequence[tuple[int, float]]) -> None:
    """Draw a take with its figure in some frames, each faded by a part of 0 to 1."""
    floor = take.ground
    if look.grid:
        _floor(canvas, camera, take, floor)
    stage.ways(canvas, camera, [np.asarray(path) for path in take.paths], floor)
    for frame, fade in frames if look.shadow else ():
        stage.shadow(canvas, camera, take, frame, 0.30 * (1 - 0.6 * fade))
    if look.trails:
        trails(canvas, take, camera.project(take.motion.positions())[0][..., :2])
    canvas.solids(joined([*_belongings(camera, take, look, frames), *_figures(camera, take, look, frames)]))


def _floor(canvas: Canvas, camera: Camera, take: Take, floor: float) -> None:
    if take.areas:
        stage.floor_areas(canvas, camera, [np.asarray(area) for area in take.areas], floor)
        return
    low, high = extent(take)
    aim = camera.target[[0, 2]]
    stage.floor_lines(
        canvas, camera, np.maximum(low - _MARGIN, aim - _REACH), np.minimum(high + _MARGIN, aim + _REACH), floor
    )


def _figures(camera: Camera, take: Take, look: Look, frames: Sequence[tuple[int, float]]) -> list[Solids]:
    return [stage.body(camera, take, frame, look.palette, fade) for frame, fade in frames]


def _belongings(camera: Camera, take: Take, look: Look, frames: Sequence[tuple[int, float]]) -> list[Solids]:
    """Furniture, and the marks that belong to the frames."""
    times = [frame / take.motion.fps for frame, _ in frames]
    shown = [mark.point for mark in take.marks if any(mark.start_s <= time <= mark.end_s for time in times)]
    things = np.asarray(take.things, np.float32).reshape(-1, 3)
    some = things[:: max(1, -(-len(things) // _THINGS))]
    return [
        stage.balls(camera, np.array(shown, np.float32), stage.MARK_RADIUS, "mark", look.palette),
        stage.balls(camera, some, stage.POINT_RADIUS, "thing", look.palette),
    ]


def trails(canvas: Canvas, take: Take, pixels: Floats) -> None:
    """The ways of wrists and ankles, of the joints' pixels ``(F, J, 2)``."""
    names = take.motion.skeleton.names
    for limb in _LIMBS:
        if limb in names:
            canvas.line(pixels[:, names.index(limb)], limb.split("_")[0], 1.0, fade=0.4)
