"""``ego77``: joints and foot contacts about a body that goes and turns, 20 fps; what the motion generator sees.

Columns of a frame (F, 77), the body's axes being left, up and forward of where it faces:

| columns | |
|---|---|
| 0 | turn to the next frame, radians, left positive |
| 1, 2 | way of the pelvis over the ground to the next frame, left and forward, metres |
| 3 | height of the pelvis, metres |
| 4 to 72 | joints 1 to 23 of ``smpl24`` from the point under the pelvis, in the body's axes, metres |
| 73 to 76 | contact of left ankle, right ankle, left foot, right foot, 0 or 1 |

Joints say nothing of twist, so that no rig's twist gets in; rotations follow from them (`motion.from_positions`).
A motion bends by adding to column 0, and is mirrored by exchanging and negating columns.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.motion.skeleton import SMPL24, FloatArray

FPS = 20.0
WIDTH = 77
ROOT, JOINTS, CONTACTS = slice(0, 4), slice(4, 73), slice(73, 77)
FEET = tuple(SMPL24.index(f"{side}_{joint}") for joint in ("ankle", "foot") for side in ("left", "right"))

LOW = (0.13, 0.13, 0.08, 0.08)
"""Heights of :data:`FEET` over the floor, metres, up to which a foot stands."""

_SLOW = 0.35  # m/s up to which a foot stands
_LEVEL = 0.6  # share of the line across the body that must lie level for its heading to be told
_SMOOTH_S = 0.1  # standard deviation of the smoothing of the heading, seconds

Array = npt.NDArray[np.float64]


def encode(joints: npt.ArrayLike) -> FloatArray:
    """``(F, 24, 3)`` joints in metres at 20 fps, Y up, the floor at 0, to ``(F, 77)`` float32.

    The last frame's ways are those of the frame before.

    Raises:
        InvalidInputError: another shape.
    """
    given = np.asarray(joints, dtype=np.float64)
    if given.ndim != 3 or given.shape[1:] != (len(SMPL24), 3) or not len(given):
        raise InvalidInputError(f"ego77 wants joints of the shape (frames >= 1, 24, 3), not {given.shape}")
    yaw = facing(given)
    pelvis = given[:, 0]
    steps = _ahead(np.diff(pelvis[:, [0, 2]], axis=0))
    left, forward = to_body(steps[:, 0], steps[:, 1], yaw)
    about = given[:, 1:] - pelvis[:, None] * [1.0, 0.0, 1.0]
    x, z = to_body(about[..., 0], about[..., 2], yaw[:, None])
    own = np.stack([x, about[..., 1], z], axis=-1).reshape(len(given), -1)
    root = np.stack([_ahead(np.diff(yaw)[:, None])[:, 0], left, forward, pelvis[:, 1]], axis=1)
    return np.concatenate([root, own, contacts(given)], axis=1).astype(np.float32)


def decode(features: npt.ArrayLike) -> Array:
    """``(F, 77)`` to joints ``(F, 24, 3)`` in metres; the first frame stands above the origin and faces +Z.

    Raises:
        InvalidInputError: another shape.
    """
    rows = np.asarray(features, dtype=np.float64)
    if rows.ndim != 2 or rows.shape[1] != WIDTH or not len(rows):
        raise InvalidInputError(f"expected ego77 features (frames >= 1, {WIDTH}), found shape {rows.shape}")
    yaw = headings(rows)
    x, z = to_body(rows[:, 1], rows[:, 2], -yaw)
    ground = _summed(np.stack([x, z], axis=1))
    own = rows[:, JOINTS].reshape(len(rows), -1, 3)
    x, z = to_body(own[..., 0], own[..., 2], -yaw[:, None])
    pelvis = np.stack([ground[:, 0], rows[:, 3], ground[:, 1]], axis=1)
    others = np.stack([x + ground[:, :1], own[..., 1], z + ground[:, 1:]], axis=-1)
    return np.concatenate([pelvis[:, None], others], axis=1)


def column(joint: int) -> int:
    """The first of the three columns of a joint of ``smpl24``, 1 to 23."""
    return int(JOINTS.start) + 3 * (joint - 1)


def headings(features: Array) -> Array:
    """``(F,)`` heading of every frame of features ``(F, 77)``, radians, 0 at the first, left positive."""
    return _summed(features[:, :1])[:, 0]


def to_body(x: Array, z: Array, yaw: Array | float) -> tuple[Array, Array]:
    """Ways over the ground in the world's axes as (left, forward) of who faces ``yaw``; back again by its negative."""
    c, s = np.cos(yaw), np.sin(yaw)
    return x * c - z * s, x * s + z * c


def mirrored(features: npt.ArrayLike) -> FloatArray:
    """The features ``(..., 77)`` of the mirror image."""
    return np.asarray(np.asarray(features, np.float32)[..., _TWIN] * _SIGNS)


def facing(joints: Array) -> Array:
    """``(F,)`` heading in radians, unwrapped, 0 facing +Z, left positive; bridged where the body lies on its side."""
    hips, shoulders = (joints[:, _pair(name)] for name in ("hip", "shoulder"))
    across = (hips[:, 0] - hips[:, 1]) + 0.5 * (shoulders[:, 0] - shoulders[:, 1])
    level = np.hypot(across[:, 0], across[:, 2]) > _LEVEL * np.linalg.norm(across, axis=1)
    told = np.flatnonzero(level) if level.any() else np.arange(len(across))
    yaw = np.unwrap(np.arctan2(-across[told, 2], across[told, 0]))
    return _smoothed(np.interp(np.arange(len(across)), told, yaw), _SMOOTH_S * FPS)


def contacts(joints: Array) -> Array:
    """``(F, 4)`` whether ankles and feet stand: slow, and low over the floor."""
    feet = joints[:, FEET]
    speed = _ahead(np.linalg.norm(np.diff(feet, axis=0), axis=-1)) * FPS
    low = feet[..., 1] < np.array(LOW)
    return ((speed < _SLOW) & low).astype(np.float64)


def _pair(name: str) -> list[int]:
    return [SMPL24.index(f"{side}_{name}") for side in ("left", "right")]


def _ahead(steps: Array) -> Array:
    """One row more, like the last; of a single frame zeros."""
    last = steps[-1:] if len(steps) else np.zeros((1, *steps.shape[1:]))
    return np.concatenate([steps, last])


def _summed(steps: Array) -> Array:
    return np.concatenate([np.zeros((1, steps.shape[1])), np.cumsum(steps[:-1], axis=0)])


def _smoothed(values: Array, deviation: float) -> Array:
    """A Gaussian mean over frames that keeps straight lines straight up to the ends."""
    reach = min(round(3 * deviation), len(values) - 1)
    if reach < 1:
        return values
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / deviation) ** 2)
    before = 2 * values[0] - values[reach:0:-1]
    after = 2 * values[-1] - values[-2 : -reach - 2 : -1]
    return np.convolve(np.concatenate([before, values, after]), kernel / kernel.sum(), "valid")


def _mirror() -> tuple[npt.NDArray[np.intp], FloatArray]:
    """Which column each column takes its value from in the mirror image, and with which sign."""
    names = SMPL24.names
    swapped = [name.replace("left", "#").replace("right", "left").replace("#", "right") for name in names]
    twin = [SMPL24.index(name) for name in swapped]
    columns = [0, 1, 2, 3]
    signs = [-1.0, -1.0, 1.0, 1.0]
    for joint in range(1, len(names)):
        first = column(twin[joint])
        columns += [first, first + 1, first + 2]
        signs += [-1.0, 1.0, 1.0]
    columns += [74, 73, 76, 75]
    signs += [1.0] * 4
    return np.array(columns), np.array(signs, np.float32)


_TWIN, _SIGNS = _mirror()
