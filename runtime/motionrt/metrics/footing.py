"""How well feet stand, foot by foot: skate of each, speed at contact, share of contacts  [Continual 4.3]."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.metrics.locomotion import SKATE_HEIGHT_CM, point_skates
from motionrt.motion.skeleton import SMPL24
from motionrt.motion.transforms import TOE_JOINTS

_TOES = [SMPL24.index(name) for name in TOE_JOINTS]
_ANKLES = [SMPL24.index(name) for name in ("left_ankle", "right_ankle")]
TIP = 0.07  # metres of the toes beyond their joint, along the sole
_REST = SMPL24.offsets[_TOES[0]].astype(np.float64)
_SLOPE = float(np.arctan2(-_REST[1], np.hypot(_REST[0], _REST[2])))  # of the bone from ankle to toes over a flat sole
RISING = 0.001  # metres a frame (at 30 fps) that a toe may rise and still count as standing


@dataclass(frozen=True)
class Footing:
    """Measures of a motion's feet; the points are the two toe joints, as in ``foot_skate``.

    Attributes:
        left_skate_cm, right_skate_cm: cm per frame, the printed formula for one foot; the paper measures the right one.
        skate_cm: their sum, which is :func:`motionrt.metrics.locomotion.foot_skate`.
        right_tip_cm: cm per frame of the tip of the right foot's toes, the joints' nearest to the vertex of the body's
            surface that the paper looks at.
        contact_speed: m/s over the ground of feet at contact: lower than 2.5 cm and not rising; 0 without contacts.
        contact_share: share of the frames in which a foot is at contact, mean of both.
    """

    left_skate_cm: float
    right_skate_cm: float
    skate_cm: float
    right_tip_cm: float
    contact_speed: float
    contact_share: float

    @property
    def difference(self) -> float:
        """By how much the feet's skates differ, as a share of the larger one."""
        larger = max(self.left_skate_cm, self.right_skate_cm)
        return abs(self.left_skate_cm - self.right_skate_cm) / larger if larger > 0 else 0.0

    def as_dict(self) -> dict[str, float]:
        """Plain numbers by name, for JSON."""
        return asdict(self)


def footing(positions: npt.ArrayLike, fps: float, floor: float = 0.0) -> Footing:
    """Measure both feet.

    Args:
        positions: ``(F >= 2, 24, 3)`` global joints of ``smpl24``, metres.
        fps: frames per second.
        floor: height in metres of the toe joint of a standing foot.

    Raises:
        InvalidInputError: another shape, or a rate that is not positive.
    """
    joints = np.asarray(positions, dtype=np.float64)
    if joints.ndim != 3 or joints.shape[1:] != (len(SMPL24), 3) or len(joints) < 2 or not fps > 0:
        raise InvalidInputError(
            f"footing needs positions (F >= 2, 24, 3) and a positive fps, not {joints.shape}, {fps}"
        )
    toes = joints[:, _TOES] * 100
    step = np.linalg.norm(np.diff(toes[..., [0, 2]], axis=0), axis=-1)  # (F - 1, 2) cm
    height = np.maximum(toes[1:, :, 1] - 100 * floor, 0)
    left, right = point_skates(toes, 100 * floor).mean(axis=0)
    stands = (height < SKATE_HEIGHT_CM) & (np.diff(toes[..., 1], axis=0) <= 100 * RISING * 30 / fps)
    speed = float(step[stands].mean() * fps / 100) if stands.any() else 0.0
    tip = float(point_skates(_tips(joints)[:, 1:] * 100, 100 * floor).mean())
    return Footing(float(left), float(right), float(left + right), tip, speed, float(stands.mean()))


def _tips(joints: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """``(F, 2, 3)`` tips of the toes: along the sole, or level where the heel is up, because toes bend."""
    bone = joints[:, _TOES] - joints[:, _ANKLES]
    level = bone * np.array([1.0, 0.0, 1.0])
    along = level / np.maximum(np.linalg.norm(level, axis=-1, keepdims=True), 1e-9)
    pitch = np.maximum(np.arctan2(bone[..., 1], np.linalg.norm(level, axis=-1)) + _SLOPE, 0.0)
    up = np.array([0.0, 1.0, 0.0])
    return np.asarray(joints[:, _TOES] + TIP * (np.cos(pitch)[..., None] * along + np.sin(pitch)[..., None] * up))
