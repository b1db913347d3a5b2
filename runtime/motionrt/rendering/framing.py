"""Where the camera stands, so that all of a take is in the picture."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.motion.motion import Motion
from motionrt.motion.transforms import heading
from motionrt.rendering.camera import Camera, fitted, looking
from motionrt.rendering.canvas import Box
from motionrt.rendering.look import Look
from motionrt.rendering.solids import Floats
from motionrt.rendering.takes import Take

FLESH, CROWN = 0.13, 0.21  # metres around the joints, and above the head, that belong to the body
_LEAVES = 2.5  # metres that a character has to go for the camera to follow
_TALL = 1.8
_STIFFNESS_S = 0.5  # how slowly a following camera follows


def first_heading(motion: Motion) -> float:
    """Radians from +Z towards +X that the character faces in its first frame; 0 for skeletons without hips."""
    try:
        return float(heading(motion[:1])[0])
    except InvalidInputError:
        return 0.0


def extent(take: Take) -> tuple[Floats, Floats]:
    """Lowest and highest x and z of the motion and of what belongs to it."""
    marks = np.array([mark.point for mark in take.marks], np.float32).reshape(-1, 3)[:, [0, 2]]
    points = [take.motion.positions()[..., [0, 2]].reshape(-1, 2), marks, *take.paths, *take.areas]
    together = np.concatenate([np.asarray(part, np.float32) for part in points])
    return together.min(axis=0), together.max(axis=0)


def follows(take: Take, look: Look) -> bool:
    """Whether the camera goes along."""
    if look.follow is not None:
        return look.follow
    ground = take.motion.root[:, [0, 2]]
    return bool(np.linalg.norm(np.ptp(ground, axis=0)) > _LEAVES)


def targets(take: Take, follow: bool) -> Floats:
    """``(F, 3)`` what the camera looks at: the pelvis, calmly, or the middle of the scene."""
    root = take.motion.root.copy()
    root[:, 1] = take.ground + 0.5 * _TALL
    if follow:
        return _calm(root, _STIFFNESS_S * take.motion.fps)
    low, high = extent(take)
    middle = (low + high) / 2
    return np.tile(np.array([middle[0], root[0, 1], middle[1]], np.float32), (len(root), 1))


def _calm(points: Floats, width: float) -> Floats:
    """Points ``(F, 3)`` averaged over a bell of ``width`` frames; the ends are reflected through themselves."""
    reach = int(3 * width)
    if reach < 1 or len(points) < 2:
        return points
    before = 2 * points[0] - points[np.minimum(np.arange(reach, 0, -1), len(points) - 1)]
    after = 2 * points[-1] - points[np.maximum(len(points) - 1 - np.arange(1, reach + 1), 0)]
    bell = np.exp(-0.5 * (np.arange(-reach, reach + 1) / width) ** 2)
    padded = np.concatenate([before, points, after])
    calm = [np.convolve(padded[:, axis], bell / bell.sum(), "valid") for axis in range(3)]
    return np.stack(calm, axis=-1).astype(np.float32)


def cameras(take: Take, look: Look, box: Box, every: Sequence[int]) -> list[Camera]:
    """A camera for each of the frames ``every``, all of one scale, that fits the pixels of ``box``."""
    follow = follows(take, look)
    aims = targets(take, follow)
    joints = take.motion.positions()[:: max(1, take.motion.frames // 400)]
    seen = joints - aims[:: max(1, take.motion.frames // 400), None] if follow else joints
    space = np.concatenate([_padded(seen.reshape(-1, 3)), _mesh(take, aims if follow else 0 * aims)])
    if not follow:
        space = np.concatenate([space, _belongings(take)])
    base = aims[0] * 0 if follow else aims[0]
    distance = 4.5 + 1.6 * float(np.linalg.norm(np.ptp(space, axis=0)[[0, 2]]))
    camera = looking(look.view, first_heading(take.motion), look.elevation, base, distance)
    fit = fitted(camera, space, box)
    return [fit.at(aims[frame]) if follow else fit for frame in every]


def _padded(points: Floats) -> Floats:
    """Points with the flesh around them, and the head above them."""
    return np.concatenate([points - FLESH, points + np.array([FLESH, CROWN, FLESH], np.float32)])


def _mesh(take: Take, aims: Floats) -> Floats:
    """Points ``(N, 3)`` of a character in some frames, as seen from what the camera looks at ``(F, 3)``."""
    if take.dressed is None:
        return np.zeros((0, 3), np.float32)
    some = range(0, take.motion.frames, max(1, take.motion.frames // 40))
    return np.concatenate([take.outline(frame) - aims[frame] for frame in some])


def _belongings(take: Take) -> Floats:
    """Points ``(N, 3)`` of paths, areas, things and marks."""
    flat = [np.insert(np.asarray(line, np.float32), 1, take.ground, axis=1) for line in (*take.paths, *take.areas)]
    marks = np.array([mark.point for mark in take.marks], np.float32).reshape(-1, 3)
    return np.concatenate([*flat, marks, np.asarray(take.things, np.float32).reshape(-1, 3)])
