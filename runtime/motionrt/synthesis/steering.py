"""What a text says is met: ways, heights and limbs that stray are brought to it while a motion is drawn.

Heights are planned before the sampling; ways and limbs are corrected at its late steps and held there, so that the
network fits the rest to them, as it does for paths (imputation: Karunratanakul et al. 2023).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from motionrt.models.text import FloatArray
from motionrt.motion.body_parts import PARTS
from motionrt.motion.features import ego77
from motionrt.synthesis.calming import calmed
from motionrt.synthesis.canvas import OWNERS, Held, Piece
from motionrt.synthesis.footing import carried, share_of
from motionrt.synthesis.gesturing import gestured
from motionrt.text import (
    TextAttributes,
    ceiling_of_text,
    headings_of_text,
    heights_of_text,
    strides_of_text,
    way_of_text,
)
from motionrt.text.ways import Range, Way

GLOBAL = PARTS.index("global")
HEIGHT = 3  # column of the pelvis
_TURNED, _GONE = np.radians(1.0), 0.02  # what is not worth a correction, radians and metres
_LONGER = 3.0  # times that a way is made longer, at most

Array = npt.NDArray[np.float64]


def planned(pieces: Sequence[Piece], frames: int) -> Held:
    """The root of texts that go down or up on the spot, and of jumps."""
    held = Held.nothing(frames)
    for span, said in _spans(pieces):
        times = np.arange(span.stop - span.start) / ego77.FPS
        heights = heights_of_text(said, times)
        if heights is not None:
            strides, still = strides_of_text(said, times), np.zeros_like(heights)
            ahead = still if strides is None else strides / np.float32(ego77.FPS)
            held.motion[span, ego77.ROOT] = np.stack([still, still, ahead, heights], axis=1)
            held.parts[span, GLOBAL] = True
    return held


def steered(features: FloatArray, pieces: Sequence[Piece]) -> Held:
    """What must be otherwise about a motion ``(F, 77)`` so that it does what the texts of its pieces say."""
    held = _gestures(features, pieces)
    for span, said in _spans(pieces):
        led = held.parts[span]
        rows, parts = calmed(np.where(led[:, OWNERS], held.motion[span], features[span]), said)
        parts |= led
        share = share_of(said) if len(rows) > 1 else 0.0
        if share:
            rows, parts[:, GLOBAL] = carried(rows, share), True
        ceiling = ceiling_of_text(said)
        if ceiling is not None and (rows[:, HEIGHT] > ceiling).any():
            rows[:, HEIGHT], parts[:, GLOBAL] = np.minimum(rows[:, HEIGHT], ceiling), True
        headings = headings_of_text(said, np.arange(len(rows)) / ego77.FPS)
        if headings is not None:
            rows[:-1, 0], parts[:, GLOBAL] = np.diff(headings), True
        found = brought(rows, way_of_text(said, len(rows) / ego77.FPS))
        if found is not None:
            rows, parts[:, GLOBAL] = found, True
        held.motion[span], held.parts[span] = rows, parts
    return held


def _gestures(features: FloatArray, pieces: Sequence[Piece]) -> Held:
    """What limbs do of whose course their texts say it, each in the frames and parts that are its piece's."""
    held = Held.nothing(len(features))
    for piece in pieces:
        owned = piece.weight > 0.5
        own = np.flatnonzero(owned.any(axis=1))
        if len(own):
            first, last = int(own[0]), int(own[-1]) + 1
            span = slice(piece.first + first, piece.first + last)
            rows, parts = gestured(features[span], piece.words.said)
            parts &= owned[first:last]
            held.motion[span] = np.where(parts[:, OWNERS], rows, held.motion[span])
            held.parts[span] |= parts
    return held


def _spans(pieces: Sequence[Piece]) -> Iterator[tuple[slice, TextAttributes]]:
    """The frames whose root belongs to each piece, and what its text says."""
    for piece in pieces:
        own = np.flatnonzero(piece.weight[:, GLOBAL] > 0.5)
        if len(own):
            yield slice(piece.first + int(own[0]), piece.first + int(own[-1]) + 1), piece.words.said


def brought(features: FloatArray, way: Way) -> FloatArray | None:
    """Features ``(F, 77)`` whose turn and way are in their ranges; None where they are already."""
    rows = np.asarray(features, np.float64).copy()
    if len(rows) < 2:
        return None
    share = np.sin(np.pi * (np.arange(len(rows) - 1) + 0.5) / (len(rows) - 1)) ** 2
    share /= share.sum()
    changed = _stay(rows, way) | _lengthen(rows, way) | _turn(rows, way, share)
    return rows.astype(np.float32) if _place(rows, way, share) or changed else None


def _turn(rows: Array, way: Way, share: Array) -> bool:
    if way.turn is None:
        return False
    now = float(rows[:-1, 0].sum())
    low, high = np.radians(way.turn)
    off = _into(now, (-high, -low) if way.either and now < 0 else (low, high)) - now
    rows[:-1, 0] += off * share
    return bool(abs(off) > _TURNED)


def _stay(rows: Array, way: Way) -> bool:
    """Make a way shorter that strays too far from its start; in place. Whether anything had to be done."""
    if way.near is None:
        return False
    ground = ego77.decode(rows)[:, 0, [0, 2]]
    far = float(np.linalg.norm(ground - ground[0], axis=1).max())
    if far <= way.near + _GONE:
        return False
    rows[:, 1:3] *= way.near / far
    return True


def _lengthen(rows: Array, way: Way) -> bool:
    """Bring the length of a way into its range; in place. Whether anything had to be done."""
    if way.length is None:
        return False
    now = float(np.hypot(rows[:-1, 1], rows[:-1, 2]).sum())
    off = _into(now, way.length) - now
    if abs(off) <= _GONE or now < _GONE:
        return False
    rows[:-1, 1:3] *= min((now + off) / now, _LONGER)
    return True


def _place(rows: Array, way: Way, share: Array) -> bool:
    left, forward = ego77.decode(rows)[-1, 0, [0, 2]]
    x, z = _into(left, way.left) - left, _into(forward, way.forward) - forward
    more_left, more_forward = ego77.to_body(x * share, z * share, ego77.headings(rows)[:-1])
    rows[:-1, 1] += more_left
    rows[:-1, 2] += more_forward
    return bool(max(abs(x), abs(z)) > _GONE)


def _into(value: float, wanted: Range | None) -> float:
    return float(value if wanted is None else min(max(value, wanted[0]), wanted[1]))
