"""A contact sheet: every clip of a gallery as a strip of poses, in one HTML file that needs nothing else."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from motionrt.formats.atomic import write_atomically
from motionrt.untrusted.arguments import check_functions
from motionrt.untrusted.files import as_path

if TYPE_CHECKING:
    from motionrt.retrieval.gallery import Gallery

_STYLE = (
    "body{font:14px sans-serif;margin:1.5em;background:#fafafa;color:#222}"
    "div{overflow-wrap:anywhere}.clip{display:inline-block;vertical-align:top;margin:0 1em 1.2em 0;max-width:900px}"
)


def save_sheet(gallery: Gallery, path: str | Path, progress: Callable[[int, int, str], None] | None = None) -> Path:
    """Write the contact sheet of a gallery, whole or not at all; returns the path.

    Clips stand in the order of their ids, each with its length; those whose files cannot be read say why.

    Args:
        gallery: whose clips are drawn.
        path: the file (.html).
        progress: called with clips done, clips in all and the clip's id.

    Raises:
        InvalidInputError: the file cannot be written.
    """
    check_functions(progress=progress)
    return write_atomically(as_path(path), lambda file: file.writelines(_lines(gallery, progress)))


def _lines(gallery: Gallery, progress: Callable[[int, int, str], None] | None) -> Iterator[bytes]:
    title = escape(repr(gallery))
    head = f'<!DOCTYPE html><meta charset="utf-8"><title>{title}</title><style>{_STYLE}</style>'
    yield f"{head}<h1>{title}</h1>\n".encode()
    for number, clip in enumerate(gallery.clips):
        if progress is not None:
            progress(number, len(gallery), clip.id)
        drawn = f'<div class="clip">{gallery.sketch(clip.id)}<div>{clip.duration_s:.1f} s</div></div>\n'
        yield drawn.encode(errors="replace")
    if progress is not None:
        progress(len(gallery), len(gallery), "")
