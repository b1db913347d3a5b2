"""Export the trained models.

    python -m motionrt_export all --checkpoints models --out models
    python -m motionrt_export all --only tmr_text tmr_student
    python -m motionrt_export validate --all
    python -m motionrt_export validate --model tmr_text --variant int8 --file models/tmr_text.int8.onnx
    python -m motionrt_export time
    python -m motionrt_export assets
    python -m motionrt_export portable -o build/portable
    python -m motionrt_export vectors -o build/vectors

The first command rebuilds the ONNX files and the manifest, and proves every file against torch in a process of its
own, and what the files make together; whatever is beyond its tolerance ends it with exit code 1. With `--only` files
and entries of the other models stay as they are. `validate` proves what is there and writes nothing. `time` measures
one call of every file beside torch, for the next export. `assets` makes the package data that depends on the models:
the embeddings of the starter gallery and of the captions. `portable` writes files of standard operators for engines,
`vectors` what ports to other languages check themselves with.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import torch

from motionrt import Runtime
from motionrt.errors import MotionRTError
from motionrt_export import portable
from motionrt_export.layout import Layout
from motionrt_export.measured import NAME, Measured
from motionrt_export.pipelines import PIPELINES
from motionrt_export.proving import apart, validate_all, validate_file, validate_pipeline
from motionrt_export.publish import publish
from motionrt_export.sources import Sources
from motionrt_export.starter import embed_starter
from motionrt_export.validate import ValidationError

MANIFEST = Path("models_manifest.yaml")


def main(arguments: Sequence[str] | None = None) -> int:
    """The command line; gives the exit code."""
    args = parser().parse_args(arguments)
    try:
        command: int = args.run(args)
    except (ValidationError, MotionRTError, FileNotFoundError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return command


def parser() -> argparse.ArgumentParser:
    """One command for each thing to make."""
    result = argparse.ArgumentParser(prog="motionrt_export", description="Export the trained models to ONNX.")
    commands = result.add_subparsers(required=True, metavar="COMMAND")
    everything = commands.add_parser("all", help="export, quantise, validate and write the manifest")
    _add_inputs(everything)
    everything.add_argument("--out", type=Path, default=Path("models"), help="folder of the shipped files")
    everything.add_argument("--build", type=Path, default=Path("build/models"), help="folder of the other files")
    everything.add_argument("--only", nargs="+", metavar="MODEL", help="only these models; the others stay as they are")
    everything.set_defaults(run=_all)
    proof = commands.add_parser("validate", help="everything that is there, or one file; prints figures as JSON")
    _add_inputs(proof, figures=False)
    proof.add_argument("--all", action="store_true", help="every file of the manifest, and what they make together")
    proof.add_argument("--pipeline", choices=PIPELINES, help="what the files of the manifest make together")
    proof.add_argument("--model", help="one file: of this model")
    proof.add_argument("--variant", help="of this variant")
    proof.add_argument("--file", type=Path, help="which is here")
    proof.add_argument("--exact", type=Path, help="the float32 file that it is compared with, too")
    proof.set_defaults(run=_validate)
    clock = commands.add_parser("time", help="one call of every file beside torch, for the next export")
    _add_inputs(clock)
    clock.set_defaults(run=_time)
    assets = commands.add_parser("assets", help="embed the starter gallery and the captions again")
    assets.add_argument("--models", type=Path, help="manifest or folder (default: the shipped models)")
    assets.add_argument("--out", type=Path, default=Path("runtime/motionrt/_assets"))
    assets.set_defaults(run=_assets)
    engines = commands.add_parser("portable", help="files of standard operators, for Unity, WebGPU and other engines")
    engines.add_argument("--checkpoints", type=Path, default=Path("models"), help="folder of the released networks")
    engines.add_argument("-o", "--out", type=Path, default=Path("build/portable"), help="(default: %(default)s)")
    engines.add_argument("--only", nargs="+", metavar="MODEL", help="only these models")
    engines.set_defaults(run=_portable)
    checks = commands.add_parser("vectors", help="test vectors for ports to other languages")
    checks.add_argument("--portable", type=Path, default=Path("build/portable"), help="(default: %(default)s)")
    checks.add_argument("-o", "--out", type=Path, default=Path("build/vectors"), help="(default: %(default)s)")
    checks.set_defaults(run=_vectors)
    return result


def _add_inputs(command: argparse.ArgumentParser, *, figures: bool = True) -> None:
    command.add_argument("--checkpoints", type=Path, default=Path("models"), help="folder of the released networks")
    command.add_argument("--manifest", type=Path, default=MANIFEST, help="(default: %(default)s)")
    if figures:
        name = f"measured benchmark and quality figures (default: {NAME} beside the checkpoints)"
        command.add_argument("--figures", type=Path, help=name)


def _figures(args: argparse.Namespace) -> Path:
    path: Path = args.figures or args.checkpoints / NAME
    return path


def _all(args: argparse.Namespace) -> int:
    layout = Layout(args.manifest, args.out, args.build)
    publish(Sources(args.checkpoints), layout, apart(args.checkpoints), Measured.read(_figures(args)), print, args.only)
    return 0


def _validate(args: argparse.Namespace) -> int:
    if args.all:
        failed = validate_all(args.manifest, apart(args.checkpoints), print)
        print("\n".join(failed) or "everything is within its tolerance", file=sys.stderr)
        return 1 if failed else 0
    torch.set_num_threads(1)  # figures must not depend on the number of cores
    sources = Sources(args.checkpoints)
    if args.pipeline:
        print(json.dumps(validate_pipeline(sources, args.pipeline, args.manifest)))
    elif args.model and args.variant and args.file:
        print(json.dumps(validate_file(sources, args.model, args.variant, args.file, args.exact)))
    else:
        raise ValueError("give --all, or --pipeline, or --model, --variant and --file")
    return 0


def _time(args: argparse.Namespace) -> int:
    from motionrt.bench.report import machine
    from motionrt_export.timing import Stopwatch

    path = _figures(args)
    found = Stopwatch(args.manifest, args.checkpoints)(print)
    measured, here = Measured.read(path), machine()
    made = f"{here['processor']}, {here['cores']} cores, {here['system']}, torch {torch.__version__}"
    replace(measured, benchmark=found, made={**measured.made, "benchmark": made}).write(path)
    print(f"{path}: export again to bring these figures into {args.manifest}")
    return 0


def _assets(args: argparse.Namespace) -> int:
    runtime = Runtime(args.models, text_tower="full")  # embedded once, read by everyone
    gallery = embed_starter(runtime, args.out / "starter")
    runtime.captions().save(args.out / "captions.npz")
    print(f"{args.out}: a starter gallery of {len(gallery)} motions, and the captions")
    return 0


def _portable(args: argparse.Namespace) -> int:
    torch.set_num_threads(1)
    index = portable.build(Sources(args.checkpoints), args.out, print, args.only)
    print(f"{index}\n{portable.table(index)}")
    return 0


def _vectors(args: argparse.Namespace) -> int:
    from motionrt_export.vectors import write_vectors

    print(write_vectors(args.out, args.portable))
    return 0


if __name__ == "__main__":
    sys.exit(main())
