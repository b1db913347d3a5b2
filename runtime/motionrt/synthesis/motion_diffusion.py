"""Diffusion of motions: noise levels and the solver; the network that estimates is the caller's.

A normalised motion x_0 has noise added as x = x_0 + s e, with e standard normal and s the noise level (Karras et al.
2022, "variance exploding"). Training takes the columns of the parts of the body from here.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.motion.body_parts import PART_JOINTS, PARTS
from motionrt.motion.features import ego77
from motionrt.motion.skeleton import FloatArray

HIGHEST, LOWEST, BEND = 60.0, 0.15, 7.0
"""First and last noise level of a sampling, and how much closer the low ones lie (rho of Karras et al., eq. 5)."""


Denoise = Callable[[FloatArray, float], FloatArray]
"""(x (B, F, 77) normalised, with noise; its level) -> estimate of x_0 (B, F, 77)."""


def noise_levels(steps: int) -> npt.NDArray[np.float64]:
    """``(steps,)`` falling levels from :data:`HIGHEST` to :data:`LOWEST` (Karras et al. 2022, eq. 5).

    Raises:
        InvalidInputError: no step.
    """
    if steps < 1:
        raise InvalidInputError(f"steps must be at least 1, not {steps}")
    part = np.linspace(0.0, 1.0, steps) if steps > 1 else np.zeros(1)
    high, low = HIGHEST ** (1 / BEND), LOWEST ** (1 / BEND)
    return np.asarray((high + part * (low - high)) ** BEND)


def solve(denoise: Denoise, noise: FloatArray, steps: int) -> FloatArray:
    """Standard normal noise ``(B, F, 77)`` to normalised motions: DPM-Solver++ (2M) of Lu et al. 2022, algorithm 2.

    The last call's estimate is the answer: no noise is left behind the lowest level.
    """
    levels = noise_levels(steps)
    state = np.asarray(noise * levels[0], np.float32)
    before: FloatArray | None = None
    for k, level in enumerate(levels[:-1].tolist()):
        clean = denoise(state, level)
        step = np.log(level / levels[k + 1])
        ahead = clean
        if before is not None:
            share = step / (2 * np.log(levels[k - 1] / level))
            ahead = (1 + share) * clean - share * before
        ratio = levels[k + 1] / level
        state, before = np.asarray(ratio * state + (1 - ratio) * ahead, np.float32), clean
    return denoise(state, float(levels[-1]))


def held_columns() -> npt.NDArray[np.intp]:
    """``(77,)`` for every column of ``ego77`` the number of the part of :data:`motionrt.PARTS` that it belongs to."""
    owners = np.full(ego77.WIDTH, PARTS.index("global"))
    for number, part in enumerate(PARTS[:-1]):
        for joint in PART_JOINTS[part]:
            first = ego77.column(joint)
            owners[first : first + 3] = number
    owners[ego77.CONTACTS] = [PARTS.index(f"{side} leg") for _ in range(2) for side in ("left", "right")]
    return owners
