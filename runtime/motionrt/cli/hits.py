"""Hits on the command line: tables, JSON, files and pictures; and the options that filter a search."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from motionrt.cli.console import complain, print_json, print_table, say
from motionrt.errors import InvalidInputError

if TYPE_CHECKING:
    from motionrt.retrieval import Filter, Gallery, Hit
    from motionrt.retrieval.saving import Saved

NOTHING_FOUND = 1
_CAPTION = 60  # letters of a caption in a table


def add_output(parser: argparse.ArgumentParser) -> None:
    """Options for what to do with hits."""
    parser.add_argument(
        *("-o", "--save"),
        type=Path,
        metavar="DIR",
        help="write the hits there: the original rig, cut to the hit",
    )
    parser.add_argument(
        "--pictures", type=Path, metavar="FILE", help="draw the hits, one strip each (.png; extra render)"
    )


def add_filters(parser: argparse.ArgumentParser) -> None:
    """Options that leave motions out."""
    parser.add_argument("--where", metavar="CONDITION", help="on attributes, as in 'turn > 60 and speed < 1.5'")
    parser.add_argument("--min-seconds", type=float, metavar="S", help="only clips of at least so many seconds")
    parser.add_argument("--max-seconds", type=float, metavar="S", help="only clips of at most so many seconds")
    parser.add_argument("--folder", metavar="NAME", help="only clips below this folder of the library")
    parser.add_argument(
        "--tag", action="append", default=[], metavar="TAG", help="only clips with this tag; repeatable"
    )
    parser.add_argument("--words", metavar="WORDS", help="only motions whose captions, tags or names have these words")


def read_filter(arguments: argparse.Namespace) -> Filter:
    """The filter that the options ask for."""
    from motionrt.retrieval import Filter

    return Filter(
        arguments.where,
        arguments.min_seconds,
        arguments.max_seconds,
        arguments.folder,
        tuple(arguments.tag),
        arguments.words,
    )


def show(hits: Sequence[Hit], gallery: Gallery | None, arguments: argparse.Namespace) -> None:
    """Print the hits, write them and draw them as the options say; a database holds no motion to write or draw."""
    if gallery is None and (arguments.save is not None or arguments.pictures is not None):
        raise InvalidInputError("a database holds no motions: --save and --pictures need the gallery itself")
    if arguments.json:
        print_json([as_json(hit) for hit in hits])
    elif hits:
        from motionrt.retrieval import grouped

        _print([hit for group in grouped(hits) for hit in group])
    if gallery is not None and arguments.save is not None and hits:
        _save(hits, gallery, arguments.save)
    if gallery is not None and arguments.pictures is not None and hits:
        _draw(hits, gallery, arguments.pictures)


def outcome(hits: Sequence[Hit], arguments: argparse.Namespace) -> int:
    """The exit code: 1 where hits were to be saved or drawn, and there are none."""
    wanted = [
        f"{name} {given}" for name, given in (("--save", arguments.save), ("--pictures", arguments.pictures)) if given
    ]
    return 0 if hits else nothing_written(wanted)


def nothing_written(wanted: Sequence[str]) -> int:
    """Say which options write nothing, since nothing was found; the exit code: 1 where there are some."""
    if not wanted:
        return 0
    complain(f"motionrt: error: nothing was found, so nothing is written for {' and '.join(wanted)}")
    return NOTHING_FOUND


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
        "cosine": None if hit.cosine is None else round(hit.cosine, 6),
        "agreement": None if hit.agreement is None else round(hit.agreement, 6),
    }


def _print(hits: Sequence[Hit]) -> None:
    fits, texts = any(hit.agreement is not None for hit in hits), any(hit.text for hit in hits)
    header = ["rank", "score", *(["fits"] if fits else []), "start", "end", "clip", *(["text"] if texts else [])]
    rows = [
        [str(hit.rank), f"{hit.score:.3f}"]
        + ([f"{hit.agreement:.2f}" if hit.agreement is not None else ""] if fits else [])
        + [f"{hit.start_s:.1f}", f"{hit.end_s:.1f}", hit.id]
        + ([(hit.text or "")[:_CAPTION]] if texts else [])
        for hit in hits
    ]
    print_table(header, rows, ">" * (4 + fits) + "<<"[: 1 + texts])


def _save(hits: Sequence[Hit], gallery: Gallery, folder: Path) -> None:
    from motionrt.retrieval.saving import save_hits

    tell_saved(save_hits(gallery, hits, folder), folder)


def tell_saved(saved: Sequence[Saved], folder: Path) -> None:
    """Name the files that were written."""
    for file in saved:
        say(f"{file.path}: {file.what}")
    say(f"saved {len(saved)} {'motion' if len(saved) == 1 else 'motions'} in {folder}")


def _draw(hits: Sequence[Hit], gallery: Gallery, path: Path) -> None:
    from motionrt.rendering import render

    captions = [f"{hit.rank}  {hit.text or hit.id}  {hit.start_s:.1f}-{hit.end_s:.1f} s" for hit in hits]
    written = render([gallery.motion(hit) for hit in hits], path, captions=captions)
    say(f"drew {len(hits)} motions in {written}")
