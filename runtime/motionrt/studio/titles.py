"""Names over the figures: short, and where two would lie upon each other in the picture, one goes up."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from motionrt.motion.skeleton import FloatArray

LETTERS, FEW, LETTERS_OF_MANY = 46, 3, 24  # of a name over one of a few figures, or of more
LETTER_PIXELS, FRAME_PIXELS, LINE_PIXELS = 5.0, 8.0, 18.0  # of a label at 85 % of the usual size
_NEAREST = 0.1  # metres before the camera


def short(name: str, figures: int) -> str:
    """A name as it stands over one of several figures: the end of a long one is left away, between words if it can."""
    letters = LETTERS if figures <= FEW else LETTERS_OF_MANY
    if len(name) <= letters:
        return name
    cut = name[: letters - 1]
    head, _, _ = cut.rpartition(" ")
    return f"{head if len(head) > letters // 2 else cut}…"


def width(name: str) -> float:
    """About how many pixels a label of that name takes."""
    return LETTER_PIXELS * len(name) + FRAME_PIXELS


def lifts(
    places: FloatArray, widths: FloatArray, eye: FloatArray, target: FloatArray, fov: float, height: float
) -> npt.NDArray[np.float64]:
    """``(N,)`` by how many metres labels go up so that no two of them overlap in the picture; nearer ones stay lower.

    Args:
        places: ``(N, 3)`` the middles of the labels' lower edges, metres.
        widths: ``(N,)`` of the labels, pixels.
        eye: ``(3,)`` where the camera is.
        target: ``(3,)`` what it looks at.
        fov: vertical field of view, radians.
        height: of the picture, pixels.
    """
    away, right, above = _seen(np.asarray(places, np.float64), eye, target)
    focal = height / 2 / math.tan(fov / 2)
    scale = focal / np.maximum(away, _NEAREST)
    middles, lows = right * scale, above * scale
    raised = lows.copy()
    placed: list[int] = []
    for label in np.argsort(away, kind="stable").tolist():
        if away[label] < _NEAREST:
            continue
        beside = [o for o in placed if abs(middles[o] - middles[label]) < (widths[o] + widths[label]) / 2]
        for other in sorted(beside, key=lambda o: raised[o]):
            if abs(raised[other] - raised[label]) < LINE_PIXELS:
                raised[label] = raised[other] + LINE_PIXELS
        placed.append(label)
    return np.asarray((raised - lows) / scale)


def _seen(places: npt.NDArray[np.float64], eye: FloatArray, target: FloatArray) -> npt.NDArray[np.float64]:
    """``(3, N)`` metres from the camera: ahead, to the right, up."""
    ahead = np.asarray(target, np.float64) - eye
    ahead /= max(float(np.linalg.norm(ahead)), 1e-9)
    right = np.cross(ahead, [0.0, 1.0, 0.0])
    right /= max(float(np.linalg.norm(right)), 1e-9)
    return np.stack([ahead, right, np.cross(right, ahead)]) @ (places - np.asarray(eye, np.float64)).T
