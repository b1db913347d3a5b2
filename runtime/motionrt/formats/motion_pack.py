"""Many motions in one small file: those that a gallery carries, and those that come with motionrt.

Rotations are stored as rotation vectors in steps of pi / 32767 (an error below 0.1 mm at arm's length), as
differences from frame to frame, which compress well; roots are float32.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np
import numpy.typing as npt

from motionrt.errors import FormatError, InvalidInputError
from motionrt.motion import SMPL24, Motion
from motionrt.motion.rotations import axis_angle_to_matrix, matrix_to_axis_angle
from motionrt.motion.skeleton import FloatArray
from motionrt.untrusted.npz import read_arrays

_STEP = np.pi / 32767
_KINDS = {"steps": ("i", 2, (24, 3)), "roots": ("f", 4, (3,)), "starts": ("i", 8, ()), "fps": ("f", 8, ())}


@dataclass(frozen=True, eq=False)
class MotionPack:
    """Motions of ``smpl24``, one behind the other.

    Attributes:
        turns: ``(sum F, 24, 3)`` int16 rotation vectors in steps of pi / 32767.
        roots: ``(sum F, 3)`` float32 metres.
        starts: ``(N + 1,)`` int64, the first frame of every motion, and the end.
        fps: ``(N,)`` float64.
    """

    turns: npt.NDArray[np.int16]
    roots: FloatArray
    starts: npt.NDArray[np.int64]
    fps: npt.NDArray[np.float64]

    @classmethod
    def of(cls, motions: Sequence[Motion]) -> MotionPack:
        """Pack motions; InvalidInputError for another skeleton than ``smpl24``."""
        if any(motion.skeleton != SMPL24 for motion in motions):
            raise InvalidInputError("only motions of the smpl24 skeleton can be packed")
        turns = [np.rint(matrix_to_axis_angle(m.rotations) / _STEP).astype(np.int16) for m in motions]
        lengths = [motion.frames for motion in motions]
        starts = np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64)
        roots = np.concatenate([motion.root for motion in motions])
        return cls(np.concatenate(turns), roots, starts, np.array([motion.fps for motion in motions]))

    @classmethod
    def chosen(cls, packs: Sequence[MotionPack], numbers: Sequence[int]) -> MotionPack:
        """The motions of those numbers, counted through all packs one behind the other, as they are."""
        places = [(pack, number) for pack in packs for number in range(len(pack))]
        picked = [(places[n][0], slice(*places[n][0].starts[places[n][1] : places[n][1] + 2])) for n in numbers]
        return cls(
            np.concatenate([pack.turns[part] for pack, part in picked]),
            np.concatenate([pack.roots[part] for pack, part in picked]),
            np.cumsum([0, *(part.stop - part.start for _, part in picked)], dtype=np.int64),
            np.array([places[n][0].fps[places[n][1]] for n in numbers]),
        )

    def __len__(self) -> int:
        return len(self.fps)

    def __getitem__(self, index: int) -> Motion:
        """The motion with that number."""
        part = slice(int(self.starts[index]), int(self.starts[index + 1]))
        rotations = axis_angle_to_matrix(self.turns[part].astype(np.float64) * _STEP)
        return Motion(rotations.astype(np.float32), self.roots[part], float(self.fps[index]))

    def write(self, file: IO[bytes]) -> None:
        """Write as an ``.npz``; the same motions give the same bytes."""
        before = np.zeros_like(self.turns[:1])
        steps = np.diff(self.turns, axis=0, prepend=before)  # int16 wraps, and wraps back when summed
        np.savez_compressed(file, steps=steps, roots=self.roots, starts=self.starts, fps=self.fps)

    @classmethod
    def read(cls, path: Path) -> MotionPack:
        """Read an ``.npz``; FormatError when it is missing or damaged."""
        try:
            arrays, _ = read_arrays(path, lambda reason, line: FormatError(path, reason, line), tuple(_KINDS))
        except FileNotFoundError as error:
            raise FormatError(path, "is missing") from error
        for name, (kind, size, shape) in _KINDS.items():
            array = arrays.get(name)
            if array is None or array.dtype.kind != kind or array.dtype.itemsize != size or array.shape[1:] != shape:
                raise FormatError(path, f"is damaged ('{name}' is missing or of another kind)")
            if array.ndim != 1 + len(shape):
                raise FormatError(path, f"is damaged ('{name}' has the shape {array.shape})")
        pack = cls(_summed(arrays["steps"]), arrays["roots"], arrays["starts"], arrays["fps"])
        pack._check(path)
        return pack

    def _check(self, path: Path) -> None:
        """FormatError unless every motion has frames, and every frame is of one motion."""
        frames = len(self.turns)
        if len(self.roots) != frames or len(self.starts) != len(self.fps) + 1:
            raise FormatError(path, "is damaged (frame counts differ)")
        if self.starts[0] != 0 or self.starts[-1] != frames or not (np.diff(self.starts) > 0).all():
            raise FormatError(path, "is damaged (its motions do not follow one another)")
        if not (np.isfinite(self.fps) & (self.fps > 0)).all() or not np.isfinite(self.roots).all():
            raise FormatError(path, "is damaged (a number is not finite)")


def _summed(steps: npt.NDArray[Any]) -> npt.NDArray[np.int16]:
    return np.cumsum(steps, axis=0, dtype=np.int16)
