"""``motionrt bench``: how fast this machine is."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionrt.cli.console import print_json, print_table, say
from motionrt.cli.options import add_json, command

if TYPE_CHECKING:
    from motionrt.bench.report import Plan

HELP = """measure every benchmark, cold start and memory on this machine, alone or beside torch
Every figure is for one call; those of walks are for one character and frame, those of clips for one clip. With
--against others do the same work in turn in the same process at the same thread count: ten calls each after two
untimed ones, as a game's loop calls in sequence; --strict adds figures for one call each in turn."""


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "bench", run, HELP)
    _add_what(parser)
    _add_shown(parser)


def _add_what(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("--threads", type=_counts, default=[1, 2], metavar="N,N", help="thread counts (default: 1,2)")
    add("--against", type=_names, default=[], metavar="NAME,NAME", help="compare with these: torch, transformers")
    add("--only", type=_names, metavar="NAME,NAME", help="some benchmarks only, as in text,walk,pose")
    add("--sizes", type=_counts, metavar="N,N", help="vectors searched (default: 1000,10000,100000; try 1000000)")
    add("--models", type=Path, metavar="PATH", help="models manifest or folder (default: shipped)")
    add("--variant", metavar="NAME", help="which files of the models, as in fp32")
    add("--quick", action="store_true", help="a few calls only: shows that it runs, not how fast")
    add("--strict", action="store_true", help="time everything again, call by call in turn")
    add("--limits", action="store_true", help="also the machine's peaks, and how far from them every benchmark is")


def _add_shown(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--profile", metavar="NAME", help="only show where this benchmark's time goes")
    parser.add_argument("--markdown", action="store_true", help="print a Markdown table")
    parser.add_argument("--plot", type=Path, metavar="FILE", help="draw cost against batch and gallery size (PNG)")
    add_json(parser)


def run(arguments: argparse.Namespace) -> int:
    """Measure, then print."""
    if arguments.profile is not None:
        return _profile(arguments)
    from motionrt.bench.report import run_bench

    found = run_bench(_plan(arguments), say)
    if arguments.plot is not None:
        from motionrt.bench.plot import save_plot

        say(f"wrote {save_plot(found, arguments.plot)}")
    if arguments.json:
        print_json(found)
    elif arguments.markdown:
        from motionrt.bench.markdown import readme_table

        print(readme_table(found))
    else:
        _print(found)
    return 0


def _plan(arguments: argparse.Namespace) -> Plan:
    from motionrt.bench.report import Plan, quick
    from motionrt.bench.workload import SIZES

    plan = Plan(
        threads=arguments.threads,
        models=_models(arguments),
        variant=arguments.variant,
        against=arguments.against,
        only=arguments.only,
        sizes=arguments.sizes or SIZES,
        strict=arguments.strict,
        limits=arguments.limits,
    )
    return quick(plan) if arguments.quick else plan


def _profile(arguments: argparse.Namespace) -> int:
    from motionrt.bench.processes import run_module

    for threads in arguments.threads:
        asked = {"models": _models(arguments), "threads": threads, "variant": arguments.variant}
        found = run_module("motionrt.bench.profiling", {"benchmark": arguments.profile, **asked})
        if arguments.json:
            print_json(found)
        else:
            _print_profile(found)
    return 0


def _print(found: dict[str, Any]) -> None:
    from motionrt.bench import tables

    print(", ".join(f"{name} {version}" for name, version in found["versions"].items()))
    print(f"{found['machine']['processor']}, {found['machine']['cores']} cores, {found['machine']['system']}")
    rivals = found["settings"]["against"]
    for part in found["runs"]:
        header = tables.header(part["threads"], rivals)
        print()
        print_table(header, tables.rows(part, rivals), "<" + ">" * (len(header) - 1))
        for benchmark, why in part["left_out"].items():
            print(f"left out: {benchmark} ({why})")
        if limits := part.get("limits"):
            print()
            print_table(tables.PEAKS, tables.peak_rows(limits["peaks"]), "<>")
            print()
            print_table(tables.LIMITS, tables.limit_rows(limits), "<>>>>>>>")
    print()
    print_table(["on the disk", ""], tables.install_rows(found["install_mb"]), "<>")


def _print_profile(found: dict[str, Any]) -> None:
    wall = found["wall_ms"]
    print(f"{found['case']}, threads: {found['threads']}, {wall:.2f} ms a call with the profiler on")
    parts = {**found["models_ms"], "outside of models": found["outside_ms"]}
    for title, times in (("where", parts), ("operator", found["operators_ms"])):
        print()
        rows = [[name, f"{value:.3f} ms", f"{100 * value / wall:.0f} %"] for name, value in times.items()]
        print_table([title, "a call", "share"], rows, "<>>")
    rows = [[each["function"], f"{each['calls']:.1f}", f"{each['ms']:.3f} ms"] for each in found["python"]]
    print()
    print_table(["Python, own time", "calls", "a call"], rows, "<>>")


def _models(arguments: argparse.Namespace) -> str | None:
    return None if arguments.models is None else str(arguments.models)


def _names(text: str) -> list[str]:
    return [name.strip() for name in text.split(",")]


def _counts(text: str) -> list[int]:
    counts = [int(part) for part in text.split(",")]
    if min(counts) < 1:
        raise argparse.ArgumentTypeError("counts are at least 1")
    return counts
