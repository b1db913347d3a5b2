"""Train TMR on a packed corpus.

    python -m motionrt_training.recipes.tmr --corpus runs/cmu.npz --out runs/tmr --minutes 60

The command goes on where it stopped when it is given again. Table 3 of the paper: `--no-contrastive`,
`--no-reconstruction`, `--margin`; table 4: `--threshold none` or a number. `--leave-out SOURCE` trains on all sources
but one, which can then be searched by a model that never saw it.
"""

from __future__ import annotations

import argparse
import dataclasses
import hashlib
from collections.abc import Sequence
from pathlib import Path

from motionrt_training.backbones import open_backbone
from motionrt_training.data_record import data_of
from motionrt_training.options import from_namespace, recipe_parser
from motionrt_training.packed import load_packed, without_source
from motionrt_training.text_cache import cached_features
from motionrt_training.tmr_task import TmrSettings, TmrTask
from motionrt_training.trainer import Schedule, Trainer


def train(args: argparse.Namespace) -> dict[str, float]:
    """Train into `args.out`; returns the last validation."""
    schedule, settings = from_namespace(Schedule, args), from_namespace(TmrSettings, args)
    corpus = load_packed(args.corpus)
    backbone = open_backbone(args.backbone, args.backbone_path)
    texts = cached_features(corpus.texts(), backbone, args.cache or Path(args.corpus).parent)
    if args.leave_out:
        corpus = without_source(corpus, args.leave_out)
    task = TmrTask(corpus, texts, settings, schedule.seed)
    notes = {
        **dataclasses.asdict(settings),
        "backbone": backbone.fingerprint,
        "corpus_sha256": hashlib.sha256(Path(args.corpus).read_bytes()).hexdigest(),
        "network": task.model.config,
        **({"left_out": args.leave_out} if args.leave_out else {}),
    }
    return Trainer(task, schedule, args.out, notes, args.init, data_of(args.corpus)).run()


def parser() -> argparse.ArgumentParser:
    """Every setting with its default."""
    result = recipe_parser("Train TMR.", Schedule, TmrSettings)
    result.add_argument("--backbone", default="minilm", choices=("onnx", "minilm", "hf"), help="text backbone")
    result.add_argument("--backbone-path", type=Path, help="file (onnx) or folder (hf) of the backbone")
    result.add_argument("--leave-out", metavar="SOURCE", help="train on all sources of the corpus but this one")
    result.add_argument("--cache", type=Path, help="folder of text features (default: beside the corpus)")
    return result


def main(arguments: Sequence[str] | None = None) -> None:
    """The command line."""
    train(parser().parse_args(arguments))


if __name__ == "__main__":
    main()
