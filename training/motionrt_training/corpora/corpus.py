"""The common shape of every captioned data set: clips of a recording, each with its texts and its split."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path

from motionrt.errors import FormatError, InvalidInputError, RigError
from motionrt.formats import load_motion
from motionrt.motion import Motion
from motionrt_training.corpora.report import ReadReport

SPLITS = ("train", "val", "test")


@dataclass(frozen=True)
class Clip:
    """A captioned stretch of one recording.

    Attributes:
        id: unique within the corpus.
        path: the motion file.
        start_s, end_s: seconds from the recording's first real frame; ``end_s`` ``None`` means to its end.
        texts: captions that describe the whole stretch, at least one.
        split: ``train``, ``val`` or ``test``.
        labels: simultaneous action labels, where the data set has them.
        group: clips of one group show the same recorded stretch; by default a clip is alone.
        source: the pack that it came in, where a corpus has several.
        categories: action categories, where the data set has them (``act_cat`` of BABEL).
    """

    id: str
    path: Path
    start_s: float
    end_s: float | None
    texts: tuple[str, ...]
    split: str
    labels: tuple[str, ...] = field(default=())
    group: str = ""
    source: str = ""
    categories: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.split not in SPLITS:
            raise InvalidInputError(f"clip {self.id}: split '{self.split}' is none of {SPLITS}")
        if not self.texts or not all(text.strip() for text in self.texts):
            raise InvalidInputError(f"clip {self.id}: every clip needs at least one text, none of them empty")
        if self.end_s is not None and self.end_s <= self.start_s:
            raise InvalidInputError(f"clip {self.id}: ends at {self.end_s} s, before it starts at {self.start_s} s")


@dataclass(frozen=True)
class MotionCorpus:
    """A named list of clips, and how to read their recordings (``loader`` returns a grounded Motion).

    ``report`` says what was found and what was left out; motions that cannot be read are added to it.
    """

    name: str
    clips: tuple[Clip, ...]
    loader: Callable[[Path], Motion] = field(default=lambda path: load_motion(path).grounded())
    report: ReadReport | None = field(default=None, compare=False)

    def __len__(self) -> int:
        return len(self.clips)

    def split(self, name: str) -> MotionCorpus:
        """The clips of one split."""
        return replace(self, clips=tuple(clip for clip in self.clips if clip.split == name))

    def motions(self) -> Iterator[tuple[Clip, Motion]]:
        """Every clip with its motion, in order; neighbouring clips of one recording read its file once.

        With a report, recordings that cannot be read and clips that begin behind their ends are noted there; without
        one the first of them is an error.
        """
        read = lru_cache(maxsize=2)(self.recording)
        for clip in self.clips:
            recording = read(clip.path)
            motion = None if recording is None else self.cut(clip, recording)
            if motion is not None:
                yield clip, motion

    def recording(self, path: Path) -> Motion | None:
        """A whole recording; None where it cannot be read and there is a report to note it in."""
        try:
            return self.loader(path)
        except (FormatError, RigError) as error:
            if self.report is None:
                raise
            self.report.skip(str(path), f"cannot be read ({error.reason if isinstance(error, FormatError) else error})")
            return None

    def cut(self, clip: Clip, recording: Motion) -> Motion | None:
        """The clip's part of its recording; None where it begins behind its end and there is a report to note it in."""
        if self.report is not None and clip.start_s >= recording.duration:
            self.report.skip(clip.id, "begins behind the end of its recording")
            return None
        return recording.between(clip.start_s, recording.duration if clip.end_s is None else clip.end_s)
