"""Evaluate the exported models (and torch baselines) on the test split, and write ``docs/results.md``.

python -m motionrt_training.evaluate --corpus runs/cmu.npz --recordings ../shared/data/mocap/cmu
--variant fp32 --baseline "TMR=runs/tmr_short/best.pt" -o docs/results.md        (one line)
"""

from __future__ import annotations

import argparse
from pathlib import Path

from motionrt.models import TextMotionModel
from motionrt.retrieval import WINDOW_LENGTHS
from motionrt_training.corpora.cmu import read_cmu
from motionrt_training.evaluate.embedders import load_torch
from motionrt_training.evaluate.moments import evaluate_moments
from motionrt_training.evaluate.pairs import read_pairs
from motionrt_training.evaluate.protocols import evaluate
from motionrt_training.evaluate.report import MomentLine, Report, Result

LONG_WINDOWS = (100, 120, 140, 160, 180, 200)


def main() -> None:
    """The command line."""
    args = _arguments()
    pairs = read_pairs(args.corpus, "test")
    model = TextMotionModel(args.models)
    results = [Result(label, evaluate(shipped, pairs, model.sentences.embed)) for label, shipped in _variants(args)]
    baselines = []
    for label, checkpoint in args.baseline:
        embedder, steps = load_torch(checkpoint, model.sentences)
        baselines.append(Result(f"{label} ({steps} steps)", evaluate(embedder, pairs, model.sentences.embed)))
    report = Report(len(pairs), results, baselines, _moments(args, model) if args.recordings else [])
    Path(args.out).write_text(report.markdown(), encoding="utf-8", newline="\n")


def _variants(args: argparse.Namespace) -> list[tuple[str, TextMotionModel]]:
    return [(f"exported, {name or 'as shipped'}", TextMotionModel(args.models, variant=name)) for name in args.variant]


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
    parser.add_argument("--recordings", help="CMU folder with captions.jsonl, for moment retrieval")
    parser.add_argument("--models", help="manifest of the exported models (default: the shipped ones)")
    parser.add_argument("--variant", action="append", default=[None], help="evaluate this variant, too (fp32)")
    parser.add_argument("--baseline", action="append", default=[], type=_named, metavar="NAME=CHECKPOINT")
    parser.add_argument("-o", "--out", default="docs/results.md", help="the Markdown file to write")
    return parser.parse_args()


def _named(text: str) -> tuple[str, str]:
    name, separator, path = text.rpartition("=")
    if not separator:
        raise argparse.ArgumentTypeError(f"expected NAME=CHECKPOINT, not '{text}'")
    return name, path


if __name__ == "__main__":
    main()
