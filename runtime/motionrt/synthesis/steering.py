"""What a text says of the way is met: turns and ways that stray are brought into their ranges while a motion is drawn.

The root is corrected at the late steps of the sampling and held there, so that the network fits the steps to it, as it
does for paths (imputation: Karunratanakul et al. 2023).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from motionrt.models.text import FloatArray
from motionrt.motion.body_parts import PARTS
from motionrt.motion.features import ego77
from motionrt.synthesis.canvas import Held, Piece
from motionrt.text.ways import Range, Way

GLOBAL = PARTS.index("global")
_TURNED, _GONE = np.radians(1.0), 0.02  # what is not worth a correction, radians and metres

Array = npt.NDArray[np.float64]


def steered(features: FloatArray, pieces: Sequence[Piece]) -> Held:
    """What must be otherwise about a motion ``(F, 77)`` so that it goes where the texts of its pieces say."""
    held = Held.nothing(len(features))
    for piece in pieces:
        own = np.flatnonzero(piece.weight[:, GLOBAL] > 0.5)
        if not len(own) or piece.words.way == Way():
            continue
        span = slice(piece.first + int(own[0]), piece.first + int(own[-1]) + 1)
        found = brought(features[span], piece.words.way)
        if found is not None:
            held.motion[span], held.parts[span, GLOBAL] = found, True
    return held


def brought(features: FloatArray, way: Way) -> FloatArray | None:
    """Features ``(F, 77)`` whose turn and way are in their ranges; None where they are already."""
    rows = np.asarray(features, np.float64).copy()
    if len(rows) < 2:
        return None
    share = np.sin(np.pi * (np.arange(len(rows) - 1) + 0.5) / (len(rows) - 1)) ** 2
    share /= share.sum()
    changed = _turn(rows, way, share)
    return rows.astype(np.float32) if _place(rows, way, share) or changed else None


def _turn(rows: Array, way: Way, share: Array) -> bool:
    if way.turn is None:
        return False
    now = float(rows[:-1, 0].sum())
    low, high = np.radians(way.turn)
    off = _into(now, (-high, -low) if way.either and now < 0 else (low, high)) - now
    rows[:-1, 0] += off * share
    return bool(abs(off) > _TURNED)


def _place(rows: Array, way: Way, share: Array) -> bool:
    left, forward = ego77.decode(rows)[-1, 0, [0, 2]]
    x, z = _into(left, way.left) - left, _into(forward, way.forward) - forward
    more_left, more_forward = ego77.to_body(x * share, z * share, ego77.headings(rows)[:-1])
    rows[:-1, 1] += more_left
    rows[:-1, 2] += more_forward
    return bool(max(abs(x), abs(z)) > _GONE)


def _into(value: float, wanted: Range | None) -> float:
    return float(value if wanted is None else min(max(value, wanted[0]), wanted[1]))
