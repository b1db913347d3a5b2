"""``motionrt moments``: where in a long motion a text happens."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from motionrt.cli.console import print_json, print_table, working
from motionrt.cli.hits import tell_saved
from motionrt.cli.options import add_json, add_models, add_text_tower, command, runtime
from motionrt.cli.plot import curve_lines
from motionrt.cli.reading import INPUTS, add_reading, read_motion

HELP = """find the moments of a long motion that fit a text
Windows of 0.5 to 3 s slide over the motion; spans that repeat a better one are left out.
Actions that last longer are found better with longer windows: --windows 100,150,200"""


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "moments", run, HELP)
    parser.add_argument("text", help="a sentence, as in 'a person turns around'")
    parser.add_argument("clip", type=Path, help=f"a motion file ({INPUTS})")
    parser.add_argument("-k", type=int, default=5, metavar="N", help="how many moments at most (default: 5)")
    parser.add_argument(
        "--windows",
        type=_frames,
        metavar="FRAMES",
        help="lengths of the windows at 20 fps (default: 10,20,30,40,50,60)",
    )
    parser.add_argument("--min-score", type=float, metavar="S", help="only moments that fit at least so well, -1 to 1")
    parser.add_argument(
        *("-o", "--save"),
        type=Path,
        metavar="DIR",
        help="write the moments there: the original rig, cut to the moment",
    )
    parser.add_argument("--plot", action="store_true", help="draw the similarity over time")
    add_reading(parser)
    add_json(parser)
    add_models(parser)
    add_text_tower(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print the moments, and the curve when asked for."""
    motion = read_motion(arguments, arguments.clip)
    lengths = {"lengths": arguments.windows} if arguments.windows else {}
    with working("searching"):
        found = runtime(arguments).moments(
            arguments.text, motion, arguments.k, min_score=arguments.min_score, **lengths
        )
    if arguments.json:
        print_json(
            [
                {
                    "rank": m.rank,
                    "score": round(m.score, 6),
                    "start": round(m.start_s, 3),
                    "end": round(m.end_s, 3),
                }
                for m in found.best
            ]
        )
    else:
        rows = [[str(m.rank), f"{m.score:.3f}", f"{m.start_s:.2f}", f"{m.end_s:.2f}"] for m in found.best]
        print_table(["rank", "score", "start", "end"], rows, ">>>>")
    if arguments.plot:
        stream = sys.stderr if arguments.json else sys.stdout  # JSON stays alone on stdout
        best = [(m.start_s, m.end_s) for m in found.best]
        for line in curve_lines(found.curve.tolist(), found.fps, best[:1], stream.encoding):
            print(line, file=stream)
    if arguments.save is not None:
        from motionrt.retrieval.saving import save_moments

        tell_saved(save_moments(arguments.clip, motion, found.best, arguments.save), arguments.save)
    return 0


def _frames(text: str) -> tuple[int, ...]:
    try:
        lengths = tuple(int(part) for part in text.split(","))
    except ValueError:
        lengths = ()
    if not lengths or min(lengths) < 1:
        raise argparse.ArgumentTypeError(f"expected numbers of frames from 1 with commas between them, not '{text}'")
    return lengths
