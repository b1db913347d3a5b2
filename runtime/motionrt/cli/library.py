"""``motionrt library``: a folder of generated clips from a list of prompts."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionrt.cli.console import print_json, print_table, say
from motionrt.cli.options import add_json, add_models, command, runtime

if TYPE_CHECKING:
    from motionrt.library import Made

HELP = """fill a folder with clips of a list of prompts
Every clip is measured and taken only where it does what its prompt says; up to --tries are drawn for each. Beside each
clip lies a .json with its foot contacts and loop points; captions.csv serves 'motionrt gallery build'. A run that was
stopped goes on when it is given again. Exit code 3: for some prompts no clip was good enough."""
SKIPPED = 3


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "library", run, HELP)
    parser.add_argument(
        "prompts", type=Path, metavar="PROMPTS", help="a text file, one prompt a line; # begins a remark"
    )
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="OUT", help="folder that the clips go to")
    parser.add_argument("--each", type=int, default=1, metavar="N", help="clips of every prompt (default: 1)")
    parser.add_argument("--seconds", type=float, default=4.0, metavar="S", help="of every clip (default: 4)")
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="of the first try (default: 0)")
    parser.add_argument("--format", default="glb", metavar="NAME", help="glb, gltf, bvh or npz (default: glb)")
    parser.add_argument("--accept", type=float, metavar="A", help="agreement of a clip with its prompt, 0 to 1")
    parser.add_argument("--tries", type=int, metavar="N", help="how often at most for each clip")
    parser.add_argument("--loop", action="store_true", help="clips that end where they begin")
    parser.add_argument("--in-place", action="store_true", help="clips without their way over the ground")
    add_json(parser)
    add_models(parser)


def run(arguments: argparse.Namespace) -> int:
    """Make the clips, say which."""
    from motionrt import library

    accept = library.ACCEPTED if arguments.accept is None else arguments.accept
    tries = library.TRIES if arguments.tries is None else arguments.tries
    found = library.make(
        _prompts(arguments.prompts),
        arguments.output,
        runtime=runtime(arguments),
        each=arguments.each,
        seconds=arguments.seconds,
        seed=arguments.seed,
        suffix=f".{arguments.format.lstrip('.')}",
        accept=accept,
        tries=tries,
        loop=arguments.loop,
        in_place=arguments.in_place,
        progress=_tell,
    )
    if arguments.json:
        print_json([_as_json(made) for made in found])
    else:
        rows = [[f"{one.agreement:.2f}", str(one.file or "-"), one.prompt] for one in found]
        print_table(["agreement", "file", "prompt"], rows, "><<")
    return SKIPPED if any(one.file is None for one in found) else 0


def _prompts(path: Path) -> list[str]:
    from motionrt.errors import InvalidInputError
    from motionrt.untrusted.files import read_utf8

    def fail(reason: str, line: int | None) -> InvalidInputError:
        return InvalidInputError(f"{path}{f':{line}' if line else ''} {reason}")

    try:
        lines = read_utf8(path, fail).splitlines()
    except FileNotFoundError:
        raise fail("does not exist; give a text file with one prompt a line", None) from None
    return [line.strip() for line in lines if line.strip() and not line.lstrip().startswith("#")]


def _tell(made: Made) -> None:
    if made.file is None:
        say(f"no clip for {made.prompt!r}: {'; '.join(made.reasons) or 'none was good enough'}")


def _as_json(made: Made) -> dict[str, object]:
    file = None if made.file is None else str(made.file)
    return {"prompt": made.prompt, "file": file, "agreement": round(made.agreement, 4), "seed": made.seed}
