"""What the files make together, beside torch: two texts composed, and a script performed from beginning to end."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from motionrt import Motion, Runtime, Script
from motionrt.locomotion.performance import Performance
from motionrt.metrics.locomotion import foot_skate, keypoint_error
from motionrt.motion.body_parts import PARTS
from motionrt.synthesis.parts import velocity_parts
from motionrt_export.drift import LEAST_CM, LEAST_M, ratio
from motionrt_export.generation_drift import Floats, about_pelvis
from motionrt_export.measures import Figures

SCRIPT = Path(__file__).resolve().parents[2] / "examples" / "living_room.yaml"
SECONDS = 3.0
LEAST_MISS_CM = 0.5  # smaller misses of keypoints do not count as different
LEGS = (
    "walk forward", "walk backwards", "run forward", "walk in a circle", "sit down on a chair", "do squats",
    "kick with the right leg", "jump up and down", "march in place", "step to the side",
)  # fmt: skip
ARMS = (
    "wave the right hand", "wave the left hand", "raise both arms", "punch with the right arm", "clap the hands",
    "throw a ball with the right hand", "drink from a cup", "point with the left hand", "stretch both arms",
    "scratch the head", "fold the arms", "swing the right arm", "shake hands", "wave both arms", "rub the eyes",
    "play the violin", "lift the left arm", "salute", "shrug the shoulders", "conduct an orchestra",
)  # fmt: skip


@dataclass(frozen=True)
class Composed:
    """The motions of two texts, and what was composed of them."""

    parts: tuple[Motion, Motion]
    motion: Motion

    @property
    def moved(self) -> list[frozenset[str]]:
        """The body parts that the two motions move, by their speed."""
        return [velocity_parts(part) for part in self.parts]


class CompositionDrift:
    """An action of the legs and one of the arms, each from its text, composed: ``count`` of them."""

    name, owner = "composition", "temos_decoder"

    def __init__(self, torch: Runtime, *, count: int = 200, seconds: float = SECONDS) -> None:
        self._torch, self._count, self._seconds = torch, count, seconds

    def __call__(self, runtime: Runtime) -> Figures:
        """Figures of ``composition``, ours against torch's."""
        return {self.name: compared(self._made(runtime), self._expected)}

    @cached_property
    def _expected(self) -> list[Composed]:
        return self._made(self._torch)

    def _made(self, runtime: Runtime) -> list[Composed]:
        return [self._composed(runtime, number) for number in range(self._count)]

    def _composed(self, runtime: Runtime, number: int) -> Composed:
        texts = LEGS[number % len(LEGS)], ARMS[number // len(LEGS) % len(ARMS)]
        first, second = (runtime.generate(text, self._seconds, seed=number) for text in texts)
        wanted = [runtime.body_parts(text) for text in texts]
        return Composed((first, second), runtime.compose([first, second], wanted, seed=number))


def compared(ours: Sequence[Composed], theirs: Sequence[Composed]) -> dict[str, float]:
    """Distances of joints, where the body ends up, how far feet slide, and how many body parts are judged otherwise.

    The last are those that the motions of the texts move, by their speed: six yes or no for each of them.
    """
    pairs = list(zip(ours, theirs, strict=True))
    joints = [(_joints(a.motion), _joints(b.motion)) for a, b in pairs]
    ends = [np.linalg.norm((a[-1, 0] - b[-1, 0])[[0, 2]]) for a, b in joints]
    slides = [float(np.mean([foot_skate(pair[side]) for pair in joints])) for side in (0, 1)]
    other = [len(here ^ there) / len(PARTS) for a, b in pairs for here, there in zip(a.moved, b.moved, strict=True)]
    return {
        "joints_cm": float(np.mean([keypoint_error(about_pelvis(a), about_pelvis(b)) for a, b in joints])),
        "end_cm": 100.0 * float(np.mean(ends)),
        "foot_skate_ratio": ratio(slides[0], slides[1], LEAST_CM),
        "other_parts_percent": 100.0 * float(np.mean(other)),
    }


def _joints(motion: Motion) -> Floats:
    return np.asarray(motion.positions(), np.float64)


class PerformanceDrift:
    """A whole script: walks, poses, transitions and holds, one after the other."""

    name, owner = "performance", "walknet"

    def __init__(self, torch: Runtime, *, script: Path = SCRIPT) -> None:
        self._torch, self._script = torch, script

    def __call__(self, runtime: Runtime) -> Figures:
        """Figures of ``performance``, ours against torch's."""
        return {self.name: performed(self._played(runtime), self._expected)}

    @cached_property
    def _expected(self) -> Performance:
        return self._played(self._torch)

    def _played(self, runtime: Runtime) -> Performance:
        return runtime.play(Script.read(self._script))


def performed(ours: Performance, theirs: Performance) -> dict[str, float]:
    """Whether the same is done, in the same time, as exactly, ending at the same place."""
    mine, other = ours.measures, theirs.measures
    seconds = sorted((ours.motion.duration, theirs.motion.duration))
    end = (ours.motion.root[-1] - theirs.motion.root[-1])[[0, 2]]
    same = [(a.kind, a.name) == (b.kind, b.name) for a, b in zip(ours.segments, theirs.segments, strict=False)]
    return {
        "segments_missed": float(max(len(ours.segments), len(theirs.segments)) - sum(same)),
        "keypoint_ratio": ratio(mine.keypoint_cm or 0.0, other.keypoint_cm or 0.0, LEAST_MISS_CM),
        "keypoint_max_cm": mine.keypoint_max_cm or 0.0,
        "transition_end_cm": mine.transition_end_cm or 0.0,
        "end_cm": 100.0 * float(np.linalg.norm(end)),
        "seconds_ratio": seconds[1] / seconds[0],
        "path_deviation_ratio": ratio(mine.off_path_m or 0.0, other.off_path_m or 0.0, LEAST_M),
        "foot_skate_ratio": ratio(mine.motion.foot_skate_cm, other.motion.foot_skate_cm, LEAST_CM),
    }


Pipeline = Callable[[Runtime], Figures]
PIPELINES: dict[str, type[CompositionDrift | PerformanceDrift]] = {
    drift.name: drift for drift in (CompositionDrift, PerformanceDrift)
}
"""The pipelines by name; the manifest has their figures at the model that owns them."""
