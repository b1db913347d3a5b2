"""``motionrt moments``: where in a long motion a text happens."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionrt.cli.console import print_json, print_table, say, working
from motionrt.cli.hits import nothing_written, tell_saved
from motionrt.cli.options import add_json, add_models, add_text_tower, command, runtime
from motionrt.cli.plot import curve_lines
from motionrt.cli.reading import INPUTS, add_reading, read_motion

if TYPE_CHECKING:
    from motionrt.retrieval import Moment

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
    parser.add_argument(
        "--min-score",
        type=float,
        metavar="S",
        help="only moments that fit at least so well, -1 to 1 (default: what fits at all, 0.45)",
    )
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
    from motionrt.retrieval.moments import FITS
    from motionrt.untrusted.arguments import checked_number

    motion = read_motion(arguments, arguments.clip)
    lengths = {"lengths": arguments.windows} if arguments.windows else {}
    with working("searching"):
        found = runtime(arguments).moments(arguments.text, motion, arguments.k, **lengths)
    least = FITS if arguments.min_score is None else checked_number(arguments.min_score, "min_score", -1.0, 1.0)
    best = [moment for moment in found.best if moment.score >= least]
    if arguments.json:
        print_json([as_json(moment) for moment in best])
    elif best:
        rows = [[str(m.rank), f"{m.score:.3f}", f"{m.start_s:.2f}", f"{m.end_s:.2f}"] for m in best]
        print_table(["rank", "score", "start", "end"], rows, ">>>>")
    if arguments.plot:
        stream = sys.stderr if arguments.json else sys.stdout  # JSON stays alone on stdout
        marked = [(m.start_s, m.end_s) for m in best[:1]]
        for line in curve_lines(found.curve.tolist(), found.fps, marked, stream.encoding):
            print(line, file=stream)
    if not best:
        return _told_nothing(arguments, found.best[:1])
    if arguments.save is not None:
        from motionrt.retrieval.saving import save_moments

        tell_saved(save_moments(arguments.clip, motion, best, arguments.save), arguments.save)
    return 0


def as_json(moment: Moment) -> dict[str, object]:
    """What ``--json`` says of a moment."""
    span = {"start": round(moment.start_s, 3), "end": round(moment.end_s, 3)}
    return {"rank": moment.rank, "score": round(moment.score, 6), **span}


def _told_nothing(arguments: argparse.Namespace, nearest: Sequence[Moment]) -> int:
    """Say that no moment fits, and how to see the nearest one; exit code 1 where moments were to be saved."""
    for moment in nearest:
        span = f"{moment.start_s:.2f} to {moment.end_s:.2f} s"
        say(f"no moment fits '{arguments.text}'; the nearest is {span}, {moment.score:.3f} (--min-score -1 lists it)")
    return nothing_written([] if arguments.save is None else [f"--save {arguments.save}"])


def _frames(text: str) -> tuple[int, ...]:
    try:
        lengths = tuple(int(part) for part in text.split(","))
    except ValueError:
        lengths = ()
    if not lengths or min(lengths) < 1:
        raise argparse.ArgumentTypeError(f"expected numbers of frames from 1 with commas between them, not '{text}'")
    return lengths
