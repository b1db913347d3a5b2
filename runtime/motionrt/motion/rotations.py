"""Rotations as broadcasting NumPy functions over ``[..., 3, 3]`` matrices, ``[..., 4]`` quaternions and friends.

Quaternions are ``wxyz`` (real part first), angles radians. SciPy is not imported here: it would cost every cold
start a third of a second. Everything keeps the dtype of its input where that is floating point.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError

Array = npt.NDArray[np.floating[Any]]

_AXES = {"X": 0, "Y": 1, "Z": 2}


def axis_rotation(axis: str, angle: npt.ArrayLike) -> Array:
    """Rotation about one coordinate axis: angles ``[...]`` radians -> matrices ``[..., 3, 3]``."""
    angle = np.asarray(angle)
    i = _AXES[axis.upper()]
    j, k = (i + 1) % 3, (i + 2) % 3
    out = np.zeros((*angle.shape, 3, 3), dtype=np.result_type(angle, np.float32))
    cos, sin = np.cos(angle), np.sin(angle)
    out[..., i, i] = 1
    out[..., j, j], out[..., j, k] = cos, -sin
    out[..., k, j], out[..., k, k] = sin, cos
    return out


def euler_to_matrix(angles: npt.ArrayLike, order: str) -> Array:
    """Intrinsic Euler angles ``[..., n]`` radians in the axis ``order`` ("ZXY": first Z, then the new X ...).

    This is the order in which BVH lists its channels. ``n`` may be 1, 2 or 3. Returns ``[..., 3, 3]``.
    """
    angles = np.asarray(angles)
    if not order or angles.shape[-1] != len(order) or any(axis.upper() not in _AXES for axis in order):
        raise InvalidInputError(f"need one angle per axis of '{order}', an order over X, Y and Z")
    out = axis_rotation(order[0], angles[..., 0])
    for i, axis in enumerate(order[1:], start=1):
        out = out @ axis_rotation(axis, angles[..., i])
    return out


def matrix_to_euler(matrices: Array, order: str) -> Array:
    """Inverse of :func:`euler_to_matrix` for three different axes: ``[..., 3, 3]`` -> ``[..., 3]`` radians.

    At gimbal lock (middle angle at +-90 degrees) the third angle is set to zero.
    """
    i, j, k = (_AXES[axis] for axis in order.upper())
    if len({i, j, k}) != 3:
        raise InvalidInputError(f"Euler order '{order}' must name three different axes")
    sign = 1.0 if (j - i) % 3 == 1 else -1.0
    m = np.asarray(matrices)
    first = np.arctan2(-sign * m[..., j, k], m[..., k, k])
    locked = np.hypot(m[..., j, k], m[..., k, k]) < 1e-6
    first = np.where(locked, np.arctan2(sign * m[..., k, j], m[..., j, j]), first)
    rest = np.swapaxes(axis_rotation(order[0], first), -1, -2) @ m  # what the second and third angle are left with
    middle = np.arctan2(sign * rest[..., i, k], rest[..., k, k])
    third = np.where(locked, 0, np.arctan2(sign * rest[..., j, i], rest[..., j, j]))
    return np.stack([first, middle, third], axis=-1).astype(m.dtype)


def axis_angle_to_matrix(vectors: npt.ArrayLike) -> Array:
    """Rodrigues' formula: rotation vectors ``[..., 3]`` radians -> ``[..., 3, 3]``."""
    v = np.asarray(vectors)
    angle = np.linalg.norm(v, axis=-1)[..., None, None]
    skew = skew_matrix(v)
    small = angle < 1e-6
    safe = np.where(small, 1, angle)
    a = np.where(small, 1 - angle**2 / 6, np.sin(safe) / safe)
    b = np.where(small, 0.5 - angle**2 / 24, (1 - np.cos(safe)) / safe**2)
    return np.asarray(np.eye(3, dtype=v.dtype) + a * skew + b * (skew @ skew), dtype=v.dtype)


def matrix_to_axis_angle(matrices: Array) -> Array:
    """``[..., 3, 3]`` -> rotation vectors ``[..., 3]`` radians with angle in [0, pi]."""
    q = matrix_to_quaternion(matrices)
    sine = np.linalg.norm(q[..., 1:], axis=-1, keepdims=True)
    angle = 2 * np.arctan2(sine, q[..., :1])
    scale = np.where(sine < 1e-7, 2.0, angle / np.where(sine < 1e-7, 1, sine))
    return (q[..., 1:] * scale).astype(q.dtype)


def skew_matrix(vectors: npt.ArrayLike) -> Array:
    """Cross-product matrices: ``[..., 3]`` -> ``[..., 3, 3]`` with ``skew(v) @ w == cross(v, w)``."""
    v = np.asarray(vectors)
    out = np.zeros((*v.shape, 3), dtype=v.dtype)
    x, y, z = v[..., 0], v[..., 1], v[..., 2]
    out[..., 0, 1], out[..., 0, 2], out[..., 1, 2] = -z, y, -x
    out[..., 1, 0], out[..., 2, 0], out[..., 2, 1] = z, -y, x
    return out


def quaternion_to_matrix(wxyz: npt.ArrayLike) -> Array:
    """Quaternions ``[..., 4]`` wxyz, of any non-zero length, -> ``[..., 3, 3]``."""
    q = np.asarray(wxyz)
    q = q / np.linalg.norm(q, axis=-1, keepdims=True)
    skew = skew_matrix(q[..., 1:])
    return np.asarray(np.eye(3, dtype=q.dtype) + 2 * (q[..., :1, None] * skew + skew @ skew))


def matrix_to_quaternion(matrices: Array) -> Array:
    """``[..., 3, 3]`` -> unit quaternions ``[..., 4]`` wxyz with ``w >= 0`` (Shepperd's method)."""
    m = np.asarray(matrices)
    diagonal = np.diagonal(m, axis1=-2, axis2=-1)
    trace = diagonal.sum(-1, keepdims=True)
    sizes = np.concatenate([trace, diagonal], axis=-1)
    q = np.empty((*m.shape[:-2], 4, 4), dtype=m.dtype)  # four candidates, each good where its pivot is large
    x, y, z = (m[..., 2, 1] - m[..., 1, 2]), (m[..., 0, 2] - m[..., 2, 0]), (m[..., 1, 0] - m[..., 0, 1])
    xy, xz, yz = (m[..., 0, 1] + m[..., 1, 0]), (m[..., 0, 2] + m[..., 2, 0]), (m[..., 1, 2] + m[..., 2, 1])
    pivots = 1 + 2 * diagonal - trace
    q[..., 0, :] = np.stack([1 + trace[..., 0], x, y, z], -1)
    q[..., 1, :] = np.stack([x, pivots[..., 0], xy, xz], -1)
    q[..., 2, :] = np.stack([y, xy, pivots[..., 1], yz], -1)
    q[..., 3, :] = np.stack([z, xz, yz, pivots[..., 2]], -1)
    best = np.argmax(sizes, axis=-1)
    chosen = np.take_along_axis(q, best[..., None, None], axis=-2)[..., 0, :]
    chosen = chosen / np.linalg.norm(chosen, axis=-1, keepdims=True)
    return np.asarray(np.where(chosen[..., :1] < 0, -chosen, chosen))


def matrix_to_6d(matrices: Array) -> Array:
    """Continuous 6D representation (Zhou et al. 2019): the first two columns, ``[..., 3, 3]`` -> ``[..., 6]``."""
    m = np.asarray(matrices)
    return np.concatenate([m[..., :, 0], m[..., :, 1]], axis=-1)


def matrix_from_6d(sixd: npt.ArrayLike) -> Array:
    """Gram-Schmidt inverse of :func:`matrix_to_6d`; any two independent columns ``[..., 6]`` -> ``[..., 3, 3]``."""
    d = np.asarray(sixd)
    x = normalise(d[..., :3])
    y = d[..., 3:] - (x * d[..., 3:]).sum(-1, keepdims=True) * x
    y = normalise(y)
    return np.stack([x, y, np.cross(x, y)], axis=-1)


def normalise(vectors: Array) -> Array:
    """Unit vectors along the last axis; vectors shorter than 1e-12 come back as they are."""
    norm = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.where(norm < 1e-12, 1, norm))


def rotation_between(source: npt.ArrayLike, target: npt.ArrayLike) -> Array:
    """The smallest rotation that turns direction ``source`` into ``target``: two ``[..., 3]`` -> ``[..., 3, 3]``.

    For opposite directions it is half a turn about some axis orthogonal to both.
    """
    pair = normalise(np.asarray(source, dtype=np.float64)), normalise(np.asarray(target, dtype=np.float64))
    a, b = np.broadcast_arrays(*pair)
    half = a + b
    opposite = np.linalg.norm(half, axis=-1, keepdims=True) < 1e-6
    helper = np.where(np.abs(a[..., :1]) < 0.9, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    half = normalise(np.where(opposite, np.cross(a, helper), half))
    turn = 2 * half[..., :, None] * half[..., None, :] - np.eye(3)  # half a turn about the bisector ...
    flip = 2 * a[..., :, None] * a[..., None, :] - np.eye(3)  # ... after half a turn about the source
    return np.asarray(np.where(opposite[..., None], turn, turn @ flip))


def project_to_so3(matrices: Array) -> Array:
    """The nearest rotations (Frobenius norm) to any ``[..., 3, 3]`` matrices, by SVD."""
    u, _, vt = np.linalg.svd(np.asarray(matrices, dtype=np.float64))
    sign = np.sign(np.linalg.det(u @ vt))
    u[..., :, 2] *= sign[..., None]
    return np.asarray((u @ vt).astype(np.asarray(matrices).dtype))


def slerp(start: Array, end: Array, weight: npt.ArrayLike) -> Array:
    """Constant-speed interpolation on the sphere: quaternions ``[..., 4]`` wxyz and weights ``[...]`` in [0, 1].

    Takes the shorter way round; ``weight`` 0 gives ``start``, 1 gives ``end`` (up to sign).
    """
    w = np.asarray(weight)[..., None]
    dot = (start * end).sum(-1, keepdims=True)
    end = np.where(dot < 0, -end, end)
    angle = np.arccos(np.clip(np.abs(dot), 0, 1))
    sine = np.sin(angle)
    near = sine < 1e-4
    safe = np.where(near, 1, sine)
    a = np.where(near, 1 - w, np.sin((1 - w) * angle) / safe)
    b = np.where(near, w, np.sin(w * angle) / safe)
    return normalise(a * start + b * end)


def wrapped(angle: npt.ArrayLike) -> Array:
    """The same angles ``[...]`` in [-pi, pi), radians."""
    return np.asarray((np.asarray(angle) + np.pi) % (2 * np.pi) - np.pi)


def yaw_angle(directions: npt.ArrayLike) -> Array:
    """Heading of directions ``[..., 3]``: the angle in the ground plane from +Z towards +X, radians."""
    d = np.asarray(directions)
    return np.asarray(np.arctan2(d[..., 0], d[..., 2]))
