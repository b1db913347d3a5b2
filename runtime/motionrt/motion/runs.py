"""Runs of true values along the time of several columns at once, without a loop over them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from motionrt.motion.rotations import Array

BoolArray = npt.NDArray[np.bool_]
Indices = npt.NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Runs:
    """Every run of true values in flags ``(F, N)``, column after column; times are counted on through the columns.

    Attributes:
        frames: F.
        columns: N.
        starts: ``(R,)`` column * F + first frame.
        stops: ``(R,)`` column * F + frame behind the last.
    """

    frames: int
    columns: int
    starts: Indices
    stops: Indices

    @classmethod
    def of(cls, flags: BoolArray) -> Runs:
        """The runs of flags ``(F, N)``."""
        frames, columns = flags.shape
        fenced = np.zeros((columns, frames + 1), dtype=bool)  # one false value keeps columns apart
        fenced[:, :frames] = flags.T
        flat = fenced.ravel()
        edges = np.flatnonzero(flat[1:] != flat[:-1]) + 1
        edges = np.concatenate([[0], edges]) if flat.size and flat[0] else edges
        edges -= edges // (frames + 1)  # the fences before it
        starts, stops = edges[::2], edges[1::2]
        return cls(frames, columns, starts, stops)

    @cached_property
    def lengths(self) -> Indices:
        """``(R,)`` frames."""
        return self.stops - self.starts

    @cached_property
    def inside(self) -> Indices:
        """Times of all frames in runs, run after run: where ``flat`` holds them."""
        ends = np.cumsum(self.lengths)
        return np.arange(ends[-1] if len(ends) else 0) + np.repeat(self.stops - ends, self.lengths)

    @property
    def first(self) -> BoolArray:
        """``(R,)`` whether a run begins with its column."""
        return np.asarray(self.starts % self.frames == 0)

    @property
    def last(self) -> BoolArray:
        """``(R,)`` whether a run ends with its column."""
        return np.asarray(self.stops % self.frames == 0)

    def flat(self, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """``(F, N, ...)`` -> ``(N * F, ...)``, a copy."""
        return np.swapaxes(values, 0, 1).reshape(-1, *values.shape[2:]).copy()

    def shaped(self, flat: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Inverse of :meth:`flat`."""
        return np.swapaxes(flat.reshape(self.columns, self.frames, *flat.shape[1:]), 0, 1)

    def reduce(self, how: np.ufunc, inside: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """``(R, ...)``: values ``(..., ...)`` of the frames in runs, put together run by run."""
        if not len(self.starts):
            return np.zeros((0, *inside.shape[1:]), dtype=inside.dtype)
        reduced: npt.NDArray[Any] = how.reduceat(inside, np.cumsum(self.lengths) - self.lengths)
        return reduced

    def repeat(self, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Values ``(R, ...)`` of runs, for each of their frames."""
        return np.repeat(values, self.lengths, axis=0)

    def mean(self, inside: Array, weights: Array) -> Array:
        """``(R, D)`` weighted means of ``(K, D)`` over every run; weights ``(K,)``."""
        total = self.reduce(np.add, weights)[:, None]
        return np.asarray(self.reduce(np.add, inside * weights[:, None]) / total)

    def flags(self, which: BoolArray) -> BoolArray:
        """``(F, N)``, true in those runs."""
        flat = np.zeros(self.frames * self.columns, dtype=bool)
        flat[self.inside] = self.repeat(which)
        return self.shaped(flat)
