"""From where a scene is looked at, and where its points come to lie in the picture."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.untrusted.arguments import real
from motionrt.untrusted.words import shown

Floats = npt.NDArray[np.float32]
CAMERAS = {"front": 0.0, "three-quarter": 40.0, "side": 90.0, "back": 180.0, "left": -90.0, "top": 0.0}
"""Degrees from the character's front to its right, of the cameras that have a name."""
_ELEVATIONS = {"top": 88.0, "three-quarter": 14.0}


@dataclass(frozen=True)
class Camera:
    """A camera with perspective.

    Attributes:
        turn: ``(3, 3)`` from the world to the camera: x to the right, y up, z towards the eye.
        target: ``(3,)`` metres, what it looks at.
        distance: metres from the eye to the target.
        scale: pixels per metre at the target.
        centre: pixel of the target.
    """

    turn: Floats
    target: Floats
    distance: float
    scale: float = 1.0
    centre: tuple[float, float] = (0.0, 0.0)

    def project(self, points: Floats) -> tuple[Floats, Floats]:
        """Pixels ``(..., 3)`` (x, y down, depth towards the eye) of points ``(..., 3)``, and pixels per metre there."""
        seen = (points - self.target) @ self.turn.T
        nearness = np.minimum(seen[..., 2] / self.distance, 0.98)
        size = self.scale / (1 - nearness)
        depth = -self.scale * self.distance * np.log1p(-nearness)  # its slope is `size`: spheres stay round
        x, y = self.centre[0] + size * seen[..., 0], self.centre[1] - size * seen[..., 1]
        return np.stack([x, y, depth], axis=-1).astype(np.float32), size.astype(np.float32)

    def at(self, target: Floats) -> Camera:
        """The same camera, moved with its target."""
        return replace(self, target=target)

    @property
    def away(self) -> Floats:
        """``(3,)`` unit vector in the ground plane that leads away from the eye."""
        away = -self.turn[2] * np.array([1, 0, 1], np.float32)
        length = float(np.linalg.norm(away))
        up = self.turn[1] * np.array([1, 0, 1], np.float32)
        flat = away / length if length > 1e-3 else up / max(float(np.linalg.norm(up)), 1e-9)
        return np.asarray(flat, np.float32)

    @property
    def aside(self) -> Floats:
        """``(3,)`` unit vector to the right of the picture."""
        return np.asarray(self.turn[0], np.float32)


def looking(camera: str | float, heading: float, elevation: float | None, target: Floats, distance: float) -> Camera:
    """A camera of that name, or that many degrees from the front of somebody who faces ``heading`` to their right.

    Args:
        camera: a name out of :data:`CAMERAS`, or degrees.
        heading: radians from +Z towards +X.
        elevation: degrees above the horizon; None is what suits the name.
        target: ``(3,)`` metres.
        distance: metres.
    """
    yaw = heading - np.radians(CAMERAS[camera] if isinstance(camera, str) else camera)
    pitch = np.radians(_ELEVATIONS.get(str(camera), 8.0) if elevation is None else elevation)
    eye = np.array([np.sin(yaw) * np.cos(pitch), np.sin(pitch), np.cos(yaw) * np.cos(pitch)])
    right = np.array([np.cos(yaw), 0.0, -np.sin(yaw)])
    turn = np.stack([right, np.cross(eye, right), eye]).astype(np.float32)
    return Camera(turn, np.asarray(target, np.float32), distance)


def checked_camera(camera: str | float) -> str | float:
    """The camera; a text that is a number becomes one.

    Raises:
        InvalidInputError: there is no camera of that name, or a number that is not finite.
    """
    if isinstance(camera, str) and camera in CAMERAS:
        return camera
    try:
        degrees = float(camera) if isinstance(camera, str) else real(camera)
    except ValueError:
        degrees = np.nan
    if not np.isfinite(degrees):
        raise InvalidInputError(f"no camera {shown(camera)}: {', '.join(CAMERAS)}, or degrees from the front")
    return degrees


def fitted(camera: Camera, points: Floats, box: tuple[float, float, float, float]) -> Camera:
    """The camera with scale and centre such that points ``(N, 3)`` fill the pixels (left, top, right, bottom)."""
    flat = replace(camera, scale=1.0, centre=(0.0, 0.0)).project(points)[0][..., :2].reshape(-1, 2)
    low, high = flat.min(axis=0), flat.max(axis=0)
    left, top, right, bottom = box
    wide, tall = np.maximum(high - low, 1e-3)
    scale = float(min((right - left) / wide, (bottom - top) / tall))
    middle = (low + high) / 2
    centre = ((left + right) / 2 - scale * middle[0], (top + bottom) / 2 - scale * middle[1])
    return replace(camera, scale=scale, centre=(float(centre[0]), float(centre[1])))
