"""Test clips of two actions at once: what they are called, and how the recording looks  [SINC 4.1]."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

import torch

from motionrt.errors import InvalidInputError
from motionrt.motion import Motion
from motionrt.motion.features import sinc135
from motionrt.synthesis.composing import compatible
from motionrt_training.corpora.actions import Action, ActionClip, read_actions
from motionrt_training.corpora.recordings import load_recordings
from motionrt_training.networks.egocentric import from_egocentric
from motionrt_training.wording.pairs import joined

LONGEST = 300  # frames
AND, WHILE = "{0} and {1}", "{0} while {1g}"


@dataclass(frozen=True, eq=False)
class ActionPair:
    """Two simultaneous actions and the recorded motion, at 30 fps from the origin, facing +Z.

    Attributes:
        id: of the clip.
        first, second: the actions.
        truth: the recording.
        form: how both are said in one text, as in `motionrt_training.wording.pairs.CONJUNCTIONS`.
    """

    id: str
    first: Action
    second: Action
    truth: Motion
    form: str = AND

    @property
    def sentence(self) -> str:
        """Both actions in one text."""
        return joined(self.first.text, self.second.text, self.form)

    @property
    def fits(self) -> bool:
        """Whether the two need different parts of the body, so that composing them can do both justice."""
        return compatible(self.first.parts, self.second.parts)


def chosen(actions: Sequence[Action]) -> tuple[Action, Action]:
    """Of two or more labels the first two that are compatible, or else the first two."""
    couples = list(combinations(actions, 2))
    return next((pair for pair in couples if compatible(pair[0].parts, pair[1].parts)), couples[0])


def read_action_pairs(
    recordings: str | Path, captions: str | Path, split: str = "test", longest: int = LONGEST, form: str = AND
) -> list[ActionPair]:
    """The clips of a split that have two labels or more, their first ``longest`` frames; ``form`` joins the labels.

    Raises:
        InvalidInputError: there are none.
    """
    clips = read_actions(load_recordings(recordings), captions)
    pairs = [_pair(clip, longest, form) for clip in clips if clip.split == split and len(clip.actions) > 1]
    if not pairs:
        raise InvalidInputError(f"{captions} has no clip of split '{split}' with two labels")
    return pairs


def clip_motion(clip: ActionClip, longest: int = LONGEST) -> Motion:
    """The recording of a clip at 30 fps, from the origin, facing +Z, at most ``longest`` frames."""
    with torch.inference_mode():
        raw = from_egocentric(clip.frames[None, :longest])[0]
    return sinc135.decode(raw.numpy()).canonical()


def _pair(clip: ActionClip, longest: int, form: str) -> ActionPair:
    first, second = chosen(clip.actions)
    return ActionPair(clip.id, first, second, clip_motion(clip, longest), form)
