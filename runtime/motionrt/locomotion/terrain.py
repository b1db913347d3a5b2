"""Ground that is not at height 0: characters walk on a plane, and are raised to the ground of the scene afterwards."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from motionrt.locomotion.bearings import Place
from motionrt.motion import Motion

SMOOTH = 15  # frames over which heights are averaged: steps and cell edges become slopes

Heights = npt.NDArray[np.float64]


class Terrain:
    """Heights of the ground of a scene.

    Args:
        scene: anything with ``height(xz)``, as :class:`motionrt.locomotion.scene.Scene`, or something without.
        level: metres, everywhere, where there is no such scene.
    """

    def __init__(self, scene: object, level: float = 0.0) -> None:
        self._height, self._level = getattr(scene, "height", None), level

    @property
    def heights(self) -> Callable[[npt.NDArray[np.floating]], Heights] | None:
        """Places ``(N, 2)`` -> ``(N,)`` metres, NaN where there is no ground; None without a scene."""
        height = self._height
        return None if height is None else lambda places: np.asarray(height(places), dtype=np.float64)

    def at(self, place: Place, otherwise: float = 0.0) -> float:
        """Metres; ``otherwise`` where there is no ground."""
        return float(self.under(np.array([place]), otherwise)[0])

    def under(self, xz: npt.NDArray[np.floating], otherwise: float = 0.0) -> Heights:
        """``(F,)`` metres under places ``(F, 2)``; where there is no ground, as before, at first ``otherwise``."""
        if self._height is None:
            return np.full(len(xz), self._level)
        found = np.append(otherwise, np.asarray(self._height(xz), dtype=np.float64))
        known = np.where(np.isfinite(found), np.arange(len(found)), 0)
        return np.asarray(found[np.maximum.accumulate(known)][1:])


def smoothed(heights: Heights) -> Heights:
    """Heights ``(F,)`` with steps and cell edges turned into slopes."""
    if not heights.any():
        return heights
    kernel = np.hanning(SMOOTH + 2)[1:-1]
    return np.convolve(np.pad(heights, SMOOTH // 2, mode="edge"), kernel / kernel.sum(), mode="valid")


def raised(motion: Motion, ground: Heights) -> Motion:
    """A motion on the plane, raised to the ground ``(F,)`` metres."""
    if not ground.any():
        return motion
    return replace(motion, root=(motion.root + ground[:, None] * np.array([0.0, 1.0, 0.0])).astype(np.float32))


def on_plane(positions: npt.NDArray[np.floating], ground: Heights) -> npt.NDArray[np.floating]:
    """Joint positions ``(F, J, 3)`` as they are above the ground."""
    return np.asarray(positions - ground[:, None, None] * np.array([0.0, 1.0, 0.0]))
