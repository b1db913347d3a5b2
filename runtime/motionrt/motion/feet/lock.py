"""Foot locking: the ball of a standing foot stays where it stands, while the heel rolls as it did.

During every contact the toe joint is pinned to one point; ankle and foot move along with it, so the foot keeps its own
global rotation; the leg follows by two-bone inverse kinematics, and the pelvis sinks a little where the leg would be
too short. Between contacts the correction fades in and out with matched speeds, so nothing pops.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.motion.batches import by_batches
from motionrt.motion.feet.contacts import LOOSE_SPEED, STRICT_SPEED, speeds, still
from motionrt.motion.feet.two_bone import LEG_JOINTS, bend_legs, soft_limit
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import Array, lengths
from motionrt.motion.runs import BoolArray, Indices, Runs
from motionrt.motion.skeleton import SMPL24, FloatArray

BLEND_S = 0.2  # seconds over which a correction fades, where the next contact leaves that much time
MAX_DROP = 0.05  # metres that the pelvis may sink for a foot that would not reach
CLEARANCE = 0.03  # metres above the floor of a toe that swings by
_QUICKENS = 1.25  # times the speed from which a toe swings by which it is faster when it keeps all of that
MAX_SHIFT = 0.1  # metres that a toe is moved in a contact; one that travels twice as far slides or stands twice
_DOWN = 0.025  # metres
_CALMER = 0.25  # such contacts are looked for again with the speeds scaled by this
_TOES = [leg[3] for leg in LEG_JOINTS]


def lock_feet(
    motion: Motion,
    contacts: BoolArray | None = None,
    *,
    floor: float = 0.0,
    level: bool = False,
    blend_s: float = BLEND_S,
    max_drop: float = MAX_DROP,
    clearance: float = CLEARANCE,
    swings_from: float = LOOSE_SPEED,
) -> Motion:
    """``motion`` with feet that stand still while they stand and swing clear of the floor.

    Only legs and pelvis height change. Feet and everything above the hips keep their global rotations.

    Args:
        motion: a ``smpl24`` motion on the floor (:meth:`Motion.grounded`), any frame rate.
        contacts: ``(F, 2)``, when the left and the right toe stand; found by :func:`toe_contacts` if not given.
        floor: height in metres of the toe joint of a standing foot.
        level: put every standing toe on the floor, instead of at its own mean height over the contact.
        blend_s: seconds over which corrections fade after and before a contact.
        max_drop: metres that the pelvis may sink so that a leg reaches.
        clearance: metres that a swinging toe keeps above the floor; a slow one keeps none, but is never below it.
        swings_from: m/s above which a toe swings; all of the clearance is kept at 2.25 times that.

    Raises:
        InvalidInputError: another skeleton, or contacts of another shape.
    """
    if motion.skeleton != SMPL24:
        raise InvalidInputError("lock_feet needs a motion of the smpl24 skeleton")
    toes = motion.positions()[:, _TOES].astype(np.float64)
    speed = speeds(toes, motion.fps)
    planted = _planted(toes, speed, motion.fps, floor) if contacts is None else np.asarray(contacts, dtype=bool)
    if planted.shape != (motion.frames, 2):
        raise InvalidInputError(f"contacts must have the shape ({motion.frames}, 2), not {planted.shape}")
    offset = _offsets(toes, planted, _calm(speed), floor if level else None, blend_s * motion.fps)
    offset[..., 1] += lift(toes[..., 1] + offset[..., 1] - floor, speed, clearance, swings_from)
    half = max(1, round(blend_s * motion.fps / 2))
    places, turned = motion.positions(), motion.global_rotations()
    return with_feet_moved(motion, places, turned, offset, planted, max_drop=max_drop, half=half)


def with_feet_moved(
    motion: Motion,
    positions: FloatArray | Array,
    turned: Array,
    offset: Array,
    counts: BoolArray,
    *,
    max_drop: float,
    half: int,
) -> Motion:
    """``motion`` with its feet moved; the legs follow, and the pelvis sinks where a foot would not reach.

    Args:
        motion: of ``smpl24``.
        positions: ``(F, 24, 3)`` its joints; what is computed of them is float64.
        turned: ``(F, 24, 3, 3)`` its global rotations; feet may have been given others, which they keep.
        offset: ``(F, 2, 3)`` metres that the left and the right foot move.
        counts: ``(F, 2)``, for which of them the pelvis sinks.
        max_drop: metres that it may sink.
        half: frames to either side over which the sinking is smoothed.
    """

    def needed(places: Array, move: Array, count: BoolArray) -> Array:
        return needed_drop(places.astype(np.float64), move, count, max_drop)

    drop = smooth_cover(by_batches(needed, positions, offset, counts), half)
    sunk = np.array([0, 1, 0]) * drop[:, None]

    def bent(local: Array, places: Array, whole: Array, move: Array, down: Array) -> Array:
        return bend_legs(local, places.astype(np.float64) - down[:, None], whole, move + down[:, None])

    rotations = by_batches(bent, motion.rotations, positions, turned, offset, sunk)
    root = (motion.root - sunk).astype(np.float32)
    return replace(motion, rotations=rotations.astype(np.float32, copy=False), root=root)


def lift(height: Array, speed: Array, clearance: float = CLEARANCE, swings_from: float = LOOSE_SPEED) -> Array:
    """Metres to raise toes ``height`` metres above the floor that move at ``speed`` m/s: not negative, and smooth."""
    swings = np.clip((speed - swings_from) / (_QUICKENS * swings_from), 0, 1)
    swings = clearance * swings**2 * (3 - 2 * swings)
    short = swings - height
    return np.asarray((short + np.sqrt(short**2 + (swings / 2) ** 2)) / 2)


def planted_toes(motion: Motion, floor: float = 0.0) -> BoolArray:
    """``(F, 2)``: the toe contacts that can be pinned to one point.

    That is while the toe is down (within 2.5 cm of its height over the contact: a toe that still sinks after the heel
    has landed is not) and within 0.1 m of where it stands.
    """
    toes = motion.positions()[:, _TOES].astype(np.float64)
    return _planted(toes, speeds(toes, motion.fps), motion.fps, floor)


def _planted(toes: Array, speed: Array, fps: float, floor: float) -> BoolArray:
    """The same of toes ``(F, 2, 3)`` that move at ``speed`` ``(F, 2)`` m/s."""
    height = np.tile(toes[..., 1] - floor, 2)
    planted, calmer = np.split(still(height, np.concatenate([speed, speed / _CALMER], axis=1), fps), 2, axis=1)
    planted = np.where(_wide(toes, planted), calmer, planted)
    planted &= ~_wide(toes, planted)
    runs = Runs.of(planted)
    inside = runs.flat(toes)[runs.inside]
    off = inside - runs.repeat(runs.mean(inside, runs.flat(_calm(speed))[runs.inside]))
    flat = np.zeros(toes.shape[0] * toes.shape[1], dtype=bool)
    flat[runs.inside] = (np.hypot(off[:, 0], off[:, 2]) < MAX_SHIFT) & (np.abs(off[:, 1]) < _DOWN)
    return runs.shaped(flat)


def _wide(toes: Array, planted: BoolArray) -> BoolArray:
    """The contacts ``(F, 2)`` in which a toe travels too far to be pinned."""
    runs = Runs.of(planted)
    inside = runs.flat(toes)[runs.inside]
    spread = runs.reduce(np.maximum, inside) - runs.reduce(np.minimum, inside)
    return runs.flags((spread > 2 * MAX_SHIFT).any(axis=1))


def _calm(speed: Array) -> Array:
    """``(F, 2)`` weights: the calm middle of a contact says where the toe stands, not its beginning and end."""
    return np.asarray(1 / (1 + (speed / (STRICT_SPEED / 2)) ** 4))


def _offsets(toes: Array, planted: BoolArray, calm: Array, level: float | None, blend: float) -> Array:
    """``(F, 2, 3)``: what moves each toe to its pinned point, faded over ``blend`` frames away from contacts."""
    runs = Runs.of(planted)
    inside, weights = runs.flat(toes)[runs.inside], runs.flat(calm)[runs.inside]
    offset = np.zeros((toes.shape[0] * toes.shape[1], 3))
    offset[runs.inside] = _to_point(inside, runs.repeat(runs.mean(inside, weights)), level)
    return np.ascontiguousarray(runs.shaped(faded(offset, Runs.of(~planted), blend)))


def _to_point(toe: Array, point: Array, level: float | None) -> Array:
    """Offsets of ``(K, 3)`` to ``point``; heights only where they are off by little: a toe that lifts is let go."""
    offset = point - toe
    offset[:, 1] /= 1 + (offset[:, 1] / (_DOWN / 2)) ** 4
    offset[:, 1] += 0 if level is None else level - point[:, 1]
    return np.asarray(offset)


def faded(offset: Array, gaps: Runs, blend: float) -> Array:
    """Offsets that leave and reach every contact with the speed they have there: cubic Hermite tails."""
    out = offset.copy()
    span = np.clip(gaps.lengths + 1.0, 1.0, max(blend, 1.0))
    passed = gaps.inside - gaps.repeat(gaps.starts) + 1.0
    left = gaps.repeat(gaps.stops) - gaps.inside + 0.0
    for edge, inward, ends, time in ((gaps.starts - 1, -1, gaps.first, passed), (gaps.stops, 1, gaps.last, left)):
        out[gaps.inside] += _tails(offset, gaps, np.where(ends, -1, edge), inward, time, span)
    return out


def _tails(offset: Array, gaps: Runs, edge: Indices, inward: int, time: Array, span: Array) -> Array:
    """The offsets at the edges with their slopes there, brought to zero with zero slope; nothing for an edge of -1."""
    foot = edge // gaps.frames
    inner = np.clip(edge + inward, foot * gaps.frames, (foot + 1) * gaps.frames - 1)
    there = (edge >= 0)[:, None]
    value = np.where(there, offset[edge], 0)
    slope = np.where(there & offset[inner].any(axis=1, keepdims=True), offset[edge] - offset[inner], 0)
    s = np.minimum(time / gaps.repeat(span), 1)[:, None]
    return np.asarray((1 - s) ** 2 * ((1 + 2 * s) * gaps.repeat(value) + s * gaps.repeat(span[:, None] * slope)))


def needed_drop(positions: Array, offset: Array, planted: BoolArray, max_drop: float) -> Array:
    """Metres that the pelvis must sink so that both pinned feet are in reach.

    Args:
        positions: ``(..., 24, 3)`` joints of ``smpl24``.
        offset: ``(..., 2, 3)`` metres that the left and the right foot shall move.
        planted: ``(..., 2)``, which of them counts.
        max_drop: the most that is given.

    Returns:
        ``(...)`` metres, not negative.
    """
    hip, knee, ankle = (positions[..., [leg[i] for leg in LEG_JOINTS], :] for i in range(3))
    full = lengths(knee - hip) + lengths(ankle - knee)
    reach = soft_limit(lengths(ankle - hip), full)
    aim = ankle + offset - hip
    height = np.sqrt(np.maximum(reach**2 - aim[..., 0] ** 2 - aim[..., 2] ** 2, 0))
    drop = np.where(planted, -aim[..., 1] - height, 0)
    return np.asarray(np.clip(drop.max(axis=-1), 0, max_drop))


def smooth_cover(values: Array, half: int) -> Array:
    """A smooth curve nowhere below ``values`` ``(F,)``: their running maximum, averaged over the same window."""
    if not values.any():
        return np.zeros_like(values)
    width = 2 * half + 1
    maximum = np.lib.stride_tricks.sliding_window_view(np.pad(values, half), width).max(axis=1)
    kernel = np.hanning(width + 2)[1:-1]
    padded = np.pad(maximum, half, mode="edge")
    return np.asarray(np.convolve(padded, kernel / kernel.sum(), mode="valid"))
