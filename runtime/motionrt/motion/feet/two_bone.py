"""Inverse kinematics of two bones, over any number of limbs and frames at once: leg or arm, in closed form."""

from __future__ import annotations

import numpy as np

from motionrt.motion.rotations import Array, lengths, normalise, rotation_between
from motionrt.motion.skeleton import SMPL24

SOFT = 0.01
_LEG = ("hip", "knee", "ankle", "foot")
LEG_JOINTS = tuple(tuple(SMPL24.index(f"{side}_{name}") for name in _LEG) for side in ("left", "right"))
"""Hip, knee, ankle and toe joint of the left and of the right leg."""
_STRAIGHT, _BENT = 0.015, 0.05  # distances of the middle joint from the line between the ends, shares of the limb


def two_bone(chain: Array, rotations: Array, target: Array, pole: Array, soft: float = SOFT) -> tuple[Array, Array]:
    """Bring the end of a limb to ``target``: the smallest turn towards it, bent in the plane it is bent in.

    The last ``soft`` share of the limb's length is approached but never crossed, so a limb does not snap straight. A
    limb that is straighter than that already may keep its length: with ``target`` at the end joint nothing changes.

    Args:
        chain: ``(..., 3, 3)`` global positions of the joints (hip, knee, ankle; or shoulder, elbow, wrist), metres.
        rotations: ``(..., 2, 3, 3)`` global rotations of the first two.
        target: ``(..., 3)`` wanted position of the third, metres.
        pole: ``(..., 3)`` direction to which the middle joint bends; it counts where a straight limb bends further.
        soft: share of the limb's length, from 0 to 1.

    Returns:
        New positions ``(..., 3, 3)`` and new global rotations ``(..., 2, 3, 3)``, float64. The end joint's own global
        rotation is the caller's to keep: its local one is ``rotations[..., 1].T @ global``.
    """
    start, middle, end = (np.asarray(chain[..., i, :], dtype=np.float64) for i in range(3))
    upper, lower = middle - start, end - middle
    line, way = end - start, target - start
    a, b = _length(upper), _length(lower)
    now, wanted = _length(line), _length(way)
    distance = _soft_reach(wanted, now, a + b, soft)
    distance = np.maximum(distance, np.abs(a - b) * (1 + 1e-6) + 1e-9)
    swing = rotation_between(line, way)
    share = (a**2 - b**2 + distance**2) / (2 * distance)
    height = np.sqrt(np.maximum(a**2 - share**2, 0))
    along = normalise(_turn(swing, line))
    new_middle = start + along * share + _turn(swing, _bend(upper, line, pole, height, a + b)) * height
    new_end = start + along * distance
    bones = np.stack([upper, lower], axis=-2) @ np.swapaxes(swing, -1, -2)
    turns = rotation_between(bones, np.stack([new_middle - start, new_end - new_middle], axis=-2))
    turned = turns @ (swing[..., None, :, :] @ rotations)
    return np.stack([start, new_middle, new_end], axis=-2), turned


def soft_limit(distance: Array, full: Array, soft: float = SOFT) -> Array:
    """How far a limb of length ``full``, now reaching ``distance``, reaches exactly, before the soft zone begins."""
    return np.asarray(np.clip(distance, full * (1 - soft), full * (1 - 1e-5)))


def _soft_reach(wanted: Array, now: Array, full: Array, soft: float) -> Array:
    """``wanted`` up to the soft limit; beyond it, exponentially closer to ``full``."""
    limit = soft_limit(now, full, soft)
    room = full - limit
    over = np.maximum(wanted - limit, 0)
    return np.asarray(np.where(over > 0, limit + room * -np.expm1(-over / room), wanted))


def _bend(upper: Array, line: Array, pole: Array, height: Array, full: Array) -> Array:
    """Unit direction, orthogonal to ``line``, in which the middle joint will stand off it by ``height``.

    The direction that it has; but where a nearly straight limb bends further, that says little and the pole counts.
    """
    line = normalise(line)
    off, guide = _orthogonal(upper, line), normalise(_orthogonal(np.asarray(pole, dtype=np.float64), line))
    now = _length(off)
    straight = np.clip((_BENT * full - now) / ((_BENT - _STRAIGHT) * full), 0, 1)
    return normalise(off + guide * (4 * straight * np.maximum(height - now, 0) + 1e-9))


def _orthogonal(vectors: Array, line: Array) -> Array:
    return np.asarray(vectors - np.einsum("...d,...d->...", vectors, line)[..., None] * line)


def _length(vectors: Array) -> Array:
    return lengths(vectors)[..., None]


def _turn(matrices: Array, vectors: Array) -> Array:
    return np.asarray((matrices @ vectors[..., None])[..., 0])


def bend_legs(rotations: Array, positions: Array, turned: Array, offset: Array, soft: float = SOFT) -> Array:
    """Move both feet of every frame by bending the legs; the feet keep their global rotations.

    Args:
        rotations: ``(..., 24, 3, 3)`` local rotations of ``smpl24``.
        positions: ``(..., 24, 3)`` global joint positions, metres.
        turned: ``(..., 24, 3, 3)`` global rotations.
        offset: ``(..., 2, 3)`` metres that the left and the right ankle shall move.
        soft: as for :func:`two_bone`.

    Returns:
        New local rotations, of the dtype of ``rotations``.
    """
    legs = np.array(LEG_JOINTS)
    chain, pelvis = positions[..., legs[:, :3], :], turned[..., None, 0, :, :]
    forward = turned[..., legs[:, 0], :, :][..., 2]  # knees are hinges: they bend towards the thigh's own Z axis
    _, bent = two_bone(chain, turned[..., legs[:, :2], :, :], chain[..., 2, :] + offset, forward, soft)
    upper, lower = bent[..., 0, :, :], bent[..., 1, :, :]
    out = rotations.copy()
    out[..., legs[:, 0], :, :] = _undo(pelvis) @ upper
    out[..., legs[:, 1], :, :] = _undo(upper) @ lower
    out[..., legs[:, 2], :, :] = _undo(lower) @ turned[..., legs[:, 2], :, :]
    return out


def _undo(rotations: Array) -> Array:
    return np.swapaxes(rotations, -1, -2)
