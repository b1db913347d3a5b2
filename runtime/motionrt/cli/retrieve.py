"""``motionrt retrieve``: motions that fit a text."""

from __future__ import annotations

import argparse
from typing import Any

from motionrt.cli.console import say, working
from motionrt.cli.hits import add_filters, add_output, outcome, read_filter, show
from motionrt.cli.options import add_json, add_models, add_text_tower, command, runtime

HELP = """find the motions of a gallery that fit a text
Without --gallery the small starter gallery is searched that comes with motionrt."""


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "retrieve", run, HELP)
    parser.add_argument("text", help="a sentence, as in 'a person walks in a circle'")
    parser.add_argument(
        "--gallery", metavar="DIR", help="a gallery, or the folder that was indexed; or the address of a database"
    )
    parser.add_argument("-k", type=int, default=10, metavar="N", help="how many hits (default: 10)")
    parser.add_argument("--windows", action="store_true", help="every 10 s window is a hit, not the best of a clip")
    parser.add_argument("--approximate", action="store_true", help="faster on galleries of 50,000 windows and more")
    parser.add_argument(
        "--embedding-only", action="store_true", help="rank by the model alone: no attributes, no words"
    )
    parser.add_argument("--anyway", action="store_true", help="search even where no word of the text is known")
    add_filters(parser)
    add_output(parser)
    add_json(parser)
    add_models(parser)
    add_text_tower(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print the hits, save and draw them when asked to."""
    from motionrt.engines import is_address
    from motionrt.retrieval import EMBEDDING_ONLY, Gallery

    opened = runtime(arguments)
    gallery = arguments.gallery if is_address(arguments.gallery) else opened.gallery(arguments.gallery)
    with working("searching"):
        hits = opened.retrieve(
            arguments.text,
            arguments.k,
            gallery,
            per_clip=not arguments.windows,
            approximate=arguments.approximate,
            weights=EMBEDDING_ONLY if arguments.embedding_only else None,
            filter=read_filter(arguments),
            anyway=arguments.anyway,
        )
    show(hits, gallery if isinstance(gallery, Gallery) else None, arguments)
    if hits.notice:
        say(f"motionrt: {hits.notice}")
    return outcome(hits, arguments)
