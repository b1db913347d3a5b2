"""``motionrt view``: clips in the browser."""

from __future__ import annotations

import argparse
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionrt.cli.console import say
from motionrt.cli.options import command

LOOPBACK = ("127.0.0.1", "localhost", "::1")

if TYPE_CHECKING:
    from motionrt.studio.serving import Page
    from motionrt.studio.windows import Show

HELP = """play motion files in the browser, one or several side by side
Keys: space plays and pauses, arrows step, F frames everything. The page needs no network. Ctrl-C ends it."""


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "view", run, HELP)
    parser.add_argument("clips", nargs="+", type=Path, metavar="CLIP", help="motion files (.bvh, .amc, .npz, .glb)")
    parser.add_argument("--layout", metavar="HOW", help="as recorded, side by side or overlaid")
    parser.add_argument("--path", type=Path, metavar="CSV", help="draw a path: a file of two columns, x and z")
    add_page(parser)


def add_page(parser: argparse.ArgumentParser) -> None:
    """The options of every page."""
    parser.add_argument("--scene", type=Path, metavar="FILE", help="draw a mesh, a map, or a script with its scene")
    parser.add_argument("--character", type=Path, metavar="FILE", help="who is seen: your own character (.glb, .vrm)")
    parser.add_argument(
        "--host", default="127.0.0.1", metavar="ADDR", help="0.0.0.0 serves others, too (default: %(default)s)"
    )
    parser.add_argument("--port", type=int, default=8080, metavar="N", help="0 takes a free one (default: %(default)s)")
    parser.add_argument("--no-browser", action="store_true", help="only serve the page")


def run(arguments: argparse.Namespace) -> int:
    """Serve until Ctrl-C."""
    from motionrt.studio import open_viewer

    page = open_viewer(shown(arguments), host=arguments.host, port=arguments.port)
    return serve(page, arguments)


def shown(arguments: argparse.Namespace) -> Show:
    """What the arguments ask to show."""
    from motionrt.studio.showing import show_of

    found = show_of(
        arguments.clips,
        scene=arguments.scene,
        path=arguments.path,
        layout=arguments.layout,
        character=arguments.character,
    )
    for problem in found.problems:
        say(f"motionrt: left out: {problem}")
    return found


def serve(page: Page, arguments: argparse.Namespace) -> int:
    """Say where the page is, open it, and wait for Ctrl-C."""
    say(f"{page.url} (Ctrl-C ends it)")
    if arguments.host not in LOOPBACK:
        say(
            f"motionrt: {arguments.host} serves others, too: whoever reaches this machine and has the address with its "
            "token can use the page, without encryption. Give the address to nobody else"
        )
    if not arguments.no_browser:
        import webbrowser

        webbrowser.open(page.url)
    warnings.filterwarnings("ignore", message="Queued a .* on a closed connection")  # of windows that have just gone
    try:
        page.wait()
    except KeyboardInterrupt:
        say("")
    finally:
        page.stop()
    return 0
