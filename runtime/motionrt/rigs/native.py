"""Files that hold ``smpl24`` itself: nothing to retarget, so they come back exactly as they were written."""

from __future__ import annotations

import numpy as np

from motionrt.motion.batches import by_batches
from motionrt.motion.motion import Motion
from motionrt.motion.skeleton import SMPL24
from motionrt.rigs.clip import RigClip

_TOLERANCE = 1e-3
_UNITS = (1.0, 0.1, 0.01, 0.001, 0.0254)


def as_own_motion(clip: RigClip) -> Motion | None:
    """The Motion that ``clip`` holds if its rig is ``smpl24``, in whatever unit and with or without end
    sites.

    Returns:
        ``None`` where names, tree or proportions differ, joints other than the root are translated, or Z is
        up.
    """
    if clip.up == "z" or not set(SMPL24.names) <= set(clip.names):
        return None
    order = [clip.names.index(name) for name in SMPL24.names]
    extra = [name for name in clip.names if name not in SMPL24.names and not name.endswith("_end")]
    parents = [order.index(clip.parents[j]) if clip.parents[j] in order else -1 for j in order]
    if extra or tuple(parents) != SMPL24.parents:
        return None
    offsets, body = clip.offsets[order][1:].astype(np.float64), SMPL24.offsets[1:]
    ratio = float(np.linalg.norm(body)) / max(float(np.linalg.norm(offsets)), 1e-12)
    scale = _snapped(ratio)
    limbs = order[1:]
    moves = by_batches(lambda some: np.abs(some[:, limbs] - clip.offsets[limbs]).max(axis=(1, 2)), clip.translations)
    if scale * float(moves.max()) > _TOLERANCE or np.abs(scale * offsets - body).max() > _TOLERANCE:
        return None
    rotations = clip.rotations
    if order != list(range(len(clip.names))):
        rotations = by_batches(lambda some: some[:, order], rotations)
    return Motion(rotations, scale * clip.translations[:, order[0]], clip.fps)


def _snapped(ratio: float) -> float:
    """``ratio``, or the unit that it stands for after a file's rounding."""
    return next((unit for unit in _UNITS if abs(ratio / unit - 1) < _TOLERANCE), ratio)
