"""Train TEMOS on simultaneous actions (SINC).

    CAPTIONS=../shared/data/mocap/cmu/captions.jsonl
    python -m motionrt_training.recipes.temos --corpus runs/recordings.npz --captions-file $CAPTIONS --out runs/temos

The command, with a budget such as `--minutes 60`, goes on where it stopped when it is given again. Rows of the paper's
tables: single actions only, `--captions 0 --no-pairs --synthetic 0`; no synthetic pairs, `--synthetic 0`; pairs of
random parts, `--random-parts`; separate text encodings, `--separate`; percentages, `--real` and `--synthetic`.
"""

from __future__ import annotations

import argparse
import dataclasses
from collections.abc import Sequence
from pathlib import Path

from motionrt_training.backbones import open_backbone
from motionrt_training.checkpoint import load_any
from motionrt_training.corpora.actions import read_actions
from motionrt_training.corpora.recordings import load_recordings
from motionrt_training.data_record import data_of
from motionrt_training.networks.tmr import TMR
from motionrt_training.options import from_namespace, recipe_parser
from motionrt_training.temos_data import ActionData, SpokenTexts
from motionrt_training.temos_task import TemosSettings, TemosTask
from motionrt_training.trainer import Schedule, Trainer


def train(args: argparse.Namespace) -> dict[str, float]:
    """Train into `args.out`; returns the last validation."""
    schedule, settings = from_namespace(Schedule, args), from_namespace(TemosSettings, args)
    data = from_namespace(ActionData, args)
    clips = read_actions(load_recordings(args.corpus), args.captions_file)
    backbone = open_backbone("onnx", args.encoder)
    task = TemosTask(clips, SpokenTexts(backbone), settings, data, schedule.seed)
    if args.text_from:
        task.model.text_encoder.load_state_dict(load_any(args.text_from, TMR).text_encoder.state_dict())
    notes = {**dataclasses.asdict(settings), **dataclasses.asdict(data), "network": task.model.config}
    return Trainer(
        task, schedule, args.out, {**notes, "backbone": backbone.fingerprint}, args.init, data_of(args.corpus)
    ).run()


def parser() -> argparse.ArgumentParser:
    """The command line, every setting with its default."""
    result = recipe_parser(__doc__ or "", Schedule, TemosSettings, ActionData)
    result.add_argument("--captions-file", type=Path, required=True, help="captions.jsonl with labels and parts")
    result.add_argument("--encoder", type=Path, default=Path("models/tmr_text.int8.onnx"), help="text encoder")
    result.add_argument("--text-from", type=Path, help="a TMR whose text encoder this one begins as")
    return result


def main(arguments: Sequence[str] | None = None) -> None:
    """The command line."""
    train(parser().parse_args(arguments))


if __name__ == "__main__":
    main()
