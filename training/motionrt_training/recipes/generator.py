"""Train the denoiser of motions.

    python -m motionrt_training.recipes.generator --corpus runs/views.npz --out runs/generator --minutes 100

The command goes on where it stopped when it is given again.
"""

from __future__ import annotations

import argparse
import dataclasses
import hashlib
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from motionrt_training.backbones import open_backbone
from motionrt_training.corpora.views import Views, load_views
from motionrt_training.data_record import data_of
from motionrt_training.generator_task import GeneratorSettings, GeneratorTask, SpokenLines
from motionrt_training.generator_trial import FRAMES, Trial, looks, read_prompts
from motionrt_training.options import from_namespace, recipe_parser
from motionrt_training.text_cache import cached_features
from motionrt_training.trainer import Schedule, Trainer


def train(args: argparse.Namespace) -> dict[str, float]:
    """Train into `args.out`; returns the last validation."""
    schedule, settings = from_namespace(Schedule, args), from_namespace(GeneratorSettings, args)
    views, prompts = load_views(args.corpus), read_prompts()
    backbone = open_backbone(args.backbone, args.backbone_path)
    texts = SpokenLines.of(views, prompts)
    lines = SpokenLines(texts, cached_features(texts, backbone, args.cache or Path(args.corpus).parent))
    trial = Trial(prompts, [lines.features.of(lines.place[text]) for text in prompts], recorded_looks(views))
    task = GeneratorTask(views, lines, trial, settings, schedule.seed)
    notes = {
        **dataclasses.asdict(settings),
        "backbone": backbone.fingerprint,
        "corpus_sha256": hashlib.sha256(Path(args.corpus).read_bytes()).hexdigest(),
        "network": task.model.config,
    }
    return Trainer(task, schedule, args.out, notes, args.init, data_of(args.corpus)).run()


def recorded_looks(views: Views) -> dict[str, float]:
    """`looks` of 300 views as long as those of the trial."""
    long = np.flatnonzero(views.length >= FRAMES)[:300].tolist()
    return looks([views.motion(row)[:FRAMES].astype(np.float32) for row in long])


def parser() -> argparse.ArgumentParser:
    """Every setting with its default."""
    result = recipe_parser("Train the generator of motions.", Schedule, GeneratorSettings)
    result.add_argument("--backbone", default="minilm", choices=("onnx", "minilm", "hf"), help="text backbone")
    result.add_argument("--backbone-path", type=Path, help="file (onnx) or folder (hf) of the backbone")
    result.add_argument("--cache", type=Path, help="folder of text features (default: beside the corpus)")
    return result


def main(arguments: Sequence[str] | None = None) -> None:
    """The command line."""
    train(parser().parse_args(arguments))


if __name__ == "__main__":
    main()
