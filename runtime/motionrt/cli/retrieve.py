"""``motionrt retrieve``: motions that fit a text."""

from __future__ import annotations

import argparse
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionrt.cli.console import print_json, print_table, say
from motionrt.cli.options import add_json, add_models, command, runtime

if TYPE_CHECKING:
    from motionrt.retrieval import Gallery, Hit
    from motionrt.runtime import Runtime

HELP = """find the motions of a gallery that fit a text
Without --gallery the small starter gallery is searched that comes with motionrt."""


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "retrieve", run, HELP)
    parser.add_argument("text", help="a sentence, as in 'a person walks in a circle'")
    parser.add_argument("--gallery", type=Path, metavar="DIR", help="a gallery, or the folder that was indexed")
    parser.add_argument("-k", type=int, default=10, metavar="N", help="how many hits (default: 10)")
    parser.add_argument("--windows", action="store_true", help="every 10 s window is a hit, not the best of a clip")
    parser.add_argument("--approximate", action="store_true", help="faster on galleries of 50,000 windows and more")
    parser.add_argument("--save", type=Path, metavar="DIR", help="write the hits there as BVH")
    add_json(parser)
    add_models(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print the hits, and save them when asked to."""
    opened = runtime(arguments)
    gallery = opened.gallery(arguments.gallery)
    hits = _hits(opened, gallery, arguments)
    if arguments.json:
        print_json([as_json(hit) for hit in hits])
    else:
        _print(hits)
    if arguments.save is not None:
        _save(hits, gallery, arguments.save)
    return 0


def _hits(opened: Runtime, gallery: Gallery, arguments: argparse.Namespace) -> list[Hit]:
    per_clip = not arguments.windows
    if not arguments.approximate:
        return opened.retrieve(arguments.text, arguments.k, gallery, per_clip=per_clip)
    gallery.check_model(opened.model.fingerprint, opened.model.name)
    query = opened.embed_text(arguments.text)
    return gallery.search(query, arguments.k, per_clip=per_clip, approximate=True)


def as_json(hit: Hit) -> dict[str, object]:
    """What ``--json`` says of a hit; times are seconds, ``path`` is null for a motion that is not a file."""
    return {
        "rank": hit.rank,
        "score": round(hit.score, 6),
        "id": hit.id,
        "path": None if hit.path is None else str(hit.path),
        "start": round(hit.start_s, 3),
        "end": round(hit.end_s, 3),
        "text": hit.text,
    }


def _print(hits: list[Hit]) -> None:
    texts = any(hit.text for hit in hits)
    header = ["rank", "score", "start", "end", "clip", *(["text"] if texts else [])]
    rows = [
        [str(hit.rank), f"{hit.score:.3f}", f"{hit.start_s:.1f}", f"{hit.end_s:.1f}", hit.id]
        + ([hit.text or ""] if texts else [])
        for hit in hits
    ]
    print_table(header, rows, ">>>><<"[: len(header)])


def _save(hits: list[Hit], gallery: Gallery, folder: Path) -> None:
    from motionrt.errors import InvalidInputError

    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InvalidInputError(f"cannot make the folder {folder}: {error.strerror}") from error
    for hit in hits:
        gallery.motion(hit).save(folder / _file_name(hit))
    say(f"saved {len(hits)} motions in {folder}")


def _file_name(hit: Hit) -> str:
    """Rank, clip and span, in letters that every file system takes."""
    stem = re.sub(r"\.(bvh|amc|npz)$", "", hit.id, flags=re.IGNORECASE)
    plain = re.sub(r"[^\w.-]+", "_", stem.replace("/", "__")).encode()[:150].decode(errors="ignore")
    return f"{hit.rank:03d}_{plain}_{hit.start_s:.1f}-{hit.end_s:.1f}s.bvh"
