"""The yaw of a pelvis: the part of its rotation that the pose prior leaves to the caller."""

from __future__ import annotations

import numpy as np

from motionrt.motion.rotations import Array, axis_rotation


def pelvis_yaw(pelvis: Array) -> Array:
    """Yaw ``[...]`` radians (from +Z towards +X) of pelvis rotations ``[..., 3, 3]``, by the pelvis' left axis.

    The left axis keeps its direction in the ground plane when the body bends forward or lies on its back, where the
    forward axis points up or down.
    """
    return np.asarray(np.arctan2(-pelvis[..., 2, 0], pelvis[..., 0, 0]))


def without_yaw(pelvis: Array) -> Array:
    """What is left of pelvis rotations ``[..., 3, 3]`` when :func:`pelvis_yaw` is taken off: the tilt."""
    return np.asarray(axis_rotation("Y", -pelvis_yaw(pelvis)).astype(pelvis.dtype) @ pelvis)
