"""Train WalkNet: the next second of a walk towards a goal  [Continual 3.5].

    python -m motionrt_training.recipes.walknet --corpus runs/recordings.npz --out runs/walknet --minutes 60

Beyond the paper's L2 loss: the histories are noisy or partly the network's own predictions, so that it learns to come
back from its errors; the feet's positions and speeds count; planted feet are pulled to where they stood.
"""

from __future__ import annotations

import argparse
import dataclasses
from collections.abc import Sequence

from motionrt_training.corpora.recordings import load_recordings
from motionrt_training.data_record import data_of
from motionrt_training.options import from_namespace, recipe_parser
from motionrt_training.trainer import Schedule, Trainer
from motionrt_training.walk_pool import load_or_make
from motionrt_training.walk_task import WalkSettings, WalkTask


def train(args: argparse.Namespace) -> dict[str, float]:
    """Train into ``args.out``; returns the last validation."""
    schedule, settings = from_namespace(Schedule, args), from_namespace(WalkSettings, args)
    recordings = load_recordings(args.corpus)
    train_pool, val_pool = (
        load_or_make(recordings, split, args.corpus.with_name(f"walks-{split}.npz")) for split in ("train", "val")
    )
    task = WalkTask(train_pool, val_pool, settings, schedule.seed)
    notes = {**dataclasses.asdict(settings), "network": task.model.config}
    return Trainer(task, schedule, args.out, notes, args.init, data_of(args.corpus)).run()


def parser() -> argparse.ArgumentParser:
    """Every setting with its default."""
    return recipe_parser("Train WalkNet.", Schedule, WalkSettings)


def main(arguments: Sequence[str] | None = None) -> None:
    """The command line."""
    train(parser().parse_args(arguments))


if __name__ == "__main__":
    main()
