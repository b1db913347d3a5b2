"""The command ``motionrt``: thin, no logic, and what it needs is imported only by the command that runs.

Exit codes: 0 done, 1 an error (one line on stderr), 2 wrong usage, 3 done, but some files or prompts were skipped, 70 a
mistake of the program itself (--verbose shows where), 130 interrupted, 141 the reader of a pipe has gone. Results go to
stdout, everything else to stderr.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Sequence

from motionrt.cli import (
    bench,
    completion,
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
    study,
    view,
    walk,
    web,
)
from motionrt.cli.console import be_quiet, close_quietly, complain, prepare_streams, say
from motionrt.cli.options import check_output
from motionrt.cli.parsing import Parser, WrongUsageError, split_places
from motionrt.cli.reading import in_options, shown_warnings
from motionrt.errors import MotionRTError

ERROR, USAGE, MISTAKE, INTERRUPTED, BROKEN_PIPE = 1, 2, 70, 130, 141
TRACEBACK = "MOTIONRT_TRACEBACK"
GUIDE = """\
motionrt searches, makes and directs 3D human motion, offline, on a few CPU cores. To begin with:

  motionrt retrieve "a person walks and turns left" --save hits     search the library that comes with it
  motionrt generate "kick with the left foot" -o kick.bvh           make motion of words
  motionrt walk --to 3 2 -o walk.glb                                walk somewhere
  motionrt compose walk.glb "wave the right hand" -o both.glb       two motions at once
  motionrt retarget kick.bvh --to hero.glb -o hero_kicks.glb        on your own character
  motionrt view both.glb                                            look at it in the browser (extra: studio)
  motionrt studio                                                   all of it in the browser (extra: studio)

'motionrt --help' lists all commands, 'motionrt COMMAND --help' explains one."""
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
    study,
    serve,
    web,
    models,
    bench,
    completion,
)


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command, or print the guide where none is given; returns the exit code."""
    prepare_streams()
    given = sys.argv[1:] if argv is None else list(argv)
    try:
        if not given:
            print(GUIDE)
            return 0
        return _run(_parser().parse_args(split_places(given)))
    except SystemExit as stop:  # how argparse ends: help, version, usage
        return stop.code if isinstance(stop.code, int) else 0
    except BrokenPipeError:  # the reader, head perhaps, has seen enough
        close_quietly()
        return BROKEN_PIPE
    except KeyboardInterrupt:
        return INTERRUPTED
    finally:
        be_quiet(quiet=False)


def _run(arguments: argparse.Namespace) -> int:
    """Run a command as loudly as it was asked to; errors become a line and an exit code."""
    started = time.perf_counter()
    be_quiet(arguments.quiet)
    try:
        with shown_warnings():
            check_output(arguments)
            code = int(arguments.run(arguments))
        sys.stdout.flush()
    except MotionRTError as error:
        complain(f"motionrt: error: {in_options(' '.join(str(error).split()), arguments.options)}")
        return USAGE if isinstance(error, WrongUsageError) else ERROR
    except BrokenPipeError:
        raise
    except Exception as error:
        if arguments.verbose or os.environ.get(TRACEBACK):
            raise
        return _explained(error)
    if arguments.verbose:
        say(f"motionrt: done in {time.perf_counter() - started:.2f} s, exit code {code}")
    return code


def _explained(error: Exception) -> int:
    """One line about what no command expects: a full disk, or a mistake in the program."""
    words = " ".join(str(error).split())[:300]
    if isinstance(error, OSError):
        complain(f"motionrt: error: {error.filename or 'the output'}: {error.strerror or words}")
        return ERROR
    complain(f"motionrt: a mistake of this program, please report it: {type(error).__name__}: {words}")
    complain("motionrt: --verbose shows where it happened")
    return MISTAKE


def _parser() -> argparse.ArgumentParser:
    parser = Parser(
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
