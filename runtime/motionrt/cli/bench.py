"""``motionrt bench``: how fast this machine is."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from motionrt.cli.console import print_json, print_table, say
from motionrt.cli.options import add_json, command

HELP = """measure encoding, search, walking, posing, making motion, cold start and memory on this machine
Every figure is for one call, those of walks for one character and frame; --against takes turns in the same process at
the same thread count."""


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "bench", run, HELP)
    parser.add_argument("--threads", type=_counts, default=[1, 2], metavar="N,N", help="thread counts (default: 1,2)")
    parser.add_argument("--against", metavar="NAME", help="compare with this too, if it is installed: torch")
    parser.add_argument("--quick", action="store_true", help="a few calls only: shows that it runs, not how fast")
    parser.add_argument("--only", type=_names, metavar="ROAD,ROAD", help="some roads only, as in walk,transition,pose")
    parser.add_argument("--models", type=Path, metavar="PATH", help="models manifest or folder (default: shipped)")
    add_json(parser)


def run(arguments: argparse.Namespace) -> int:
    """Measure, then print."""
    from motionrt.bench.report import run_bench

    found = run_bench(
        arguments.threads,
        models=None if arguments.models is None else str(arguments.models),
        against=arguments.against,
        quick=arguments.quick,
        only=arguments.only,
        note=say,
    )
    if arguments.json:
        print_json(found)
    else:
        _print(found, arguments.against)
    return 0


def _print(found: dict[str, Any], against: str | None) -> None:
    from motionrt.bench.report import rows

    print(", ".join(f"{name} {version}" for name, version in found["versions"].items()))
    print(f"{found['machine']['processor']}, {found['machine']['cores']} cores, {found['machine']['system']}")
    other = [against, "ratio"] if against else ["", ""]
    for part in found["runs"]:
        print()
        print_table([f"threads: {part['threads']}", "p50", "p95", "rate", *other], rows(part), "<>>>>>")
        for road, why in part["left_out"].items():
            print(f"left out: {road} ({why})")


def _names(text: str) -> list[str]:
    return [name.strip() for name in text.split(",")]


def _counts(text: str) -> list[int]:
    counts = [int(part) for part in text.split(",")]
    if min(counts) < 1:
        raise argparse.ArgumentTypeError("thread counts are at least 1")
    return counts
