"""``motionrt web``: the models in the page, from static files."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from motionrt.cli.console import say
from motionrt.cli.options import add_models, command, runtime

EXPORT = """write the folder that a page with motionrt-web loads: models, tokenizer, galleries, pages
Any static server serves it; nothing is computed there."""
SERVE = """serve such a folder on this machine
Ctrl-C ends it."""


def add(commands: Any) -> None:
    """Add the command."""
    group = commands.add_parser("web", help="the models in the page, from static files")
    parts = group.add_subparsers(title="commands", metavar="COMMAND", required=True)
    writer = command(parts, "export", run_export, EXPORT)
    writer.add_argument("folder", type=Path, metavar="DIR", help="folder to write")
    writer.add_argument("--pages", type=Path, metavar="DIR", help="built pages to copy, as integrations/web/dist/demo")
    writer.add_argument(
        "--gallery", action="append", default=[], metavar="NAME=DIR", help="take this gallery along; repeatable"
    )
    kind = writer.add_mutually_exclusive_group()
    kind.add_argument("--exact", action="store_true", help="the same walks on every machine; slower by half")
    kind.add_argument("--native", action="store_true", help="for Node.js with onnxruntime-node: files as shipped")
    add_models(writer)
    server = command(parts, "serve", run_serve, SERVE)
    server.add_argument("folder", type=Path, metavar="DIR", help="what 'motionrt web export' wrote")
    server.add_argument("--host", default="127.0.0.1", metavar="ADDR", help="(default: %(default)s)")
    server.add_argument("--port", type=int, default=8322, metavar="N", help="(default: %(default)s)")


def run_export(arguments: argparse.Namespace) -> int:
    """Write the folder."""
    from motionrt.errors import InvalidInputError
    from motionrt.web import write_folder

    opened = runtime(arguments)
    galleries = {"starter": opened.gallery()}
    for given in arguments.gallery:
        name, _, folder = given.partition("=")
        if not name.isidentifier() or not folder:
            raise InvalidInputError(f"--gallery takes NAME=DIR, with a plain name, not {given!r}")
        galleries[name] = opened.gallery(folder)
    told = {name: getattr(arguments, name) for name in ("models", "pages", "exact", "native")}
    print(write_folder(arguments.folder, galleries, **told))
    return 0


def run_serve(arguments: argparse.Namespace) -> int:
    """Serve until Ctrl-C."""
    from motionrt.web import page_server

    with page_server(arguments.folder, arguments.host, arguments.port) as server:
        say(f"motionrt: http://{arguments.host}:{server.server_address[1]}/")
        server.serve_forever()
    return 0
