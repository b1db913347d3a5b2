"""Euler angles that importers can interpolate: orders away from gimbal lock, the nearer of two solutions a frame."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import numpy.typing as npt

from motionrt.motion.batches import by_batches
from motionrt.motion.rotations import matrix_to_euler

Angles = npt.NDArray[np.floating]

USUAL_ORDER = "ZXY"
_ORDERS = {
    **dict.fromkeys(("left_hip", "right_hip", "left_knee", "right_knee"), "XZY"),
    **dict.fromkeys(("left_elbow", "right_elbow"), "YZX"),
}
"""Of ``smpl24``: the hinge comes first, since past a right angle about the middle axis the other two turn over."""

_NEAR_LOCK = np.deg2rad(75.0)


def channel_order(name: str, rotations: npt.NDArray[np.floating]) -> str:
    """The order of the rotation channels for the joint ``name`` with local rotations ``(F, 3, 3)``.

    The usual one of the joint, unless its middle angle comes near 90 degrees in this motion and stays lower in another.
    """
    usual = _ORDERS.get(name, USUAL_ORDER)
    if _largest_middle(rotations, usual) < _NEAR_LOCK:
        return usual
    return min(("".join(order) for order in permutations("XYZ")), key=lambda order: _largest_middle(rotations, order))


def _largest_middle(rotations: npt.NDArray[np.floating], order: str) -> float:
    """Largest size of the middle angle, radians: its sine is one entry of the matrix."""
    first, last = "XYZ".index(order[0]), "XYZ".index(order[2])
    return float(np.arcsin(np.clip(np.abs(rotations[:, first, last]).max(), 0, 1)))


def euler_degrees(rotations: npt.NDArray[np.floating], order: str) -> Angles:
    """Angles ``(F, 3)`` in degrees of ``(F, 3, 3)``, each frame by the solution that is nearer to the frame before.

    A rotation has two: ``(a, b, c)`` and ``(a + 180, 180 - b, c + 180)``. Angles do not jump by whole turns.
    """
    one = by_batches(lambda rows: matrix_to_euler(rows.astype(np.float64), order), rotations)
    two = one * [1, -1, 1] + np.pi
    stay, change = _apart(one[1:], one[:-1]), _apart(two[1:], one[:-1])
    second = np.concatenate([[False], np.logical_xor.accumulate(change < stay)]) if len(one) > 1 else np.zeros(1, bool)
    return np.asarray(np.rad2deg(np.unwrap(np.where(second[:, None], two, one), axis=0)))


def _apart(angles: Angles, others: Angles) -> Angles:
    """Largest difference ``(F,)`` of any of three angles, turns apart."""
    return np.asarray(np.abs((angles - others + np.pi) % (2 * np.pi) - np.pi).max(axis=-1))
