"""What TEMOS is trained on: crops of clips and synthetic pairs, each with a sentence (SINC 3.1, 3.3)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from motionrt.errors import InvalidInputError
from motionrt.synthesis.composing import combination, compatible
from motionrt_training.backbones import Backbone
from motionrt_training.corpora.actions import Action, ActionClip
from motionrt_training.corpora.text_mirror import mirror_text
from motionrt_training.networks.egocentric import HEIGHT, RATES, mirrored
from motionrt_training.options import option
from motionrt_training.simultaneous import combined, random_combination
from motionrt_training.wording.pairs import sentence

Features = TypeVar("Features", NDArray[np.float16], NDArray[np.float32])
TRIES = 30  # to find a partner that fits
REPEAT, FADE = 12, 8  # frames: the shortest repetition, and how long it takes to get into it
NEAR = 0.8  # how far apart, in height and 6D rotations, two poses may be to go on from one as from the other


@dataclass(frozen=True)
class ActionData:
    """Which motions and which sentences; the switches of SINC's tables are here."""

    captions: float = option(0.6, "part of the real clips that a caption tells; the others have their action labels")
    pairs: bool = option(True, "say two labels of a clip at once (off: single actions only)")
    real: float = option(1.0, "part of the training clips whose pairs of labels are said")
    synthetic: float = option(0.3, "probability of a synthetic pair in place of a real example")
    replaces: str = option("singles", "which examples: real singles alone, as in the paper, or all", ("singles", "all"))
    random_parts: bool = option(False, "compose synthetic pairs of random body parts")
    separate: bool = option(False, "encode the two labels of a pair separately (STE)")
    least_frames: int = option(60, "shortest batch, frames at 30 fps")
    most_frames: int = option(240, "longest batch, frames at 30 fps")
    prolong: bool = option(False, "repeat short clips whose end is like an earlier pose, such as strides")
    tempo: float = option(0.1, "largest random change of speed")
    mirror: bool = option(True, "mirror half of the motions, with left and right swapped in the text")

    def longest(self, rng: np.random.Generator) -> int:
        """Frames of the crops of a batch: all about the same, so that nothing is padded but short clips."""
        return int(rng.integers(self.least_frames, self.most_frames + 1))


@dataclass(frozen=True)
class Example:
    """Egocentric frames (F, 136) and what is said of them, one text or (separately encoded) several."""

    frames: Tensor
    texts: tuple[str, ...]


class Examples:
    """Random examples of the clips of one split."""

    def __init__(self, clips: Sequence[ActionClip], data: ActionData) -> None:
        if not clips:
            raise ValueError("no clips to train on")
        self.clips, self.data = list(clips), data
        self.labelled = [(clip, action) for clip in self.clips for action in clip.actions if action.parts]
        if data.synthetic and not self.labelled:
            raise InvalidInputError(
                "no clip has an action label with body parts, so that nothing can be composed: give --synthetic 0"
            )

    def draw(self, rng: np.random.Generator, longest: int = 120) -> Example:
        """A crop of a real clip, or a synthetic pair, up to `longest` frames; half of them mirrored."""
        number = int(rng.integers(len(self.clips)))
        told = rng.random() < self.data.captions or not self.clips[number].actions
        replaced = self.data.replaces == "all" or not self._is_pair(number, told)
        if replaced and rng.random() < self.data.synthetic:
            frames, texts = self._synthetic(rng, longest)
        else:
            frames, texts = self._real(number, told, rng, longest)
        if self.data.mirror and rng.random() < 0.5:
            frames, texts = mirrored(frames), tuple(mirror_text(text) for text in texts)
        return Example(frames, texts)

    def _is_pair(self, number: int, told: bool) -> bool:
        """Whether a clip shows two actions and its text says both: a caption, or its labels if pairs are said."""
        return len(self.clips[number].actions) > 1 and (told or self._says_pair(number))

    def _says_pair(self, number: int) -> bool:
        """Whether both labels of a clip are said: a fixed, even choice of clips."""
        return self.data.pairs and (number * 0.618034) % 1.0 < self.data.real

    def _real(self, number: int, told: bool, rng: np.random.Generator, longest: int) -> tuple[Tensor, tuple[str, ...]]:
        clip = self.clips[number]
        frames = self._crop(clip, rng, longest)
        if told:
            return frames, (clip.captions[int(rng.integers(len(clip.captions)))],)
        first, *others = (clip.actions[i].text for i in rng.permutation(len(clip.actions)))
        return frames, self.spoken(first, others[0], rng) if others and self._says_pair(number) else (first,)

    def _synthetic(self, rng: np.random.Generator, longest: int) -> tuple[Tensor, tuple[str, ...]]:
        (clip, action), (other_clip, other) = self._pair(rng)
        parts = random_combination(rng) if self.data.random_parts else combination(action.parts, other.parts)
        frames = combined(self._crop(clip, rng, longest), self._crop(other_clip, rng, longest), parts)
        return frames, self.spoken(action.text, other.text, rng)

    def _pair(self, rng: np.random.Generator) -> tuple[tuple[ActionClip, Action], tuple[ActionClip, Action]]:
        while True:
            first = self.labelled[int(rng.integers(len(self.labelled)))]
            for _ in range(TRIES):
                second = self.labelled[int(rng.integers(len(self.labelled)))]
                if self.data.random_parts or compatible(first[1].parts, second[1].parts):
                    return first, second

    def _crop(self, clip: ActionClip, rng: np.random.Generator, longest: int) -> Tensor:
        frames = prolonged(clip.frames, longest + 1) if self.data.prolong else clip.frames
        return crop(frames, rng, longest, self.data.tempo)

    def spoken(self, first: str, second: str, rng: np.random.Generator) -> tuple[str, ...]:
        """A pair as one sentence, or as two texts."""
        return (first, second) if self.data.separate else (sentence(first, second, rng),)


def crop(frames: Tensor, rng: np.random.Generator, longest: int, tempo: float = 0.0) -> Tensor:
    """A random stretch of up to `longest` frames of (F, 136), at a slightly different speed."""
    speed = float(np.exp(rng.uniform(-1.0, 1.0) * np.log1p(tempo)))
    count = min(longest, max(1, int((len(frames) - 1) / speed) + 1))
    first = rng.uniform(0.0, max(0.0, len(frames) - 1 - (count - 1) * speed))
    at = torch.clamp(first + speed * torch.arange(count), max=len(frames) - 1)
    low = at.long().clamp(max=max(0, len(frames) - 2))
    high = (low + 1).clamp(max=len(frames) - 1)
    found = torch.lerp(frames[low], frames[high], (at - low)[:, None])
    return torch.cat((found[:, RATES] * speed, found[:, RATES.stop :]), dim=1)


def prolonged(frames: Tensor, wanted: int) -> Tensor:
    """A clip (F, 136) that goes on from the earlier frame that is most like its last; as it is where none is near.

    Clips of running last two seconds and say nothing of what comes then: runners who have learnt from them stop.
    """
    last = len(frames) - 2  # the rates of the very last frame say nothing
    if len(frames) >= wanted or last < 2 * REPEAT:
        return frames
    apart = (frames[: last - REPEAT, HEIGHT.start :] - frames[last, HEIGHT.start :]).square().sum(1).sqrt()
    again = int(apart.argmin())
    if float(apart[again]) > NEAR:
        return frames
    off = frames[last] - frames[again]
    part = frames[again + 1 : last + 1].clone()
    weight = torch.linspace(1.0, 0.0, min(FADE, len(part)) + 1)[:-1, None]
    part[: len(weight), HEIGHT.start :] += weight * off[HEIGHT.start :]
    count = -(-(wanted - last - 1) // len(part))
    return torch.cat((frames[: last + 1], part.repeat(count, 1)))[:wanted]


def separated(parts: Sequence[Features]) -> Features:
    """Token features (T, 384) of several texts, one behind the other; between two of them a row of zeros.

    No token's features are zero; a network with a separation token has it in that place.
    """
    between = np.zeros((1, parts[0].shape[1]), parts[0].dtype)
    rows = [row for part in parts for row in (between, part)]
    return np.concatenate(rows[1:])


class SpokenTexts:
    """Token features of texts, each computed once, when it is first said."""

    def __init__(self, backbone: Backbone) -> None:
        self.backbone, self._known = backbone, dict[str, NDArray[np.float16]]()

    def of(self, texts: Sequence[str]) -> NDArray[np.float16]:
        """(T, 384) of a text, or of several encoded separately, one behind the other (see `separated`)."""
        return separated([self._one(text) for text in texts])

    def _one(self, text: str) -> NDArray[np.float16]:
        if text not in self._known:
            self._known[text] = self.backbone.encode(text)[0].astype(np.float16)
        return self._known[text]
