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
_BLOCK = 1024  # matrices whose numbers stay in a processor's nearest caches
_MOST_STEPS = 8  # of Newton's iteration; rotations with errors of 10 % take four
_FEW, _NEARLY = 256, 0.5  # matrices, and how far their squares may be from the identity
_IDENTITY = np.eye(3)
_CYCLES = (0, 1, 2), (1, 2, 0), (2, 0, 1)
_WRAPPED = np.array([0, 1, 2, 0, 1])


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
    if len(set(order.upper())) == 3:
        return _three_turns(angles, [_AXES[axis] for axis in order.upper()])
    out = axis_rotation(order[0], angles[..., 0])
    for i, axis in enumerate(order[1:], start=1):
        out = out @ axis_rotation(axis, angles[..., i])
    return out


def _three_turns(angles: Array, axes: list[int]) -> Array:
    """The product of the turns about three different axes, written out: ten times as fast as multiplying matrices."""
    i, j, k = axes
    cos, sin = np.cos(angles), np.sin(angles)
    if (j - i) % 3 != 1:  # against the cycle X, Y, Z all turns go the other way
        sin = -sin
    (ca, cb, cc), (sa, sb, sc) = (np.moveaxis(values, -1, 0) for values in (cos, sin))
    out = np.empty((*angles.shape[:-1], 3, 3), dtype=np.result_type(angles, np.float32))
    out[..., i, i], out[..., i, j], out[..., i, k] = cb * cc, -cb * sc, sb
    out[..., j, i], out[..., j, j], out[..., j, k] = ca * sc + sa * sb * cc, ca * cc - sa * sb * sc, -sa * cb
    out[..., k, i], out[..., k, j], out[..., k, k] = sa * sc - ca * sb * cc, sa * cc + ca * sb * sc, ca * cb
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
    columns = np.ascontiguousarray(d.reshape(-1, 6).T)  # (6, N): NumPy goes through long rows fastest
    x, y = _unit_rows(columns[:3]), columns[3:]
    y = _unit_rows(y - np.einsum("in,in->n", x, y) * x)
    out = np.empty((d.size // 6, 3, 3), dtype=x.dtype)
    out[:, :, 0], out[:, :, 1] = x.T, y.T
    for row, after, last in _CYCLES:
        out[:, row, 2] = x[after] * y[last] - x[last] * y[after]
    return out.reshape(*d.shape[:-1], 3, 3)


def _unit_rows(vectors: Array) -> Array:
    """:func:`normalise` of ``(3, N)`` along the first axis."""
    norm = np.sqrt(np.einsum("in,in->n", vectors, vectors))
    return np.asarray(vectors / np.where(norm < 1e-12, 1, norm))


def normalise(vectors: Array) -> Array:
    """Unit vectors along the last axis; vectors shorter than 1e-12 come back as they are."""
    norm = lengths(vectors)[..., None]
    return np.asarray(vectors / np.where(norm < 1e-12, 1, norm))


def lengths(vectors: Array) -> Array:
    """Euclidean lengths ``[...]`` of vectors ``[..., D]``."""
    return np.asarray(np.sqrt(np.einsum("...d,...d->...", vectors, vectors)))


def rotation_between(source: npt.ArrayLike, target: npt.ArrayLike) -> Array:
    """The smallest rotation that turns direction ``source`` into ``target``: two ``[..., 3]`` -> ``[..., 3, 3]``.

    For opposite directions it is half a turn about some axis orthogonal to both.
    """
    pair = normalise(np.asarray(source, dtype=np.float64)), normalise(np.asarray(target, dtype=np.float64))
    a, b = np.broadcast_arrays(*pair)
    half = a + b
    opposite = lengths(half) < 1e-6
    if opposite.any():
        helper = np.where(np.abs(a[..., :1]) < 0.9, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
        half = np.where(opposite[..., None], np.cross(a, helper), half)
    half = normalise(half)
    flip = (
        2 * (half * a).sum(axis=-1, keepdims=True) * a - half
    )  # half a turn about the source, then about the bisector
    out = 2 * (half[..., :, None] * flip[..., None, :] - a[..., :, None] * a[..., None, :]) + np.eye(3)
    if opposite.any():
        out[opposite] = 2 * half[opposite][:, :, None] * half[opposite][:, None, :] - np.eye(3)
    return np.asarray(out)


def project_to_so3(matrices: Array) -> Array:
    """The nearest rotations (Frobenius norm) to any ``[..., 3, 3]`` matrices: their polar factors.

    By Newton's iteration X <- (X + X^-T) / 2 (Higham 1986), some thousand matrices at a time; reflections and matrices
    that are nearly singular by SVD. A few matrices that are nearly rotations take less: see `_corrected`.
    """
    m = np.asarray(matrices)
    rows = m.reshape(-1, 9)
    if 0 < len(rows) <= _FEW and (near := _corrected(rows)) is not None:
        return near.reshape(m.shape).astype(np.result_type(m, np.float32))
    out = np.empty_like(rows, dtype=np.result_type(m, np.float32))
    for start in range(0, len(rows), _BLOCK):
        out[start : start + _BLOCK] = _nearest_rotations(rows[start : start + _BLOCK])
    return out.reshape(m.shape)


def _corrected(rows: Array) -> Array | None:
    """The same of matrices ``(N, 9)`` that are all nearly rotations, by fewer calls; float64. None for others.

    X <- X (I - E / 2 + 3/8 E^2) with E = X^T X - I: the series of the inverse root of X^T X, again and again.
    """
    close = 1e-5 if rows.dtype == np.float64 else 4e-3  # a third of its cube is what remains
    x = rows.reshape(-1, 3, 3).astype(np.float64)
    for _ in range(_MOST_STEPS):
        error = np.swapaxes(x, -1, -2) @ x - _IDENTITY
        furthest = np.abs(error).max()
        if not furthest < _NEARLY:
            return None
        x = x @ (_IDENTITY - 0.5 * error + 0.375 * (error @ error))
        if furthest < close:
            break
    return x if (np.linalg.det(x) > 0).all() else None


def _nearest_rotations(rows: Array) -> Array:
    """Of matrices ``(N, 9)``, row by row, N >= 1; float64."""
    close = 1e-7 if rows.dtype == np.float64 else 4e-4  # an eighth of its square is what remains
    x = rows.T.astype(np.float64, order="C").reshape(3, 3, -1)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        for _ in range(_MOST_STEPS):
            inverse, determinants = _inverse_transposed(x)
            apart = np.abs(x - inverse)
            x += inverse
            x *= 0.5
            if done := apart.max() < close:
                break
    found = np.ascontiguousarray(x.reshape(9, -1).T)
    if not (done and determinants.min() > 0):
        failed = ~((apart.max(axis=(0, 1)) < close) & (determinants > 0))
        found[failed] = _nearest_by_svd(rows[failed])
    return found


def _inverse_transposed(x: Array) -> tuple[Array, Array]:
    """X^-T of matrices ``(3, 3, N)`` by their cofactors, and their determinants ``(N,)``."""
    wide, cofactors = x[:, _WRAPPED], np.empty_like(x)
    for row, after, last in _CYCLES:
        cofactors[row] = wide[after, 1:4] * wide[last, 2:]
        cofactors[row] -= wide[after, 2:] * wide[last, 1:4]
    determinants = np.einsum("in,in->n", x[0], cofactors[0])
    cofactors /= determinants
    return cofactors, determinants


def _nearest_by_svd(rows: Array) -> Array:
    u, _, vt = np.linalg.svd(rows.reshape(-1, 3, 3).astype(np.float64))
    u[:, :, 2] *= np.sign(np.linalg.det(u @ vt))[:, None]
    return np.asarray((u @ vt).reshape(-1, 9))


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
