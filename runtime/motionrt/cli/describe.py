"""``motionrt describe``: captions for a motion."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from motionrt.cli.console import print_json, print_table, working
from motionrt.cli.options import add_json, add_models, add_text_tower, command, runtime
from motionrt.cli.reading import INPUTS, add_reading, read_motion

HELP = """say what a motion shows: the nearest captions of a list"""


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "describe", run, HELP)
    parser.add_argument("clip", type=Path, help=f"a motion file ({INPUTS})")
    parser.add_argument("-k", type=int, default=5, metavar="N", help="how many captions (default: 5)")
    parser.add_argument("--captions", type=Path, metavar="FILE", help="captions to choose from, one a line")
    add_reading(parser)
    add_json(parser)
    add_models(parser)
    add_text_tower(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print the captions."""
    from motionrt.retrieval import read_captions

    motion = read_motion(arguments, arguments.clip)
    captions = None if arguments.captions is None else read_captions(arguments.captions)
    with working("describing"):
        found = runtime(arguments).describe(motion, arguments.k, captions)
    if arguments.json:
        print_json(
            [
                {
                    "rank": d.rank,
                    "score": round(d.score, 6),
                    "text": d.text,
                    "start": round(d.start_s, 3),
                    "end": round(d.end_s, 3),
                }
                for d in found
            ]
        )
    else:
        rows = [[str(d.rank), f"{d.score:.3f}", f"{d.start_s:.1f}", f"{d.end_s:.1f}", d.text] for d in found]
        print_table(["rank", "score", "start", "end", "caption"], rows, ">>>><")
    return 0
