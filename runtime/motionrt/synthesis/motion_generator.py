"""Text to motion by diffusion in motion space: what is wanted, and the ``Motion`` of what was drawn for it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.models.motion_denoiser import MODEL, MotionDenoiser
from motionrt.models.sessions import Sessions
from motionrt.models.text import MODEL as SENTENCES
from motionrt.models.text import FloatArray, SentenceEncoder, SentenceFeatures
from motionrt.motion import Motion
from motionrt.motion.body_parts import PARTS
from motionrt.motion.features import ego77, sinc135
from motionrt.motion.from_positions import from_positions
from motionrt.motion.transforms import moved, turned
from motionrt.synthesis.canvas import Canvas, Held, Piece, Words, draw
from motionrt.synthesis.constraints import Constraints
from motionrt.synthesis.finishing import finished, locked
from motionrt.synthesis.heads import with_heads
from motionrt.synthesis.sampling import Sampling
from motionrt.synthesis.steering import planned, steered
from motionrt.synthesis.timeline import NETWORK, Line, pieces
from motionrt.text import network_text, parse_query, slots_of_text, standing, targets_of_text

READ = 24  # tokens of a text that the network has learnt to read
RING = 10  # frames at 20 fps over which the end of a loop passes into its beginning

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Wanted:
    """What is to be drawn.

    Attributes:
        lines: texts with their times; see :func:`motionrt.synthesis.timeline.read_timeline`.
        constraints: what is kept or met.
        loop: whether the last frame is the first one again.

    Raises:
        InvalidInputError: a loop of several texts, or one too long for the network.
    """

    lines: tuple[Line, ...]
    constraints: Constraints = field(default_factory=Constraints)
    loop: bool = False

    def __post_init__(self) -> None:
        if self.loop and (len(self.lines) > 1 or self._loop_frames + RING > NETWORK):
            longest = (NETWORK - RING) / ego77.FPS
            raise InvalidInputError(f"a loop is of one text and at most {longest:g} s long")

    @property
    def _loop_frames(self) -> int:
        return max(RING, 2 * round(self.lines[0].end * ego77.FPS / 2))  # even: whole frames at 30 fps, too

    @property
    def frames(self) -> int:
        """Frames at 30 fps; the one at the very end only where something is wanted of it."""
        end = max(line.end for line in self.lines)
        return round(sinc135.FPS * end) + int(self.constraints.last >= end)

    def canvas(self, words: Callable[[str, float], Words]) -> Canvas:
        """The canvas at 20 fps."""
        if self.loop:
            count = self._loop_frames
            return Canvas(
                [_around(words(self.lines[0].text, self.lines[0].end), count)],
                self.constraints.held(count),
                True,
                self._correct,
            )
        found, frames = pieces(self.lines, words)
        held = self.constraints.held(frames)
        if self.constraints.kept or self._correct:
            return Canvas(found, held, False, self._correct)
        return Canvas(found, planned(found, frames).over(held), False, lambda features: steered(features, found))

    @property
    def _correct(self) -> Callable[[FloatArray], Held] | None:
        return self.constraints.corrected if self.constraints.corrects else None


class MotionGenerator:
    """Draws motions of texts; the models open when they are first needed.

    Every sample goes through the network by itself: it comes out the same, bit for bit, alone and among others.

    Args:
        sessions: open models.
        variant: which files, as in ``fp32``; by default those that the manifest prefers.
        sentences: the sentence encoder, where there is one already.
    """

    def __init__(
        self, sessions: Sessions, variant: str | None = None, *, sentences: SentenceEncoder | None = None
    ) -> None:
        self.denoiser = MotionDenoiser(sessions, variant)
        self.sentences = sentences or SentenceEncoder(sessions, variant)

    def generate(self, wanted: Wanted, sampling: Sampling) -> list[Motion]:
        """``sampling.n`` motions: 30 fps, from above the origin, facing +Z, feet on the floor.

        With constraints, heights stay as they were drawn; with a clip that is kept, it begins where that begins.

        Raises:
            ModelNotFoundError, ModelFileError: the models are not there.
        """
        self.denoiser.sessions.prepare(SENTENCES, MODEL, variant=self.denoiser.variant)
        canvas = wanted.canvas(self.words)
        return [self._motion(wanted, canvas, sampling, number) for number in range(sampling.n)]

    def words(self, text: str, seconds: float) -> Words:
        """What the network is told of a text that lasts so long."""
        found = self.sentences.encode(network_text(text))
        read = SentenceFeatures(
            found.token_features[:, :READ], found.attention_mask[:, :READ], found.sentence_embedding
        )
        said = standing(parse_query(text))
        return Words(read, slots_of_text(said), *targets_of_text(said, seconds), said)

    def features(self, canvas: Canvas, sampling: Sampling, number: int = 0) -> FloatArray:
        """Raw ``ego77`` ``(F, 77)`` at 20 fps of sample ``number``."""
        noise = sampling.noise(number, canvas.frames * ego77.WIDTH).reshape(canvas.frames, ego77.WIDTH)
        return draw(self.denoiser, canvas, noise, sampling.calls, (sampling.turn_weight, sampling.weight))

    def _motion(self, wanted: Wanted, canvas: Canvas, sampling: Sampling, number: int) -> Motion:
        features = self.features(canvas, sampling, number)
        if wanted.loop:
            return _closed(features, sampling.foot_lock)
        joints = ego77.decode(features)
        if as_many(len(joints)) < wanted.frames:  # the longest text: the last frame goes on as it went
            joints = np.concatenate([joints, 2 * joints[-1:] - joints[-2:-1]])
        motion = with_heads(as_motion(joints)[: wanted.frames], wanted.lines)
        if wanted.constraints.kept:
            return locked(_where(wanted.constraints.kept[0].motion, motion), sampling.foot_lock)
        if wanted.constraints.corrects:
            return locked(motion, sampling.foot_lock)
        return finished(motion, sampling.foot_lock, walking=not wanted.constraints.keyframes)


def _where(clip: Motion, motion: Motion) -> Motion:
    """A motion, drawn to keep some of a clip, where that clip begins."""
    yaw = float(ego77.facing(np.asarray(clip.resample(ego77.FPS).positions(), np.float64))[0])
    return moved(turned(motion, yaw), clip.root[0] * np.array([1, 0, 1], np.float32))


def as_motion(joints: Array) -> Motion:
    """Joints ``(F, 24, 3)`` at 20 fps to a motion at 30 fps on the bones of ``smpl24``."""
    times = np.arange(as_many(len(joints))) * (ego77.FPS / sinc135.FPS)
    return from_positions(between(joints, times), sinc135.FPS)


def as_many(frames: int) -> int:
    """Frames at 30 fps from the first to the last of so many at 20 fps."""
    return int((frames - 1) * sinc135.FPS / ego77.FPS + 1e-6) + 1


def between(values: Array, times: npt.NDArray[np.floating]) -> Array:
    """Values ``(F, ...)`` at times in frames, along Catmull-Rom splines, which pass through every one of them."""
    last = len(values) - 1
    before = np.minimum(times.astype(int), max(last - 1, 0))
    u = (times - before).reshape(-1, *[1] * (values.ndim - 1))
    a, b, c, d = (values[np.clip(before + k, 0, last)] for k in (-1, 0, 1, 2))
    return np.asarray(b + 0.5 * u * (c - a + u * (2 * a - 5 * b + 4 * c - d + u * (3 * (b - c) + d - a))))


def _around(words: Words, frames: int) -> Piece:
    """A text all round a ring, which it enters and leaves over the same frames."""
    ramp = np.minimum(1.0, np.arange(1, frames + RING + 1) / (RING + 1))
    return Piece(words, 0, np.repeat((ramp * ramp[::-1])[:, None], len(PARTS), axis=1).astype(np.float32))


def _closed(features: FloatArray, foot_lock: bool) -> Motion:
    """The motion of a ring, whose last frame is the first one again; feet are locked over several rounds."""
    rounds = np.concatenate([features] * 3 + [features[:1]])
    motion = finished(as_motion(ego77.decode(rounds)), foot_lock)
    first = round(len(features) * sinc135.FPS / ego77.FPS)
    return motion[first : 2 * first + 1].canonical()
