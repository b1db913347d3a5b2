"""``motionrt serve`` and ``motionrt mcp``: the verbs for other programs and for assistants."""

from __future__ import annotations

import argparse
import os
import secrets
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionrt.cli.console import say
from motionrt.cli.options import add_models, command, runtime

if TYPE_CHECKING:
    from motionrt.serving import Desk

TOKEN = "MOTIONRT_TOKEN"
HELP = f"""serve search, description, generation, composition, walks and conversion over HTTP
Programs send the token that is printed, or that {TOKEN} holds: Authorization: Bearer TOKEN. /openapi.json describes all
requests, /metrics counts them, /v1/walk is a WebSocket. Ctrl-C ends it. Needs the extra serve."""
MCP = """serve the same verbs to an assistant (Model Context Protocol), over stdin and stdout
Motions are written into --folder, and files are read there alone. Needs the extra mcp."""


def add(commands: Any) -> None:
    """Add the commands."""
    parser = command(commands, "serve", run, HELP)
    parser.add_argument(
        "--host", default="127.0.0.1", metavar="ADDR", help="0.0.0.0 serves others, too (default: %(default)s)"
    )
    parser.add_argument("--port", type=int, default=8321, metavar="N", help="default: %(default)s")
    parser.add_argument(
        "--origin", action="append", default=[], metavar="URL", help="a web page that may ask; repeatable"
    )
    parser.add_argument("--active", type=int, default=2, metavar="N", help="requests at once (default: %(default)s)")
    parser.add_argument("--no-token", action="store_true", help="let everybody in who reaches the port")
    assistant = command(commands, "mcp", run_mcp, MCP)
    assistant.add_argument(
        "--folder", type=Path, default=Path("motionrt-motions"), metavar="DIR", help="for files (default: %(default)s)"
    )
    for one in (parser, assistant):
        one.add_argument(
            "--gallery", action="append", default=[], metavar="[NAME=]DIR", help="serve this gallery; repeatable"
        )
        add_models(one)


def run(arguments: argparse.Namespace) -> int:
    """Serve until Ctrl-C."""
    from motionrt.errors import InvalidInputError

    if arguments.active < 1 or not 0 <= arguments.port < 65536:
        raise InvalidInputError("--active is a number from 1, --port one from 0 to 65535")
    serving = _serving("serve", ("fastapi", "uvicorn"))
    token = None if arguments.no_token else os.environ.get(TOKEN) or secrets.token_urlsafe(24)
    app = serving.make_app(_desk(arguments), token=token, origins=arguments.origin, active=arguments.active)
    say(f"motionrt: http://{arguments.host}:{arguments.port}/openapi.json")
    if token is None:
        say("motionrt: no token: whoever reaches the port may ask")
    elif TOKEN not in os.environ:
        say(f"motionrt: token {token}")
    if arguments.host not in ("127.0.0.1", "localhost", "::1"):
        say(f"motionrt: {arguments.host} serves others, too, unencrypted: put a proxy with TLS before it")
    serving.serve(app, host=arguments.host, port=arguments.port)
    return 0


def run_mcp(arguments: argparse.Namespace) -> int:
    """Serve until the assistant goes."""
    _serving("mcp", ("mcp",)).make_assistant(_desk(arguments), arguments.folder.resolve()).run()
    return 0


def _desk(arguments: argparse.Namespace) -> Desk:
    """The runtime with the galleries that were named, all of which open."""
    from motionrt.serving import Desk

    named: dict[str, Path | None] = {}
    for given in arguments.gallery:
        name, found, folder = given.partition("=")
        path = Path(folder if found else given)
        named[name if found else path.resolve().name] = path
    desk = Desk(runtime(arguments), named) if named else Desk(runtime(arguments))
    for name in desk.galleries:
        desk.gallery(name)  # complain now
    return desk


def _serving(extra: str, modules: tuple[str, ...]) -> Any:
    """The package, if its extra is installed."""
    import importlib.util

    from motionrt import serving
    from motionrt.errors import MissingDependencyError

    missing = [name for name in modules if importlib.util.find_spec(name) is None]
    if missing:
        raise MissingDependencyError(f'{", ".join(missing)} is not installed: pip install "motionrt[{extra}]"')
    return serving
