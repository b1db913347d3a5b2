"""Evaluate the exported search models (and torch baselines) on the test split, and write ``docs/results/search.md``.

python -m motionrt_training.evaluate --corpus runs/mocap.npz --recordings ../shared/data/mocap/cmu
--variant fp32 --baseline "TMR=runs/tmr_short/best.pt" -o docs/results/search.md        (one line)
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path

from motionrt.models import TextMotionModel
from motionrt.models.text import MODEL as FULL
from motionrt.retrieval import WINDOW_LENGTHS
from motionrt_training.contrasts import contrast_scores
from motionrt_training.corpora.cmu import read_cmu
from motionrt_training.evaluate.embedders import Embedder, load_torch
from motionrt_training.evaluate.files import compare_files
from motionrt_training.evaluate.moments import evaluate_moments
from motionrt_training.evaluate.pairs import PairSet, read_pairs
from motionrt_training.evaluate.protocols import SentenceEmbedding, by_style, evaluate
from motionrt_training.evaluate.report import MomentLine, Report, Result

LONG_WINDOWS = (100, 120, 140, 160, 180, 200)


def main() -> None:
    """The command line."""
    args = _arguments()
    model = TextMotionModel(args.models)
    shipped = dict(_variants(args))
    torch = dict(_baselines(args, model))
    sets = {f"{len(pairs)} {name}": pairs for name, pairs in _pair_sets(args)}
    files = [(label, compare_files(one, args.recordings)) for label, one in shipped.items()] if args.recordings else []
    report = Report(
        f"python -m motionrt_training.evaluate {' '.join(sys.argv[1:])}", Path(args.corpus).name,
        [_result(*one, *pairs, model.sentences.embed) for pairs in sets.items() for one in shipped.items()],
        [_result(*one, *pairs, model.sentences.embed) for pairs in sets.items() for one in torch.items()],
        files,
        _moments(args, model) if args.recordings else [],
    )  # fmt: skip
    out = Path(args.out)
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(report.markdown(), encoding="utf-8", newline="\n")


def _pair_sets(args: argparse.Namespace) -> Iterator[tuple[str, PairSet]]:
    if args.source:
        yield f"pairs of {args.source}", read_pairs(args.corpus, "test", args.source)
    yield "pairs of all sources", read_pairs(args.corpus, "test")


def _result(label: str, embedder: Embedder, name: str, pairs: PairSet, sentences: SentenceEmbedding) -> Result:
    contrasts = contrast_scores(pairs.texts, pairs.motions, embedder.embed_text, embedder.embed_motion)
    return Result(label, name, evaluate(embedder, pairs, sentences), by_style(embedder, pairs), contrasts)


def _variants(args: argparse.Namespace) -> Iterator[tuple[str, Embedder]]:
    for name in args.variant:
        model = TextMotionModel(args.models, variant=name)
        yield f"exported, {name or 'as shipped'}", model
        if model.text_model != FULL:
            full = TextMotionModel(args.models, variant=name, text_tower="full")
            yield f"exported, {name or 'as shipped'}, full text tower", full


def _baselines(args: argparse.Namespace, model: TextMotionModel) -> Iterator[tuple[str, Embedder]]:
    for label, checkpoint in args.baseline:
        embedder, steps = load_torch(checkpoint, model.sentences)
        yield f"{label} ({steps} steps)", embedder


def _moments(args: argparse.Namespace, model: TextMotionModel) -> list[MomentLine]:
    corpus = read_cmu(args.recordings).split("test")
    lines = []
    for name, windows in (("10-60 frames (the paper's)", WINDOW_LENGTHS), ("100-200 frames", LONG_WINDOWS)):
        for chance in (False, True):
            label = f"{name}, text of another segment" if chance else name
            lines.append(MomentLine(label, evaluate_moments(model, corpus, windows, chance=chance)))
    return lines


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="Evaluate retrieval by the four protocols of TMR.")
    parser.add_argument("--corpus", required=True, help="packed corpus (.npz) whose test split is evaluated")
    parser.add_argument("--recordings", help="CMU folder with captions.jsonl, for moments and files")
    parser.add_argument("--models", help="manifest of the exported models (default: the shipped ones)")
    parser.add_argument("--variant", action="append", default=[None], help="evaluate this variant, too (fp32)")
    parser.add_argument("--baseline", action="append", default=[], type=_named, metavar="NAME=CHECKPOINT")
    parser.add_argument("--source", default="cmu", help="also evaluate this source alone (default: %(default)s)")
    parser.add_argument("-o", "--out", default="docs/results/search.md", help="the Markdown file to write")
    return parser.parse_args()


def _named(text: str) -> tuple[str, str]:
    name, separator, path = text.rpartition("=")
    if not separator:
        raise argparse.ArgumentTypeError(f"expected NAME=CHECKPOINT, not '{text}'")
    return name, path


if __name__ == "__main__":
    main()
