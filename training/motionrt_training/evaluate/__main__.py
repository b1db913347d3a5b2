r"""Evaluate the exported search models (and torch baselines) on the test split of any packed corpus.

    python -m motionrt_training.evaluate --corpus runs/mocap.npz --recordings ../shared/data/mocap/cmu \
        --variant fp32 --baseline "TMR=runs/tmr_short/best.pt" -o docs/results/search.md --overwrite
    python -m motionrt_training.evaluate --corpus runs/mine/pairs.npz --baseline "mine=runs/tmr/best.pt" \
        --moments babel BABEL --amass AMASS

The page names the corpus and whose data it is. It is written beside the corpus unless -o says otherwise; a page that
is there is only written over with --overwrite.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path

from motionrt.errors import InvalidInputError
from motionrt.metrics.temporal import CURVE, THRESHOLDS
from motionrt.models import TextMotionModel
from motionrt.models.text import MODEL as FULL
from motionrt.retrieval import WINDOW_LENGTHS
from motionrt_training.command import reports_errors
from motionrt_training.contrasts import contrast_scores
from motionrt_training.corpora.cmu import read_cmu
from motionrt_training.corpora.reading import read_corpus
from motionrt_training.data_record import DataRecord, data_of
from motionrt_training.evaluate.embedders import Embedder, load_torch
from motionrt_training.evaluate.files import compare_files
from motionrt_training.evaluate.moments import evaluate_moments
from motionrt_training.evaluate.pairs import PairSet, read_pairs, sources_of
from motionrt_training.evaluate.protocols import SUBSETS, Protocols, SentenceEmbedding, by_style, evaluate
from motionrt_training.evaluate.report import MomentLine, Report, Result

LONG_WINDOWS = (100, 120, 140, 160, 180, 200)


@reports_errors
def main() -> None:
    """The command line."""
    args = _arguments()
    out = free_page(args.out or Path(args.corpus).with_name(f"{Path(args.corpus).stem}-search.md"), args.overwrite)
    model, how = TextMotionModel(args.models), Protocols(1 if args.first_text else 4, args.subset)
    shipped = dict(_variants(args))
    torch = dict(_baselines(args, model))
    sets = {f"{len(pairs)} {name}": pairs for name, pairs in _pair_sets(args)}
    files = [(label, compare_files(one, args.recordings)) for label, one in shipped.items()] if args.recordings else []
    report = Report(
        f"python -m motionrt_training.evaluate {' '.join(sys.argv[1:])}", Path(args.corpus).name,
        [_result(*one, *pairs, model.sentences.embed, how) for pairs in sets.items() for one in shipped.items()],
        [_result(*one, *pairs, model.sentences.embed, how) for pairs in sets.items() for one in torch.items()],
        files, _moments(args, model), describe(data_of(args.corpus)), first_text=args.first_text,
    )  # fmt: skip
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(report.markdown(), encoding="utf-8", newline="\n")
    print(out)


def free_page(path: Path, overwrite: bool) -> Path:
    """Where the page goes; InvalidInputError where one is there already that is not to be written over."""
    if path.exists() and not overwrite:
        raise InvalidInputError(f"{path} is there already; name another page with -o, or say --overwrite")
    return path


def describe(record: DataRecord) -> str:
    """Whose data a corpus is, in a sentence."""
    rows = [f"{row['source']} ({row['recordings']} recordings, licence {row['licence']})" for row in record]
    return "; ".join(rows) or "whose data it is, is not stated"


def _pair_sets(args: argparse.Namespace) -> Iterator[tuple[str, PairSet]]:
    for source in [args.source] if args.source else sources_of(args.corpus, "test"):
        yield f"pairs of {source}", read_pairs(args.corpus, "test", source)
    yield "pairs of all sources", read_pairs(args.corpus, "test")


def _result(
    label: str, embedder: Embedder, name: str, pairs: PairSet, sentences: SentenceEmbedding, how: Protocols
) -> Result:
    contrasts = contrast_scores(pairs.texts, pairs.motions, embedder.embed_text, embedder.embed_motion)
    return Result(label, name, evaluate(embedder, pairs, sentences, how), by_style(embedder, pairs), contrasts)


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
    if args.moments:
        corpus = read_corpus(*args.moments, args.amass).split(args.moment_split)
    elif args.recordings:
        corpus = read_cmu(args.recordings).split("test")
    else:
        return []
    lines = []
    settings = {"10-60 frames (the paper's)": WINDOW_LENGTHS, "100-200 frames": LONG_WINDOWS}
    if args.curve:
        settings |= {f"{frames} frames": (frames,) for frames in (20, 40, 60)}
    for name, windows in settings.items():
        for chance in (False, True):
            label = f"{name}, text of another segment" if chance else name
            thresholds = CURVE if args.curve else THRESHOLDS
            row = evaluate_moments(model, corpus, windows, chance=chance, thresholds=thresholds)
            lines.append(MomentLine(label, row))
    return lines


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="Evaluate retrieval by the four protocols of TMR.")
    parser.add_argument("--corpus", required=True, help="packed corpus (.npz) whose test split is evaluated")
    parser.add_argument("--recordings", help="CMU folder with captions.jsonl, for moments and files")
    parser.add_argument("--models", help="manifest of the exported models (default: the shipped ones)")
    parser.add_argument("--variant", action="append", default=[None], help="evaluate this variant, too (fp32)")
    parser.add_argument("--baseline", action="append", default=[], type=_named, metavar="NAME=CHECKPOINT")
    parser.add_argument("--source", help="of the sources in the corpus evaluate only this one alone (default: each)")
    parser.add_argument("--first-text", action="store_true", help="query by the first caption alone, as in the paper")
    parser.add_argument(
        "--subset", choices=SUBSETS, default="farthest", help="protocol (c): farthest points, or the published knapsack"
    )
    parser.add_argument("--moments", nargs=2, metavar=("CORPUS", "FOLDER"), help="corpus whose segments are looked for")
    parser.add_argument("--moment-split", default="test", help="its split (default: %(default)s; BABEL: val)")
    parser.add_argument("--curve", action="store_true", help="moments by IoU 0.1 to 1, also by windows of one length")
    parser.add_argument("--amass", help="the AMASS folder of --moments")
    parser.add_argument("-o", "--out", type=Path, help="the Markdown file (default: beside the corpus)")
    parser.add_argument("--overwrite", action="store_true", help="write over a page that is there")
    return parser.parse_args()


def _named(text: str) -> tuple[str, str]:
    name, separator, path = text.rpartition("=")
    if not separator:
        raise argparse.ArgumentTypeError(f"expected NAME=CHECKPOINT, not '{text}'")
    return name, path


if __name__ == "__main__":
    main()
