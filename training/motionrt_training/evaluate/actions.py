"""Action recognition by text: which of many action names does a motion get?

    python -m motionrt_training.evaluate.actions babel BABEL --amass AMASS --classes 60 --split val
    python -m motionrt_training.evaluate.actions cmu ../shared/data/mocap/cmu --classes 30 --split test

A class is an action category (``act_cat`` of BABEL) or, where a corpus has none, an action label; the classes are the
most frequent of the training split, as BABEL-60 and BABEL-120 are. No classifier is trained: a motion gets the class
whose name lies nearest to it. A clip of several classes is right with any of them.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.models import TextMotionModel
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval import motion_features
from motionrt.retrieval.windows import WINDOW_FRAMES
from motionrt_training.command import reports_errors
from motionrt_training.corpora import Clip, MotionCorpus
from motionrt_training.corpora.reading import add_options, read_named
from motionrt_training.evaluate.embedders import Embedder, load_torch
from motionrt_training.evaluate.tables import markdown

LEAST = 10  # frames at 20 fps of a clip that is worth a name


@dataclass(frozen=True)
class Recognition:
    """Accuracy in percent.

    Attributes:
        clips, classes: how many.
        top1, top5: clips whose class is the nearest, or among the nearest five.
        per_class: mean over the classes of the share of their clips that are right, by the nearest.
        most_common: what naming the most frequent class always would reach.
    """

    clips: int
    classes: int
    top1: float
    top5: float
    per_class: float
    most_common: float


def classes_of(clip: Clip) -> tuple[str, ...]:
    """The categories of a clip, or its labels."""
    return clip.categories or clip.labels


def frequent_classes(corpus: MotionCorpus, count: int) -> list[str]:
    """The most frequent classes of the training split, ties by name.

    Raises:
        InvalidInputError: training clips have neither categories nor labels.
    """
    counts = Counter(name for clip in corpus.split("train").clips for name in classes_of(clip))
    if not counts:
        raise InvalidInputError(f"the training clips of {corpus.name} have neither action categories nor labels")
    return [name for name, _ in sorted(counts.items(), key=lambda item: (-item[1], item[0]))[:count]]


def recognise(embedder: Embedder, corpus: MotionCorpus, classes: Sequence[str], prompt: str = "{}") -> Recognition:
    """Name every clip of ``corpus`` that has one of ``classes``; ``prompt`` makes a sentence of a name.

    Raises:
        InvalidInputError: no clip has any of them.
    """
    kept = [
        (features, {classes.index(name) for name in classes_of(clip) if name in classes})
        for clip, motion in corpus.motions()
        if set(classes_of(clip)) & set(classes) and len(features := motion_features(motion)[:WINDOW_FRAMES]) >= LEAST
    ]
    if not kept:
        raise InvalidInputError(f"no clip of {corpus.name} has any of the {len(classes)} classes; name another split")
    texts = embedder.embed_text([prompt.format(name) for name in classes])
    order = np.argsort(-embedder.embed_motion([features for features, _ in kept]) @ texts.T, axis=1, kind="stable")
    return _accuracy(order, [right for _, right in kept], len(classes))


def _accuracy(order: FloatArray, right: Sequence[set[int]], classes: int) -> Recognition:
    """Of the classes of every clip by nearness ``(N, C)`` and its right ones."""
    first = np.array([int(row[0]) in names for row, names in zip(order, right, strict=True)])
    five = np.array([bool(names & set(row[:5].tolist())) for row, names in zip(order, right, strict=True)])
    of_class = [[number in names for names in right] for number in range(classes)]
    shares = [first[np.array(mask)].mean() for mask in of_class if any(mask)]
    common = max(sum(mask) for mask in of_class) / len(right)
    return Recognition(
        len(right), classes, *(100.0 * float(value) for value in (first.mean(), five.mean(), np.mean(shares), common))
    )


def recognition_table(rows: Sequence[tuple[str, Recognition]]) -> str:
    """Markdown, a row a model."""
    head = ["", "clips", "classes", "top-1", "top-5", "mean over classes", "most common class"]
    body = [
        [
            name,
            row.clips,
            row.classes,
            *(f"{value:.1f}" for value in (row.top1, row.top5, row.per_class, row.most_common)),
        ]
        for name, row in rows
    ]
    return markdown(head, body)


@reports_errors
def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description="Action recognition by text, without a trained classifier.")
    add_options(parser)
    parser.add_argument("--classes", type=int, default=60, help="how many classes (default: %(default)s)")
    parser.add_argument("--prompt", default="{}", help="sentence around the name of a class (default: the name alone)")
    parser.add_argument("--split", default="val", help="the clips that are named (default: %(default)s)")
    parser.add_argument("--models", help="manifest of the exported models (default: the shipped ones)")
    parser.add_argument("--checkpoint", type=Path, help="a trained TMR to measure beside them")
    args = parser.parse_args()
    corpus, model = read_named(args), TextMotionModel(args.models)
    classes = frequent_classes(corpus, args.classes)
    embedders: dict[str, Embedder] = {"exported": model}
    if args.checkpoint:
        embedders["checkpoint"] = load_torch(args.checkpoint, model.sentences)[0]
    part = corpus.split(args.split)
    print(recognition_table([(name, recognise(one, part, classes, args.prompt)) for name, one in embedders.items()]))


if __name__ == "__main__":
    main()
