"""A scene as a semantic point cloud: points, each with the name of what it belongs to."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.limits import how_to_raise, limits
from motionrt.locomotion.words.vocabulary import FLOORS, find_label, normal
from motionrt.motion.skeleton import FloatArray
from motionrt.untrusted.arguments import listed
from motionrt.untrusted.words import shorten, shown

_VOXEL = 0.08  # metres; points of one voxel belong together


@dataclass(frozen=True, eq=False, init=False)
class SemanticCloud:
    """``N`` points, Y up, metres, with labels.

    Args:
        points: ``(N, 3)``.
        labels: ``(N,)`` strings, or integers that ``names`` explains.
        names: for integer labels, a list that they index or a mapping from them.

    Attributes:
        points: ``(N, 3)`` float32, read-only.
        names: the labels there are.
        index: ``(N,)`` int64 into ``names``.

    Raises:
        InvalidInputError: no points, shapes that do not fit, numbers that are not finite, an integer without a name.
    """

    points: FloatArray
    names: tuple[str, ...]
    index: npt.NDArray[np.int64]

    def __init__(
        self,
        points: npt.ArrayLike,
        labels: Sequence[str] | Sequence[int] | npt.NDArray[np.generic],
        names: Sequence[str] | Mapping[int, str] | None = None,
    ) -> None:
        array = _numbers(points)
        values, index = np.unique(_labels(labels), return_inverse=True)
        if array.ndim != 2 or array.shape[1] != 3 or not len(array) or index.shape != (len(array),):
            raise InvalidInputError(
                f"a cloud needs points (N, 3) and N labels, not {array.shape} and {np.shape(labels)}"
            )
        if not np.isfinite(array).all():
            raise InvalidInputError("a cloud's points must be finite numbers")
        if len(array) > limits().cloud_points:
            raise InvalidInputError(f"a cloud of {len(array):,} points is too large: {how_to_raise('cloud_points')}")
        if np.abs(array).max() > limits().metres:
            raise InvalidInputError(f"a cloud's points lie too far from the origin: {how_to_raise('metres')}")
        array.setflags(write=False)
        object.__setattr__(self, "points", array)
        object.__setattr__(self, "names", _names(values, names))
        object.__setattr__(self, "index", index.astype(np.int64))

    def __len__(self) -> int:
        return len(self.points)

    def label(self, name: str) -> str:
        """The label that ``name`` means; InvalidInputError lists the labels there are."""
        found = find_label(name, self.names)
        if found is None:
            raise InvalidInputError(f"no '{name}' in the scene; it has: {shorten(', '.join(sorted(self.names)), 500)}")
        return found

    def of(self, label: str) -> FloatArray:
        """Points ``(n, 3)`` with a label of ``names``."""
        return np.asarray(self.points[self.index == self.names.index(label)])

    @property
    def floor_label(self) -> str | None:
        """The label of the ground, if there is one."""
        return next((name for name in self.names if normal(name) in FLOORS), None)

    @property
    def floor(self) -> float:
        """Height of the ground, metres: the median of what is labelled so, else the lowest point."""
        label = self.floor_label
        return float(self.points[:, 1].min() if label is None else np.median(self.of(label)[:, 1]))

    def obstacles(self, thing: npt.NDArray[np.int64] | None = None) -> FloatArray:
        """Points ``(n, 3)`` that are neither the ground nor among the indices ``thing``."""
        free = np.ones(len(self), dtype=bool)
        if thing is not None:
            free[thing] = False
        if self.floor_label is not None:
            free &= self.index != self.names.index(self.floor_label)
        return np.asarray(self.points[free])

    def instances(self, label: str, gap: float = 0.25) -> list[npt.NDArray[np.int64]]:
        """Indices of the separate things that share a label, largest first.

        Points nearer than about ``gap`` metres hang together.
        """
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import connected_components
        from scipy.spatial import cKDTree

        where = np.flatnonzero(self.index == self.names.index(label))
        voxels, member = np.unique(np.floor(self.points[where] / _VOXEL), axis=0, return_inverse=True)
        pairs = cKDTree(voxels * _VOXEL).query_pairs(gap + _VOXEL, output_type="ndarray")
        pairs = pairs.astype(np.int32)  # older versions of SciPy find nothing in graphs of wider indices
        size = len(voxels)
        graph = coo_array((np.ones(len(pairs), bool), (pairs[:, 0], pairs[:, 1])), shape=(size, size))
        count, thing = connected_components(graph, directed=False)
        things = [where[thing[member.reshape(-1)] == i] for i in range(count)]
        return sorted(things, key=len, reverse=True)


def _numbers(points: npt.ArrayLike) -> FloatArray:
    try:
        with np.errstate(over="ignore"):
            return np.array(points, dtype=np.float32)
    except (TypeError, ValueError, OverflowError) as error:
        raise InvalidInputError(f"a cloud's points must be numbers (N, 3), not {shown(points)}") from error


def _labels(labels: object) -> npt.NDArray[np.generic]:
    try:
        found = np.asarray(labels)
    except ValueError as error:  # lists of different lengths
        raise InvalidInputError(f"a cloud's labels must be a list (N,), not {shown(labels)}") from error
    if not found.size:
        return found.astype(str).reshape(-1)
    if found.ndim != 1 or found.dtype.kind not in "USiu":
        raise InvalidInputError(f"labels must be strings or integers (N,), not {found.dtype} {found.shape}")
    return found


def _names(values: npt.NDArray[np.generic], names: Sequence[str] | Mapping[int, str] | None) -> tuple[str, ...]:
    if values.dtype.kind in "US":
        return tuple(value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value) for value in values)
    if names is not None and not isinstance(names, Mapping):
        names = listed(names, "names", "texts")
    table = dict(names) if isinstance(names, Mapping) else dict(enumerate(names or ()))
    missing = [int(value) for value in values.tolist() if value not in table]
    if missing and names is not None:
        raise InvalidInputError(f"labels {missing[:5]} have no name; names has: {shown(sorted(table)[:20])}")
    return tuple(str(table.get(value, value)) for value in values.tolist())
