"""``motionrt models``: what the manifest names, everything it says of one, and whether the files are what it says."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionrt.cli.console import print_json, print_table, say
from motionrt.cli.options import add_json, command

if TYPE_CHECKING:
    from motionrt.models import FileReport, Manifest, Model, Variant

BAD_FILES = 1
LIST = """list the models and their variants, those that come with motionrt first"""
SHOW = """everything that the manifest says of a model
Inputs and outputs with units, statistics, exactness promised and found, licence, data, recipe, quality, speed."""
VERIFY = """check every model file against its sha256
The exit code is 1 when a file is missing or damaged."""


def add(commands: Any) -> None:
    """Add the command and its three parts."""
    group = commands.add_parser("models", help="list, show and verify the models")
    parts = group.add_subparsers(title="commands", metavar="COMMAND", required=True)
    show = command(parts, "show", run_show, SHOW)
    show.add_argument("name", metavar="NAME", help="a model, as 'motionrt models list' names it")
    show.add_argument("--variant", metavar="V", help="only this variant (default: all of them)")
    for parser in (command(parts, "list", run_list, LIST), show, command(parts, "verify", run_verify, VERIFY)):
        parser.add_argument("--models", type=Path, metavar="PATH", help="manifest or folder (default: shipped)")
        add_json(parser)


def run_list(arguments: argparse.Namespace) -> int:
    """``models list``."""
    manifest = _manifest(arguments)
    if arguments.json:
        print_json([_as_json(model) for model in manifest.models.values()])
        return 0
    header = ["model", "variant", "MB", "licence", "file"]
    rows = [
        [model.name, _label(model, variant), f"{variant.bytes / 1e6:.1f}", model.licence, variant.file]
        for shipped in (True, False)
        for model in manifest.models.values()
        for variant in model.variants.values()
        if variant.shipped is shipped
    ]
    print_table(header, rows, "<<><<")
    return 0


def run_show(arguments: argparse.Namespace) -> int:
    """``models show``."""
    from motionrt.cli.model_sheet import as_json, sheet

    model = _manifest(arguments).model(arguments.name)
    variants = [model.variant(arguments.variant)] if arguments.variant else list(model.variants.values())
    if arguments.json:
        print_json(as_json(model, variants))
    else:
        print(sheet(model, variants))
    return 0


def run_verify(arguments: argparse.Namespace) -> int:
    """``models verify``."""
    from motionrt.models import verify

    manifest = _manifest(arguments)
    reports = verify(manifest)
    if arguments.json:
        print_json([_report_json(report) for report in reports])
    else:
        rows = [[report.model, report.variant, report.state, str(report.path)] for report in reports]
        print_table(["model", "variant", "state", "file"], rows, "<<<<")
    bad = [report for report in reports if not report.ok]
    if bad:
        say("".join(f"motionrt: {report.problem}\n" for report in bad).rstrip("\n"))
        say(f"motionrt: {len(bad)} of {len(reports)} files of {manifest.path} are not as they should be")
        return BAD_FILES
    return 0


def _manifest(arguments: argparse.Namespace) -> Manifest:
    from motionrt.models import find_manifest, load_manifest

    return load_manifest(find_manifest(arguments.models))


def _label(model: Model, variant: Variant) -> str:
    notes = ["default"] if variant.name == model.default_variant else []
    notes += [] if variant.shipped else ["not shipped"]
    return f"{variant.name} ({', '.join(notes)})" if notes else variant.name


def _as_json(model: Model) -> dict[str, Any]:
    return {
        "name": model.name,
        "description": model.description,
        "licence": model.licence,
        "default_variant": model.default_variant,
        "variants": [
            {
                "name": variant.name,
                "file": variant.file,
                "sha256": variant.sha256,
                "bytes": variant.bytes,
                "shipped": variant.shipped,
                "quantisation": variant.quantisation,
                "parity": variant.parity,
            }
            for variant in model.variants.values()
        ],
        "quality": dict(model.quality),
    }


def _report_json(report: FileReport) -> dict[str, Any]:
    return {
        "model": report.model,
        "variant": report.variant,
        "path": str(report.path),
        "state": report.state,
        "expected": report.expected,
        "found": report.found,
        "expected_bytes": report.expected_bytes,
        "bytes": report.bytes,
        "problem": report.problem,
    }
