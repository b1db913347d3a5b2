"""Train TMR on a packed corpus, or release a trained checkpoint.

    python -m motionrt_training.recipes.tmr --corpus runs/cmu.npz --out runs/tmr --minutes 60
    python -m motionrt_training.recipes.tmr --release runs/tmr/best.pt --to models/tmr.safetensors

The first command goes on where it stopped when it is given again. Table 3 of the paper: `--no-contrastive`,
`--no-reconstruction`, `--margin`; table 4: `--threshold none` or a number.
"""

from __future__ import annotations

import argparse
import dataclasses
import hashlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from motionrt_training.backbones import open_backbone
from motionrt_training.checkpoint import load_state, save_release, trained_model
from motionrt_training.options import add_options, from_namespace
from motionrt_training.packed import load_packed
from motionrt_training.text_cache import cached_features
from motionrt_training.tmr_task import TmrSettings, TmrTask
from motionrt_training.trainer import Schedule, Trainer


def train(args: argparse.Namespace) -> dict[str, float]:
    """Train into `args.out`; returns the last validation."""
    schedule, settings = from_namespace(Schedule, args), from_namespace(TmrSettings, args)
    corpus = load_packed(args.corpus)
    backbone = open_backbone(args.backbone, args.backbone_path)
    texts = cached_features(corpus.texts(), backbone, args.cache or Path(args.corpus).parent)
    task = TmrTask(corpus, texts, settings, schedule.seed)
    notes = {
        **dataclasses.asdict(settings),
        "backbone": backbone.fingerprint,
        "corpus_sha256": hashlib.sha256(Path(args.corpus).read_bytes()).hexdigest(),
        "network": task.model.config,
    }
    return Trainer(task, schedule, args.out, notes).run()


def release(source: Path, target: Path, command: str | None = None) -> None:
    """Averaged weights of a trainer's checkpoint -> float16 safetensors with how they came to be."""
    state: dict[str, Any] = load_state(source)
    facts = {name: state[name] for name in ("seed", "measures", "notes")} | ({"command": command} if command else {})
    facts |= {"recipe": "tmr", "steps": state["step"], "minutes": state["elapsed"] / 60}
    save_release(trained_model(state), target, facts)


def parser() -> argparse.ArgumentParser:
    """Every setting with its default."""
    result = argparse.ArgumentParser(description="Train TMR, or release a trained checkpoint.")
    result.add_argument("--corpus", type=Path, help="packed corpus (.npz)")
    result.add_argument("--out", type=Path, help="folder of the run")
    result.add_argument("--backbone", default="minilm", choices=("onnx", "minilm", "hf"), help="text backbone")
    result.add_argument("--backbone-path", type=Path, help="file (onnx) or folder (hf) of the backbone")
    result.add_argument("--cache", type=Path, help="folder of text features (default: beside the corpus)")
    result.add_argument("--release", type=Path, help="best.pt to release; nothing is trained")
    result.add_argument("--to", type=Path, default=Path("models/tmr.safetensors"), help="released file")
    result.add_argument("--command", help="the command that trained the checkpoint, to be released with it")
    add_options(result, Schedule)
    add_options(result, TmrSettings)
    return result


def main(arguments: Sequence[str] | None = None) -> None:
    """The command line."""
    reader = parser()
    args = reader.parse_args(arguments)
    if args.release:
        release(args.release, args.to, args.command)
    elif args.corpus and args.out:
        train(args)
    else:
        reader.error("give --corpus and --out to train, or --release")


if __name__ == "__main__":
    main()
