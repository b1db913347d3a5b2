"""``motionrt studio``: search, make and direct motion in the browser."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from motionrt.cli.console import say
from motionrt.cli.options import add_models, command, runtime
from motionrt.cli.view import LOOPBACK, add_page, serve

HELP = """search, make and direct motion in the browser
Type a text and watch the best hits; generate; lay one motion over another; click a path and keypoints into a scene and
let a character perform; plan, open, export. Keys: space plays and pauses, arrows step, F frames everything, Z undoes.
The page needs no network. Ctrl-C ends it."""


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "studio", run, HELP)
    parser.add_argument("clips", nargs="*", type=Path, metavar="CLIP", help="motion files to begin with")
    parser.add_argument("--gallery", type=Path, metavar="DIR", help="a gallery, or the folder that was indexed")
    parser.add_argument("--folder", type=Path, metavar="DIR", help="let the page save files here, too")
    add_page(parser)
    add_models(parser)


def run(arguments: argparse.Namespace) -> int:
    """Serve until Ctrl-C."""
    from motionrt.studio import open_studio
    from motionrt.studio.showing import show_of
    from motionrt.studio.workshop import Workshop

    opened = runtime(arguments)
    opened.gallery(arguments.gallery)  # complain now, not in the browser
    show = show_of(arguments.clips, scene=arguments.scene, character=arguments.character)
    for problem in show.problems:
        say(f"motionrt: left out: {problem}")
    workshop = Workshop(opened, arguments.gallery, arguments.folder, local=arguments.host in LOOPBACK)
    return serve(open_studio(show, workshop, host=arguments.host, port=arguments.port), arguments)
