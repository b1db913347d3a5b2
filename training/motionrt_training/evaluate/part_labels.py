"""Accuracy of body-part labellers: on phrases answered by hand, and on the test clips, where there are motions, too."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from motionrt import metrics
from motionrt.errors import FormatError
from motionrt.motion import Motion
from motionrt.motion.body_parts import PARTS
from motionrt_training.corpora.actions import ActionClip
from motionrt_training.evaluate.simultaneous import clip_motion
from motionrt_training.evaluate.tables import markdown

Labeller = Callable[[str], Iterable[str]]
MotionLabeller = Callable[[Motion], Iterable[str]]


@dataclass(frozen=True)
class Phrases:
    """Phrases, and for each a row of yes, no or sometimes in the order of ``PARTS``."""

    texts: tuple[str, ...]
    answers: tuple[tuple[str, ...], ...]


def read_phrases(path: str | Path) -> Phrases:
    """A table with tabs: ``#`` comments, a header, then a phrase and six answers a line.

    Raises:
        FormatError: a header of other columns, or a line of another length, with its number.
    """
    source = Path(path)
    lines = list(enumerate(source.read_text(encoding="utf-8").splitlines(), 1))
    rows = [(n, line.split("\t")) for n, line in lines if line.strip() and not line.startswith("#")]
    if not rows or tuple(name.strip() for name in rows[0][1][1:]) != PARTS:
        raise FormatError(source, f"expected the columns phrase, {', '.join(PARTS)}", rows[0][0] if rows else 1)
    for number, row in rows[1:]:
        if len(row) != 1 + len(PARTS):
            raise FormatError(source, f"expected {1 + len(PARTS)} columns, found {len(row)}", number)
    return Phrases(tuple(row[0].strip() for _, row in rows[1:]), tuple(tuple(row[1:]) for _, row in rows[1:]))


def on_phrases(labellers: Mapping[str, Labeller], phrases: Phrases) -> dict[str, metrics.PartAccuracy]:
    """Every labeller, and the floor: for each part the answer that is most common."""
    rows = {
        name: metrics.part_accuracy([label(t) for t in phrases.texts], phrases.answers)
        for name, label in labellers.items()
    }
    floor = metrics.part_accuracy([most_common(phrases.answers)] * len(phrases.texts), phrases.answers)
    return {**rows, "most common answer": floor}


def on_clips(
    labellers: Mapping[str, Labeller], watchers: Mapping[str, MotionLabeller], clips: Sequence[ActionClip]
) -> dict[str, metrics.PartAccuracy]:
    """The parts of all labels of a clip together: from the labels' texts, and from the motion."""
    answers = [_answers(part for action in clip.actions for part in action.parts) for clip in clips]
    found: dict[str, list[Iterable[str]]] = {
        name: [{part for action in clip.actions for part in label(action.text)} for clip in clips]
        for name, label in labellers.items()
    }
    motions = [clip_motion(clip) for clip in clips] if watchers else []
    found |= {name: [watch(motion) for motion in motions] for name, watch in watchers.items()}
    found["most common answer"] = [most_common(answers)] * len(clips)
    return {name: metrics.part_accuracy(parts, answers) for name, parts in found.items()}


def on_labels(labellers: Mapping[str, Labeller], clips: Sequence[ActionClip]) -> dict[str, metrics.PartAccuracy]:
    """Every different label of the clips by itself."""
    actions = list({action.text: action for clip in clips for action in clip.actions}.values())
    phrases = Phrases(tuple(a.text for a in actions), tuple(_answers(a.parts) for a in actions))
    return on_phrases(labellers, phrases)


def most_common(answers: Sequence[Sequence[str]]) -> list[str]:
    """The parts for which yes is more common than no."""
    counts = [Counter(row[column] for row in answers) for column in range(len(PARTS))]
    return [part for part, count in zip(PARTS, counts, strict=True) if count["yes"] > count["no"]]


def part_table(rows: Mapping[str, metrics.PartAccuracy]) -> str:
    """Accuracies in Markdown."""
    head = ["", "phrases", *PARTS, "mean", "all six right"]
    body = [
        [name, row.phrases, *(f"{v:.3f}" for v in row.accuracy.values()), f"{row.mean:.3f}", f"{row.exact:.3f}"]
        for name, row in rows.items()
    ]
    return markdown(head, body)


def part_page(tables: Mapping[str, Mapping[str, metrics.PartAccuracy]]) -> str:
    """Every table under its title."""
    blocks = [_INTRODUCTION, *(f"**{title}**\n\n{part_table(rows)}" for title, rows in tables.items())]
    return "\n\n".join(blocks) + "\n"


def _answers(parts: Iterable[str]) -> tuple[str, ...]:
    named = set(parts)
    return tuple("yes" if part in named else "no" for part in PARTS)


_INTRODUCTION = "Share of right answers for every body part; what people answered with 'sometimes' does not count."
