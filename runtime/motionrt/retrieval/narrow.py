"""Fewer numbers a vector for the scan: embeddings of a library hardly leave a subspace, and the rest has a bound.

With B the directions, p = B'v, r = v - Bp what they miss of a vector, and y, s the same of a query x:
``x.v = y.p + s.r <= y.p + |s||r|``, the product of ``(y, |s|)`` and ``(p, |r|)``. So the scan of those never puts a
vector lower than it is (up to the rounding in :meth:`Directions.rounding`), and that is all that a scan must promise.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval.codes import LONGEST, ROUNDING
from motionrt.retrieval.vectors import Vectors

WIDTHS = (64, 128)
_SAMPLE = 4096
_MAY_MISS = 0.02  # of the squared length of the vectors, on average


@dataclass(frozen=True, eq=False)
class Directions:
    """Orthonormal but for rounding.

    Attributes:
        basis: ``(d, m - 1)`` float32; the m-th number of a narrowed vector is the length of what it misses.
        skew: Frobenius norm of ``B'B - 1``.
    """

    basis: FloatArray
    skew: float

    @classmethod
    def of(cls, vectors: Vectors) -> Directions | None:
        """The directions that a sample of ``vectors`` ``(N, d)`` hardly leaves; None when there are none so few."""
        sample = np.ascontiguousarray(vectors[:: max(1, len(vectors) // _SAMPLE)])
        if not np.abs(sample).max(initial=0.0) < LONGEST:
            return None
        energies, directions = np.linalg.eigh((sample.T @ sample).astype(np.float64))
        for width in WIDTHS:
            missed = energies[: max(0, len(energies) - width + 1)].sum()
            if width < len(energies) and missed <= _MAY_MISS * energies.sum():
                return cls._mixed(directions[:, 1 - width :])
        return None

    @classmethod
    def _mixed(cls, directions: npt.NDArray[np.float64]) -> Directions:
        """The same subspace, turned so that no direction stands out: 8 bits hold even numbers best."""
        count = directions.shape[1]
        turn = np.linalg.qr(np.random.default_rng(0).normal(size=(count, count)))[0]
        basis = (directions @ turn).astype(np.float32)
        exact = basis.astype(np.float64)
        return cls(basis, float(np.linalg.norm(exact.T @ exact - np.eye(count))))

    @property
    def width(self) -> int:
        """Numbers of a narrowed vector, m."""
        return int(self.basis.shape[1]) + 1

    def rows(self, vectors: FloatArray) -> FloatArray:
        """Narrowed vectors ``(N, m)``; their last number is at least the length of what is missed.

        ``|r|^2 = |v|^2 - |p|^2 + 2 e.p + p'(B'B - 1)p`` with e the rounding of p.
        """
        narrowed = np.empty((len(vectors), self.width), dtype=np.float32)
        inside = narrowed[:, :-1]
        np.matmul(vectors, self.basis, out=inside)
        square = np.einsum("nd,nd->n", vectors, vectors)
        missed = np.maximum(square - np.einsum("nd,nd->n", inside, inside), 0)
        rounding = 2.1 * self._product_rounding + 1.1 * self.skew + 4 * (len(self.basis) + 8) * ROUNDING
        narrowed[:, -1] = np.sqrt(missed + np.float32(rounding) * square) * np.float32(1.00001)
        return narrowed

    def query(self, query: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """A narrowed query ``(m,)``."""
        inside = query @ self.basis
        missed = query - self.basis @ inside
        return np.append(inside, np.sqrt(missed @ missed) * 1.00001)

    def rounding(self, length: float, longest: float) -> float:
        """How far the product of the narrowed may be below that of a query and vectors of such lengths.

        ``y.e`` and ``(B's).p = -y'(B'B - 1)p``, for rows no longer than ``longest``.
        """
        return 1.1 * length * longest * (self._product_rounding + self.skew)

    @property
    def _product_rounding(self) -> float:
        """The most of ``|e| / |v|``, in whatever order the product adds."""
        return 1.01 * math.sqrt(self.width) * (len(self.basis) + 8) * ROUNDING
