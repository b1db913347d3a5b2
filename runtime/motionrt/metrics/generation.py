"""How far generated motions are from recorded ones: APE, AVE, TEMOS score  [TEMOS 4.1, SINC 4.1].

Arrays in, numbers out. A generated motion and its truth have the same number of frames at the same rate, and begin in
the same place with the same heading (``Motion.canonical()``): what is not aligned is counted as an error.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.motion import Motion
from motionrt.motion.rotations import axis_rotation
from motionrt.motion.skeleton import SMPL22_JOINTS
from motionrt.motion.transforms import heading

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Body:
    """Where a body is over time; hands are left out, as ``sinc135`` does not describe them.

    Attributes:
        joints: ``(F, J, 3)`` global joint positions, metres, Y up, the pelvis first.
        yaw: ``(F,)`` heading, radians from +Z towards +X.
    """

    joints: Floats
    yaw: Floats

    def __post_init__(self) -> None:
        joints, yaw = np.asarray(self.joints, dtype=np.float64), np.asarray(self.yaw, dtype=np.float64)
        if joints.ndim != 3 or joints.shape[1] < 2 or joints.shape[2] != 3 or yaw.shape != joints.shape[:1]:
            raise InvalidInputError(
                f"a body needs joints (F, J >= 2, 3) and a heading (F,), not {joints.shape}, {yaw.shape}"
            )
        object.__setattr__(self, "joints", joints)
        object.__setattr__(self, "yaw", yaw)

    @classmethod
    def of(cls, motion: Motion) -> Body:
        """The first 22 joints of a ``smpl24`` motion."""
        return cls(motion.positions()[:, :SMPL22_JOINTS].astype(np.float64), heading(motion).astype(np.float64))

    def local(self) -> Floats:
        """``(F, J - 1, 3)``: joints but the pelvis, over the origin and facing +Z in every frame; heights stay."""
        moved = self.joints[:, 1:] - self.joints[:, :1] * np.array([1.0, 0.0, 1.0])
        return np.asarray(moved @ np.swapaxes(axis_rotation("Y", -self.yaw), -1, -2))

    def views(self) -> tuple[Floats, Floats, Floats, Floats]:
        """What is compared: root, trajectory, local and global joints, each ``(F, joints, axes)``."""
        root = self.joints[:, :1]
        return root, root[..., [0, 2]], self.local(), self.joints


@dataclass(frozen=True)
class PositionErrors:
    """The four columns of APE (metres) or AVE (square metres).

    Attributes:
        root: of the pelvis.
        trajectory: of the pelvis' x and z.
        mean_local: mean over the joints but the pelvis, in the body's own frame (:meth:`Body.local`).
        mean_global: mean over all joints, where they are in the world.
    """

    root: float
    trajectory: float
    mean_local: float
    mean_global: float

    def as_dict(self) -> dict[str, float]:
        """Plain numbers by name, for JSON."""
        return asdict(self)


def ape(found: Sequence[Body], truth: Sequence[Body]) -> PositionErrors:
    """Average positional error: mean distance over all frames of all motions, and over joints, metres.

    Raises:
        InvalidInputError: no motions, or two of a pair that differ in frames or joints.
    """
    pairs = _checked(found, truth)
    frames = sum(len(body.joints) for body in truth)
    sums = [[np.linalg.norm(a - b, axis=-1).mean(axis=1).sum() for a, b in _both(*pair)] for pair in pairs]
    return PositionErrors(*(float(total / frames) for total in np.sum(sums, axis=0)))


def ave(found: Sequence[Body], truth: Sequence[Body]) -> PositionErrors:
    """Average variance error: distance between the variances over time (unbiased) of every joint's coordinates, mean
    over joints and motions, square metres.

    Raises:
        InvalidInputError: as for :func:`ape`, or a motion of a single frame.
    """
    pairs = _checked(found, truth)
    if any(len(body.joints) < 2 for body in truth):
        raise InvalidInputError("a variance over time needs motions of at least two frames")
    rows = [
        [np.linalg.norm(a.var(axis=0, ddof=1) - b.var(axis=0, ddof=1), axis=-1).mean() for a, b in _both(*pair)]
        for pair in pairs
    ]
    return PositionErrors(*(float(value) for value in np.mean(rows, axis=0)))


def temos_scores(found: npt.ArrayLike, truth: npt.ArrayLike) -> Floats:
    """``(N,)`` TEMOS scores ``(1 + cos(f_found, f_truth)) / 2``, 0 to 1, of features ``(N, d)``  [SINC 4.1].

    The features are the means of one motion encoder for all that is compared.
    """
    a, b = np.asarray(found, dtype=np.float64), np.asarray(truth, dtype=np.float64)
    if a.ndim != 2 or a.shape != b.shape or not len(a):
        raise InvalidInputError(f"features must be two arrays (N >= 1, d) of one shape, not {a.shape} and {b.shape}")
    lengths = np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1)
    if not (lengths > 0).all():
        raise InvalidInputError("a feature of length 0 has no direction")
    return np.asarray((1 + (a * b).sum(axis=1) / lengths) / 2)


def _both(found: Body, truth: Body) -> list[tuple[Floats, Floats]]:
    return list(zip(found.views(), truth.views(), strict=True))


def _checked(found: Sequence[Body], truth: Sequence[Body]) -> list[tuple[Body, Body]]:
    if not truth or len(found) != len(truth):
        raise InvalidInputError(f"give as many motions as truths, and at least one: {len(found)} for {len(truth)}")
    for number, (a, b) in enumerate(zip(found, truth, strict=True)):
        if a.joints.shape != b.joints.shape:
            raise InvalidInputError(f"motion {number} is {a.joints.shape} but its truth {b.joints.shape}; trim them")
    return list(zip(found, truth, strict=True))
