"""``docs/results.md`` as text."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from motionrt_training.evaluate.moments import MomentRow
from motionrt_training.evaluate.protocols import ProtocolRow
from motionrt_training.evaluate.tables import markdown, paper_table, retrieval_table


@dataclass(frozen=True)
class Result:
    """One model under all protocols."""

    name: str
    rows: Sequence[ProtocolRow]


@dataclass(frozen=True)
class MomentLine:
    """One setting of moment retrieval."""

    name: str
    row: MomentRow


@dataclass(frozen=True)
class Report:
    """Everything that the results page says."""

    pairs: int
    shipped: Sequence[Result]
    baselines: Sequence[Result]
    moments: Sequence[MomentLine]

    def markdown(self) -> str:
        """The page."""
        parts = [_INTRODUCTION.format(pairs=self.pairs)]
        parts += [f"### {result.name}\n\n{_by_protocol(result)}" for result in self.shipped]
        if self.baselines:
            parts += [_BASELINES, _by_model(self.baselines)]
        if self.moments:
            parts += [_MOMENTS, _moment_table(self.moments)]
        return "\n\n".join([*parts, _PAPER, paper_table()]) + "\n"


def _by_protocol(result: Result) -> str:
    return retrieval_table([(row.protocol, row) for row in result.rows])


def _by_model(results: Sequence[Result]) -> str:
    names = [row.protocol for row in results[0].rows]
    blocks = []
    for index, name in enumerate(names):
        blocks.append(f"{name}\n\n{retrieval_table([(result.name, result.rows[index]) for result in results])}")
    return "\n\n".join(blocks)


def _moment_table(lines: Sequence[MomentLine]) -> str:
    thresholds = list(lines[0].row.accuracy)
    head = ["windows", "queries", "recordings", *(f"IoU >= {t}" for t in thresholds), "mean IoU"]
    body = [
        [line.name, line.row.queries, line.row.recordings, *(f"{line.row.accuracy[t]:.1f}" for t in thresholds),
         f"{line.row.mean_iou:.3f}"]
        for line in lines
    ]  # fmt: skip
    return markdown(head, body)


_INTRODUCTION = """# Results

Written by `python -m motionrt_training.evaluate`; see there for the command. Percent, but for the median rank
(MedR); t2m: the text is the query, m2t: the motion is.

## Retrieval on the test split

{pairs} motion-text pairs of CMU trials that were never trained on. Every motion has four captions of different
style (a headline, a sentence, a detailed description, search words); each style is evaluated as a set of its
own and the results are averaged. Many test clips are nearly alike (a dozen straight walks, a dozen salsa
clips), which caps R@1 of protocol (a). Chance in (a): R@1 1.3, R@10 12.7, MedR 40. Protocol (c) keeps the less
alike half of the pairs, as there are fewer than 200."""

_BASELINES = """## What the contrastive term and the filtering of negatives are worth

The same data, network, seed, schedule and number of steps; only the loss differs. Torch modules, averaged
weights with the best validation. "TEMOS-style" is training without the contrastive term, "no filtering" counts
every other pair as a negative.

Each was trained with `python -m motionrt_training.recipes.tmr --corpus runs/cmu.npz --out runs/NAME --backbone onnx
--backbone-path models/tmr_text.int8.onnx --steps 700 --lr 4e-4 --warmup 100 --ema 0.99 --dropout 0.15
--token-dropout 0.1 --crop 0.5 --threads 1 --validate-every 100`, with `--no-contrastive` and `--threshold none` for the
second and third, and evaluated by naming each `runs/NAME/best.pt` with `--baseline "TEXT=PATH"`."""

_MOMENTS = """## Moments in long recordings

Every test trial that its annotation cuts into two or more segments is searched with one sentence for each
segment; accuracy is the share of queries whose best span overlaps the segment by at least the given temporal
IoU. Segments last 6 s on average, so windows of at most 3 s (60 frames) cannot reach high overlap, and the encoder
was trained on crops of 1 s and more, most of them longer than 3 s; the second setting (`motionrt moments
--windows 100,120,140,160,180,200`) looks for spans of 5 to 10 s. The rows with the text of another segment of
the same trial show what the length of the windows alone brings."""

_PAPER = """## For orientation: the paper

Petrovich et al. 2023, tables 1 and 2, copied without the paper at hand: look them up there before citing them.
Other data (HumanML3D, KIT-ML), far larger test sets: not comparable in absolute terms."""
