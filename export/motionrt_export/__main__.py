"""Export the trained models.

    python -m motionrt_export all --checkpoints models --out models
    python -m motionrt_export validate --model tmr_text --variant int8 --file models/tmr_text.int8.onnx
    python -m motionrt_export assets

The first command rebuilds the ONNX files and the manifest, and proves every file against torch in a process
of its own; a file beyond its tolerance ends it with exit code 1. The last makes the package data that depends on the
models: the embeddings of the starter gallery and of the captions.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import torch

from motionrt import Runtime
from motionrt_export.measures import Figures
from motionrt_export.publish import Layout, publish, tolerance
from motionrt_export.sources import Sources
from motionrt_export.starter import embed_starter
from motionrt_export.validate import Subject, ValidationError, validate


def main(arguments: Sequence[str] | None = None) -> int:
    """The command line; gives the exit code."""
    args = parser().parse_args(arguments)
    try:
        command: int = args.run(args)
    except (ValidationError, FileNotFoundError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return command


def parser() -> argparse.ArgumentParser:
    """Three commands."""
    result = argparse.ArgumentParser(prog="motionrt_export", description="Export the trained models to ONNX.")
    commands = result.add_subparsers(required=True, metavar="COMMAND")
    everything = commands.add_parser("all", help="export, quantise, validate and write the manifest")
    everything.add_argument("--checkpoints", type=Path, default=Path("models"), help="folder of the released networks")
    everything.add_argument("--out", type=Path, default=Path("models"), help="folder of the shipped files")
    everything.add_argument("--build", type=Path, default=Path("build/models"), help="folder of the float32 files")
    everything.add_argument("--manifest", type=Path, default=Path("models_manifest.yaml"))
    everything.add_argument("--quality", type=Path, help="JSON: model -> figures for the manifest")
    everything.set_defaults(run=_all)
    one = commands.add_parser("validate", help="one file against torch; prints the worst figures as JSON")
    one.add_argument("--model", required=True)
    one.add_argument("--variant", required=True)
    one.add_argument("--file", type=Path, required=True)
    one.add_argument("--checkpoints", type=Path, default=Path("models"))
    one.set_defaults(run=_validate)
    assets = commands.add_parser("assets", help="embed the starter gallery and the captions again")
    assets.add_argument("--models", type=Path, help="manifest or folder (default: the shipped models)")
    assets.add_argument("--out", type=Path, default=Path("runtime/motionrt/_assets"))
    assets.set_defaults(run=_assets)
    return result


def _all(args: argparse.Namespace) -> int:
    layout = Layout(args.manifest, args.out, args.build)
    quality = json.loads(args.quality.read_text(encoding="utf-8")) if args.quality else {}

    def check(model: str, variant: str, file: Path) -> Figures:
        return validate_apart(model, variant, file, args.checkpoints)

    publish(Sources(args.checkpoints), layout, check, quality, print)
    return 0


def _validate(args: argparse.Namespace) -> int:
    torch.set_num_threads(1)  # figures must not depend on the number of cores
    print(json.dumps(validate_file(Sources(args.checkpoints), args.model, args.variant, args.file)))
    return 0


def _assets(args: argparse.Namespace) -> int:
    runtime = Runtime(args.models)
    gallery = embed_starter(runtime, args.out / "starter")
    runtime.captions().save(args.out / "captions.npz")
    print(f"{args.out}: a starter gallery of {len(gallery)} motions, and the captions")
    return 0


def validate_file(sources: Sources, model: str, variant: str, file: Path) -> Figures:
    """Worst figures of one file; raises ValidationError beyond the tolerance."""
    source, limits = sources.source(model), tolerance(model, variant)
    content, trial = file.read_bytes(), source.trial
    subject = Subject(source.spec, content, source.reference, source.examples, limits, source.scale, trial=trial)
    return validate(subject)


def validate_apart(model: str, variant: str, file: Path, checkpoints: Path) -> Figures:
    """`validate_file` in a process of its own, so that no model sees what another left behind."""
    options = {"--model": model, "--variant": variant, "--file": file, "--checkpoints": checkpoints}
    command = [sys.executable, "-m", "motionrt_export", "validate"]
    command += [str(part) for option in options.items() for part in option]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=False)
    if done.returncode:
        raise ValidationError(done.stderr.strip().removeprefix("error: ") or f"{file}: validation crashed")
    figures: Figures = json.loads(done.stdout.splitlines()[-1])
    return figures


if __name__ == "__main__":
    sys.exit(main())
