"""Clips of simultaneous actions at 30 fps: recordings cut as their captions say, each label with its body parts."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import torch
from torch import Tensor

from motionrt.errors import FormatError, MotionFileNotFoundError
from motionrt.motion.body_parts import checked_parts
from motionrt.motion.features import sinc135
from motionrt_training.corpora.cmu import caption_rows
from motionrt_training.corpora.recordings import FPS, Recordings
from motionrt_training.networks.egocentric import to_egocentric

SHORTEST = 15  # frames


@dataclass(frozen=True)
class Action:
    """One action label and the body parts that it moves."""

    text: str
    parts: frozenset[str]


@dataclass(frozen=True, eq=False)
class ActionClip:
    """A captioned stretch of a recording.

    Attributes:
        id: unique within the captions.
        split: ``train``, ``val`` or ``test``.
        frames: ``(F, 136)`` egocentric frames at 30 fps (:mod:`motionrt_training.networks.egocentric`).
        actions: what is done at the same time.
        captions: sentences on the whole clip.
    """

    id: str
    split: str
    frames: Tensor
    actions: tuple[Action, ...]
    captions: tuple[str, ...]


def read_actions(recordings: Recordings, captions: str | Path) -> list[ActionClip]:
    """Every clip of a ``captions.jsonl`` (id, trial, start_s, end_s, split, labels of text and parts, captions).

    Raises:
        MotionFileNotFoundError: no such file.
        FormatError: a line that is not JSON or misses a key, with its line number.
    """
    path = Path(captions)
    if not path.is_file():
        raise MotionFileNotFoundError(f"{path} does not exist; name the captions.jsonl of the corpus")
    frames: dict[str, Tensor] = {}
    clips = [_clip(row, recordings, frames, path, line) for line, row in caption_rows(path)]
    return [clip for clip in clips if len(clip.frames) >= SHORTEST]


def _clip(row: dict[str, Any], recordings: Recordings, frames: dict[str, Tensor], path: Path, line: int) -> ActionClip:
    try:
        trial = row["trial"]
        if trial not in frames:
            raw = torch.from_numpy(sinc135.encode(recordings.named(trial)))
            frames[trial] = to_egocentric(raw[None])[0]
        part = frames[trial][round(row["start_s"] * FPS) : round(row["end_s"] * FPS)]
        actions = tuple(Action(label["text"], checked_parts(label["parts"])) for label in row["labels"])
        return ActionClip(row["id"], row["split"], part, actions, tuple(row["captions"]))
    except (KeyError, TypeError) as error:
        raise FormatError(path, f"caption row misses or garbles {error}", line) from None
