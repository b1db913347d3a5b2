"""``motionrt similar``: motions like another motion."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from motionrt.cli.console import working
from motionrt.cli.hits import add_output, outcome, show
from motionrt.cli.options import add_json, add_models, command, runtime

HELP = """find the motions of a gallery that are most like a motion
The motion is a file, or a clip of the gallery by its name there, which is then left out."""


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "similar", run, HELP)
    parser.add_argument("motion", help="a motion file, or the name of a clip in the gallery")
    parser.add_argument("--gallery", type=Path, metavar="DIR", help="a gallery, or the folder that was indexed")
    parser.add_argument("-k", type=int, default=10, metavar="N", help="how many hits (default: 10)")
    add_output(parser)
    add_json(parser)
    add_models(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print the hits, save and draw them when asked to."""
    opened = runtime(arguments)
    gallery = opened.gallery(arguments.gallery)
    with working("searching"):
        hits = opened.similar(arguments.motion, arguments.k, gallery)
    show(hits, gallery, arguments)
    return outcome(hits, arguments)
