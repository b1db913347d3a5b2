"""How many negatives the filter drops: TMR's Table A.1 for any corpus, and the threshold that drops as many as there.

    python -m motionrt_training.evaluate.filtering --corpus runs/mocap.npz
    python -m motionrt_training.evaluate.filtering --captions ../shared/data/mocap/cmu/captions.jsonl

Batches are drawn from the training captions as training draws them, one caption a clip. Sentence encoders put similar
sentences at different distances, so that 0.8 of one is not 0.8 of another; ``--like`` gives the share that is wanted.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from motionrt.errors import InvalidInputError
from motionrt.metrics import text_scores
from motionrt.models import TextMotionModel
from motionrt_training.command import reports_errors
from motionrt_training.corpora.cmu import caption_rows
from motionrt_training.evaluate.published import figures
from motionrt_training.evaluate.tables import markdown
from motionrt_training.packed import load_packed
from motionrt_training.text_filter import direction_differs, directions

THRESHOLDS = (0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95)
Embed = Callable[[list[str]], NDArray[np.floating]]


@dataclass(frozen=True)
class Pairs:
    """Every pair of different clips of many batches: similarity of their texts, and whether directions differ."""

    similarity: NDArray[np.float32]
    apart: NDArray[np.bool_]

    def share(self, threshold: float, *, respect_directions: bool) -> float:
        """Percent of the pairs that are no negatives at a threshold."""
        dropped = self.similarity > threshold
        return 100.0 * float((dropped & ~self.apart if respect_directions else dropped).mean())

    def threshold_of(self, share: float, *, respect_directions: bool) -> float:
        """The threshold that drops ``share`` percent of the pairs; InvalidInputError where none drops so many."""
        values = self.similarity[~self.apart] if respect_directions else self.similarity
        wanted = round(share / 100.0 * len(self.similarity))
        if not 0 < wanted <= len(values):
            raise InvalidInputError(f"no threshold drops {share} % of the pairs: directions differ in too many")
        return float(np.sort(values)[::-1][min(wanted, len(values) - 1)])


def drawn_pairs(captions: Sequence[Sequence[str]], embed: Embed, batch: int, batches: int, seed: int = 0) -> Pairs:
    """The pairs of random batches of clips, one random caption each."""
    rng = np.random.default_rng(seed)
    size = min(batch, len(captions))
    if size < 2:
        raise InvalidInputError("pairs need at least two captioned clips in the training split")
    chosen = [rng.choice(len(captions), size, replace=False) for _ in range(batches)]
    texts = [[captions[i][int(rng.integers(len(captions[i])))] for i in rows] for rows in chosen]
    known = list(dict.fromkeys(text for rows in texts for text in rows))
    place, vectors = {text: number for number, text in enumerate(known)}, embed(known)
    off = ~np.eye(size, dtype=bool)
    similarity, apart = [], []
    for rows in texts:
        groups = [directions(text) for text in rows]
        similarity.append(text_scores(vectors[[place[text] for text in rows]])[off])
        apart.append(direction_differs(groups, groups)[off])
    return Pairs(np.concatenate(similarity).astype(np.float32), np.concatenate(apart))


def filtering_table(pairs: Pairs, share: float) -> str:
    """Percent of dropped pairs by threshold, and the thresholds that drop ``share``."""
    rules = (True, False)
    body: list[list[object]] = [
        [f"{threshold:g}", *(f"{pairs.share(threshold, respect_directions=rule):.2f}" for rule in rules)]
        for threshold in THRESHOLDS
    ]
    for rule, name in zip(rules, ("directions respected", "similarity alone"), strict=True):
        try:
            threshold = f"{pairs.threshold_of(share, respect_directions=rule):.3f}"
        except InvalidInputError:
            threshold = "none drops so many"
        body.append([f"{threshold} ({name})", *(f"{share:.2f}" if rule == other else "" for other in rules)])
    return markdown(["threshold", "dropped, directions respected (%)", "dropped, similarity alone (%)"], body)


def published_share() -> float:
    """Percent of the pairs that TMR drops at 0.8."""
    return next(figure.value for figure in figures() if figure.paper == "TMR" and figure.place == "A.1")


def _of_rows(path: Path) -> list[tuple[str, ...]]:
    """The captions of the training rows of a ``captions.jsonl``."""
    return [tuple(row["captions"]) for _, row in caption_rows(path) if row["split"] == "train"]


def _of_pack(path: str) -> list[tuple[str, ...]]:
    return [clip.texts for clip in load_packed(path).split("train")]


@reports_errors
def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description="Share of negatives that the text filter drops.")
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--corpus", help="packed corpus (.npz), of which the training split is read")
    source.add_argument("--captions", type=Path, help="captions.jsonl, of which the training split is read")
    parser.add_argument("--batch", type=int, default=32, help="clips of a batch (default: %(default)s)")
    parser.add_argument("--batches", type=int, default=200, help="batches to draw (default: %(default)s)")
    parser.add_argument("--like", type=float, default=published_share(), help="percent to drop (default: %(default)s)")
    parser.add_argument("--models", help="manifest of the exported models (default: the shipped ones)")
    args = parser.parse_args()
    captions = (
        _of_rows(args.captions) if args.captions else [clip.texts for clip in load_packed(args.corpus).split("train")]
    )
    pairs = drawn_pairs(captions, TextMotionModel(args.models).sentences.embed, args.batch, args.batches)
    print(filtering_table(pairs, args.like))


if __name__ == "__main__":
    main()
