"""The command ``motionrt``: thin, no logic, and what it needs is imported only by the command that runs.

Exit codes: 0 done, 1 an error (one line on stderr), 2 wrong usage, 3 a gallery was made but some files were skipped,
70 a mistake of the program itself (MOTIONRT_TRACEBACK=1 shows where), 130 interrupted. Results go to stdout, everything
else to stderr.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence

from motionrt.cli import (
    bench,
    compose,
    convert,
    describe,
    galleries,
    generate,
    info,
    library,
    models,
    moments,
    parts,
    perform,
    render,
    retarget,
    retrieve,
    rig,
    serve,
    similar,
    studio,
    view,
    walk,
)
from motionrt.cli.console import close_quietly, prepare_streams, say
from motionrt.cli.reading import in_options, shown_warnings
from motionrt.errors import MotionRTError

ERROR, MISTAKE, INTERRUPTED, BROKEN_PIPE = 1, 70, 130, 141
TRACEBACK = "MOTIONRT_TRACEBACK"
_COMMANDS = (
    retrieve,
    similar,
    galleries,
    describe,
    moments,
    generate,
    compose,
    library,
    parts,
    walk,
    perform,
    render,
    info,
    convert,
    retarget,
    rig,
    view,
    studio,
    serve,
    models,
    bench,
)


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit code."""
    prepare_streams()
    try:
        arguments = _parser().parse_args(argv)
        with shown_warnings():
            code = int(arguments.run(arguments))
        sys.stdout.flush()
    except SystemExit as stop:  # how argparse ends: help, version, usage
        return stop.code if isinstance(stop.code, int) else 0
    except MotionRTError as error:
        say(f"motionrt: error: {in_options(' '.join(str(error).split()))}")
        return ERROR
    except BrokenPipeError:  # the reader, head perhaps, has seen enough
        close_quietly()
        return BROKEN_PIPE
    except KeyboardInterrupt:
        return INTERRUPTED
    except Exception as error:
        if os.environ.get(TRACEBACK):
            raise
        return _explained(error)
    return code


def _explained(error: Exception) -> int:
    """One line about what no command expects: a full disk, or a mistake in the program."""
    words = " ".join(str(error).split())[:300]
    if isinstance(error, OSError):
        say(f"motionrt: error: {error.filename or 'the output'}: {error.strerror or words}")
        return ERROR
    say(f"motionrt: a mistake of this program, please report it: {type(error).__name__}: {words}")
    say(f"motionrt: {TRACEBACK}=1 shows where it happened")
    return MISTAKE


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="motionrt",
        description="Search 3D human motion by text, make it, walk and act in scenes, offline, on a few CPU cores.",
        epilog="'motionrt COMMAND --help' explains a command.",
    )
    parser.add_argument("--version", action=_Version, nargs=0, help="print the version and exit")
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    for command in _COMMANDS:
        command.add(commands)
    return parser


class _Version(argparse.Action):
    """Finds the version only when it is asked for: looking it up is slow."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        import motionrt

        print(f"motionrt {motionrt.__version__}")
        parser.exit()
