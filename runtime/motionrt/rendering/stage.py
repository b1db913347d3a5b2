"""What stands in a scene, as one camera sees it: floor, paths, shadows, bodies, marks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from motionrt.rendering.body import SOLE, build_of, cone_ends
from motionrt.rendering.camera import Camera
from motionrt.rendering.canvas import Canvas
from motionrt.rendering.colours import Colours
from motionrt.rendering.meshes import seen
from motionrt.rendering.solids import Floats, Solids
from motionrt.rendering.takes import Take

_CIRCLE = np.stack([np.cos(a := np.linspace(0, 2 * np.pi, 14, endpoint=False)), 0 * a, np.sin(a)], axis=-1)
_ALONG = np.linspace(0, 1, 4)[:, None]
_SHADOW_ASIDE, _SHADOW_AWAY = 0.24, 0.20  # metres that a shadow is thrown, per metre of height
MARK_RADIUS, POINT_RADIUS = 0.045, 0.025  # metres
_NEAR = 0.85  # nothing nearer to the eye than this part of the way is drawn on the floor


def body(camera: Camera, take: Take, frame: int, colours: Colours, fade: float = 0.0) -> Solids:
    """The figure in a frame, or the character that plays it."""
    motion = take.motion
    if take.dressed is not None:
        skin, place = take.dressed.skin, take.vertices(frame)
        mesh = seen(camera, place, skin.faces, skin.colours, colours, fade)
        return replace(balls(camera, np.zeros((0, 3), np.float32), 1.0, "body", colours), meshes=(mesh,))
    build = build_of(motion.skeleton)
    ends, size = camera.project(cone_ends(motion, frame))
    return Solids(ends, build.radii * size, colours.tones(build.tones, fade))


def balls(camera: Camera, points: Floats, radius: float, tone: str, colours: Colours) -> Solids:
    """A ball at each point ``(N, 3)``."""
    centres, size = camera.project(np.asarray(points, np.float32).reshape(-1, 3))
    ends = np.repeat(centres[:, None], 2, axis=1)
    radii = np.repeat(size[:, None] * radius, 2, axis=1)
    return Solids(ends, radii.astype(np.float32), colours.tones((tone,) * len(ends)))


def shadow(canvas: Canvas, camera: Camera, take: Take, frame: int, strength: float = 0.30) -> None:
    """The figure's shadow on the floor."""
    if take.dressed is not None:
        corners = take.vertices(frame)[take.dressed.skin.faces]
        pixels, size = camera.project(_thrown(corners, camera, take.ground))
        canvas.shade(pixels[..., :2], softness=0.022 * float(size.mean()), strength=strength)
        return
    motion, floor = take.motion, take.ground
    build = build_of(motion.skeleton)
    ends = cone_ends(motion, frame)
    centres = ends[:, None, 0] + _ALONG * (ends[:, None, 1] - ends[:, None, 0])
    radii = build.radii[:, None, 0] + _ALONG[:, 0] * (build.radii[:, None, 1] - build.radii[:, None, 0])
    flat = _thrown(centres, camera, floor)
    rings = flat[..., None, :] + radii[..., None, None] * _CIRCLE
    pixels, size = camera.project(rings.reshape(-1, len(_CIRCLE), 3).astype(np.float32))
    canvas.shade(pixels[..., :2], softness=0.022 * float(size.mean()), strength=strength)


def _thrown(points: Floats, camera: Camera, floor: float) -> Floats:
    """Points ``(..., 3)`` where their shadows lie."""
    height = np.maximum(points[..., 1:2] - floor, 0)
    flat = points + height * (_SHADOW_ASIDE * camera.aside + _SHADOW_AWAY * camera.away)
    flat[..., 1] = floor - SOLE
    return np.asarray(flat, np.float32)


def on_floor(camera: Camera, xz: Floats, floor: float) -> Floats:
    """Pixels ``(M, 2)`` of a polyline ``(N, 2)`` on the floor; what is too near to the eye is pulled away from it."""
    points = np.insert(np.asarray(xz, np.float32), 1, floor - SOLE, axis=1)
    depth = (points - camera.target) @ camera.turn[2]
    excess = np.maximum(depth - _NEAR * camera.distance, 0)
    return camera.project(points - excess[:, None] * camera.turn[2])[0][:, :2]


def floor_lines(canvas: Canvas, camera: Camera, low: Floats, high: Floats, floor: float, step: float = 1.0) -> None:
    """A floor of whole tiles from corner ``low`` to corner ``high`` (x, z), with lines every ``step`` metres."""
    first, last = np.floor(low / step) * step, np.ceil(high / step) * step
    corners = np.array([[first[0], first[1]], [last[0], first[1]], [last[0], last[1]], [first[0], last[1]]])
    canvas.polygon(on_floor(camera, corners, floor), "floor")
    for axis in (0, 1):
        for at in np.arange(first[axis], last[axis] + step / 2, step):
            ends = np.array([first, last])
            ends[:, axis] = at
            canvas.line(on_floor(camera, ends, floor), "grid", 1.0)


def floor_areas(canvas: Canvas, camera: Camera, areas: list[Floats], floor: float) -> None:
    """The polygons where one may walk."""
    for area in areas:
        pixels = on_floor(camera, area, floor)
        canvas.polygon(pixels, "floor")
        canvas.line(np.concatenate([pixels, pixels[:1]]), "grid", 1.5)


def ways(canvas: Canvas, camera: Camera, paths: list[Floats], floor: float) -> None:
    """Paths on the floor, dashed."""
    for path in paths:
        canvas.line(on_floor(camera, _dotted(path), floor), "path", 2.0, dashes=3)


def _dotted(path: Floats, apart: float = 0.04) -> Floats:
    """The polyline with a point every 4 cm."""
    along = np.append(0, np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1)))
    at = np.linspace(0, along[-1], max(2, round(along[-1] / apart)))
    return np.stack([np.interp(at, along, path[:, axis]) for axis in (0, 1)], axis=-1)
