"""The page on search, ``docs/results/search.md``, as text."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from motionrt_training.evaluate.files import FilesRow
from motionrt_training.evaluate.moments import MomentRow
from motionrt_training.evaluate.protocols import ProtocolRow
from motionrt_training.evaluate.tables import markdown, paper_table, retrieval_table


@dataclass(frozen=True)
class Result:
    """One model on one set of pairs: all protocols, protocol (a) for each caption style, side and path test."""

    name: str
    pairs: str
    rows: Sequence[ProtocolRow]
    styles: Sequence[ProtocolRow]
    contrasts: Mapping[str, float]


@dataclass(frozen=True)
class MomentLine:
    """One setting of moment retrieval."""

    name: str
    row: MomentRow


@dataclass(frozen=True)
class Report:
    """Everything that the page says."""

    command: str
    corpus: str
    shipped: Sequence[Result]
    baselines: Sequence[Result]
    files: Sequence[tuple[str, FilesRow]]
    moments: Sequence[MomentLine]
    data: str = "whose data it is, is not stated"
    held_out: str = (
        "Pairs of the test split, which no model of the tables was trained on if it was trained on this corpus."
    )
    first_text: bool = False

    def markdown(self) -> str:
        """The page."""
        texts = _FIRST if self.first_text else _STYLED
        said = {"command": self.command, "corpus": self.corpus, "data": self.data, "held_out": self.held_out}
        parts = [_INTRODUCTION.format(**said, texts=texts)]
        parts += [f"### {result.name}, {result.pairs}\n\n{_by_protocol(result)}" for result in self.shipped]
        parts += [_STYLES, *(f"### {r.name}, {r.pairs}\n\n{_by_style(r)}" for r in self.shipped[:1])]
        parts += [_CONTRASTS, _contrast_table([*self.shipped, *self.baselines])]
        if self.files:
            parts += [_FILES, _files_table(self.files)]
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


def _by_style(result: Result) -> str:
    return retrieval_table([(row.protocol, row) for row in result.styles])


def _contrast_table(results: Sequence[Result]) -> str:
    head = ["model", "pairs", "side test", "captions", "turn and path test", "captions"]
    names = ("side", "side_captions", "path", "path_captions")
    body = [[r.name, r.pairs, *(f"{r.contrasts.get(n, float('nan')):.{int(not i % 2)}f}" for i, n in enumerate(names))]
            for r in results]  # fmt: skip
    return markdown(head, body)


def _files_table(files: Sequence[tuple[str, FilesRow]]) -> str:
    head = ["model", "recordings", "mean cosine", "least", "least, starts aligned"]
    cosines = [(row.mean, row.least, row.least_aligned) for _, row in files]
    body = [[name, row.recordings, *(f"{x:.4f}" for x in these)]
            for (name, row), these in zip(files, cosines, strict=True)]  # fmt: skip
    return markdown(head, body)


_INTRODUCTION = """# Search: results

Written by `{command}` from `{corpus}`: {data}. Percent, but for the median rank (MedR); t2m: the text is
the query, m2t: the motion is. Embeddings alone: no captions, file names, attributes or re-ranking.

## Retrieval on the test split

{held_out} {texts} Test clips that are nearly alike (a dozen straight walks) cap R@1 of protocol (a).
Protocol (c) keeps the less alike half where there are fewer than 200."""

_STYLED = """Every motion has captions of different style; each style is evaluated as a set of its own and the results
are averaged."""
_FIRST = "The first caption of every motion is its query, as in the paper."

_STYLES = """## Each style of caption, protocol (a)

In the order of the captions file; the last ones are a short query and three further sentences."""

_CONTRASTS = """## Sides and paths

Side test: captions with exactly one side word (left, right, clockwise, ...); won when the clip is nearer than its
mirror image. Turn and path test: those of them that name a turn, a circle or a curve, against the mirror image and the
clip with its yaw rate set to zero. Ties lose; chance is 50 and 33."""

_FILES = """## One recording, two files

Cosine of the embeddings of the same trials as BVH and as AMC, first 10 s."""

_BASELINES = """## What each part is worth

The same data, seed and number of steps; torch modules, averaged weights."""

_MOMENTS = """## Moments in long recordings

Every test trial that its annotation cuts into two or more segments is searched with one sentence for each
segment; accuracy is the share of queries whose best span overlaps the segment by at least the given temporal
IoU. Segments last 6 s on average, so windows of at most 3 s (60 frames) cannot reach high overlap, and the encoder
was trained on crops of 1 s and more, most of them longer than 3 s; the second setting (`motionrt moments
--windows 100,120,140,160,180,200`) looks for spans of 5 to 10 s. The rows with the text of another segment of
the same trial show what the length of the windows alone brings."""

_PAPER = """## For orientation: the paper

Petrovich et al. 2023, tables 1 and 2. Other data (HumanML3D, KIT-ML), far larger test sets: not comparable in absolute
terms."""
