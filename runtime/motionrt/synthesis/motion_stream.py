"""Motion without an end: a text that plays, and may change while it does."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from motionrt.models.text import FloatArray, checked_text
from motionrt.motion import Motion
from motionrt.motion.body_parts import PARTS
from motionrt.motion.features import ego77, sinc135
from motionrt.motion.feet.live_lock import FootLocker
from motionrt.motion.from_positions import from_positions
from motionrt.synthesis.canvas import Canvas, Held, Piece
from motionrt.synthesis.motion_generator import MotionGenerator, between
from motionrt.synthesis.sampling import Sampling

SEEN, NEW, AHEAD = 10, 40, 10
"""Frames at 20 fps of a step: what went before, what is new, and what is drawn ahead and thrown away."""
STEP_S = NEW / ego77.FPS


class MotionStream(Iterator[Motion]):
    """Two seconds of motion at every step, each going on from the one before.

    The first step begins above the origin, facing +Z. A text that is said counts from the next step on.

    Args:
        generator: draws the steps.
        text: what is done first.
        sampling: chance, guidance, steps and feet; its length does not matter.
    """

    def __init__(self, generator: MotionGenerator, text: str, sampling: Sampling) -> None:
        self._generator, self._sampling = generator, sampling
        self._words = generator.words(checked_text(text), STEP_S)
        self._tail: FloatArray | None = None
        self._place, self._yaw, self._number = np.zeros(2), 0.0, 0
        self._feet = FootLocker(sinc135.FPS) if sampling.foot_lock else None

    def say(self, text: str) -> None:
        """What to do from the next step on.

        Raises:
            InvalidInputError: an empty text.
        """
        self._words = self._generator.words(checked_text(text), STEP_S)

    def __next__(self) -> Motion:
        """The next 60 frames at 30 fps, where the last ones ended."""
        rows = self._drawn()
        seen = 0 if self._tail is None else SEEN
        joints = self._placed(ego77.decode(rows))
        times = seen + np.arange(round(NEW * sinc135.FPS / ego77.FPS)) * (ego77.FPS / sinc135.FPS)
        motion = from_positions(between(joints, times), sinc135.FPS)
        self._go_on(rows, seen + NEW - SEEN)
        return self._locked(motion)

    def _drawn(self) -> FloatArray:
        """Raw features of what is seen, new and ahead."""
        seen = 0 if self._tail is None else SEEN
        held = Held.nothing(seen + NEW + AHEAD)
        if self._tail is not None:
            held.motion[:SEEN], held.parts[:SEEN] = self._tail, True
        piece = Piece(self._words, 0, np.ones((len(held.motion), len(PARTS)), np.float32))
        self._number += 1
        return self._generator.features(Canvas([piece], held), self._sampling, self._number)

    def _placed(self, joints: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        x, z = ego77.to_body(joints[..., 0], joints[..., 2], -self._yaw)
        return np.stack([x + self._place[0], joints[..., 1], z + self._place[1]], axis=-1)

    def _go_on(self, rows: FloatArray, first: int) -> None:
        """Keep the last frames, and where the first of them stands."""
        joints = self._placed(ego77.decode(rows))
        self._place = joints[first, 0, [0, 2]]
        self._yaw += float(rows[:first, 0].sum())
        self._tail = rows[first : first + SEEN]

    def _locked(self, motion: Motion) -> Motion:
        if self._feet is None:
            return motion
        frames = [self._feet.step(*frame) for frame in zip(motion.rotations, motion.root, strict=True)]
        return replace(motion, rotations=np.stack([f[0] for f in frames]), root=np.stack([f[1] for f in frames]))
