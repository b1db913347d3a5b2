"""Between the :class:`~motionrt.retrieval.contents.Contents` of a gallery and what its folder holds; docs/scale.md."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from motionrt.motion.attributes import ATTRIBUTES
from motionrt.retrieval import segments as parts
from motionrt.retrieval import store
from motionrt.retrieval.column_file import Array, Pieces, column_writer
from motionrt.retrieval.contents import Contents
from motionrt.retrieval.first_layout import read_first
from motionrt.retrieval.head import model_of, reading_of, segments_of, sidecars_of, skipped_of, source_of
from motionrt.retrieval.reading import read_segment
from motionrt.retrieval.segments import CHECKED_AT_OPEN, CHECKED_AT_SEARCH, Segment
from motionrt.retrieval.vectors import PRECISIONS, Packed, Vectors, chunks, coded, scales_of
from motionrt.retrieval.words import Postings
from motionrt.untrusted import Fail
from motionrt.untrusted.words import shown

Table = tuple[Mapping[str, Array | Pieces], Mapping[str, str]]
"""Columns of a file, and its metadata."""


def save(gallery: Contents, folder: Path, segments: Sequence[Segment] | None = None) -> None:
    """Write the gallery's files; the caller holds the folder's lock.

    Args:
        gallery: whose facts are written.
        folder: where to.
        segments: those that the gallery has from now on, by default its own. What they have in the folder already is
            left as it is.
    """
    kept = [part for part in (gallery.segments if segments is None else segments) if part.clip_count]
    with store.writing_to(folder) as disk:
        written = [_written(disk, part, gallery.precision, folder) for part in kept]
        rows = [
            {"clips": len(part.clips), "windows": len(part.windows), "files": files}
            for part, files in zip(kept, written, strict=True)
        ]
        disk.commit(
            {**_facts(gallery, folder), "segments": rows}, {name for files in written for name in files.values()}
        )


def read(folder: Path) -> Contents:
    """The gallery of a folder that holds one; GalleryError when its parts do not fit together."""
    try:
        return _assembled(folder, store.read_head(folder))
    except FileNotFoundError:  # another process replaced the gallery just after its head was read
        pass
    try:
        return _assembled(folder, store.read_head(folder))
    except FileNotFoundError as error:
        raise store.damaged(folder, f"no file {error.filename}") from error


def verify(folder: Path) -> None:
    """Check every file of a gallery against its checksum, and what the motions say."""
    contents = _assembled(folder, store.read_head(folder))
    for part in contents.segments:
        store.verify(folder, dict(part.files))
        if part.pack is not None and len(part.pack) != len(part.clips):
            raise store.damaged(folder, "it holds another number of motions than of clips")


def is_current(contents: Contents) -> bool:
    """Whether a gallery on disk has the layout of today."""
    return all("windows" not in part.files for part in contents.segments)


def check_for_search(contents: Contents) -> None:
    """GalleryError if a part is damaged that a search needs; those beyond 256 MiB are left to :func:`verify`."""
    for part in contents.segments:
        part.check(CHECKED_AT_SEARCH)


def _assembled(folder: Path, head: dict[str, Any]) -> Contents:
    fail = store.fails(folder / store.GALLERY_FILE)
    first = head["version"] == store.OLDEST
    found = (
        [read_first(folder, head)]
        if first
        else [read_segment(folder, h) for h in segments_of(head.get("segments"), fail)]
    )
    for part in found:
        part.check(CHECKED_AT_OPEN)
    if len({part.vectors.shape[1] for part in found}) > 1:
        raise store.damaged(folder, "its segments have vectors of different widths")
    return Contents(
        clips=parts.clips_of(found),
        embeddings=parts.embeddings_of(found),
        windows=parts.windows_of(found),
        model=model_of(head.get("model"), fail),
        source=_source(folder, source_of(head.get("source"), fail)),
        skipped=skipped_of(head.get("skipped"), fail),
        reading=reading_of(head.get("mapping"), head.get("reading", {}), fail),
        motions=found[0].motions,
        folder=folder,
        neighbours=found[0].neighbours,
        attributes=parts.attributes_of(found),
        captions=parts.captions_of(found),
        precision=_precision(head.get("precision", "float32"), fail),
        sidecars=sidecars_of(head.get("sidecars", {}), fail),
        stored=tuple(found),
    )


def _precision(told: object, fail: Fail) -> str:
    if told not in PRECISIONS:
        raise fail(f"its precision is {shown(told)}", None)
    return str(told)


def _facts(gallery: Contents, folder: Path) -> dict[str, Any]:
    options = {
        name: value for name, value in asdict(gallery.reading).items() if name != "mapping" and value is not None
    }
    return {
        "model": asdict(gallery.model),
        "source": _noted_source(gallery.source, folder),
        "mapping": dict(gallery.mapping) if gallery.mapping else None,
        **({"reading": options} if options else {}),
        "precision": gallery.precision,
        "sidecars": {name: list(stamp) for name, stamp in gallery.sidecars.items()},
        "skipped": [asdict(skipped) for skipped in gallery.skipped],
    }


def _written(disk: store.Writing, part: Segment, precision: str, folder: Path) -> dict[str, str]:
    """The segment's files by role: those that are there, and now those that were not."""
    files = dict(part.files) if part.folder == folder and "windows" not in part.files else {}
    if not files:
        part.check(None, *part.files)  # what is copied must be what was written
    for role, (columns, told) in _tables(part, precision, set(files)).items():
        files[role] = disk.part(role, ".safetensors", column_writer(columns, told))
    if part.pack is not None and "motions" not in files:
        files["motions"] = disk.part("motions", ".npz", part.pack.write)
    return files


def _tables(part: Segment, precision: str, there: set[str]) -> dict[str, Table]:
    """Columns and metadata of the files by role, but for those that are there already."""
    tables: dict[str, Table] = {}
    if "clips" not in there:
        tables["clips"] = part.clips.columns(part.windows), {"ordered": "yes" if part.clips.ordered else "no"}
    if "embeddings" not in there:
        tables["embeddings"] = _embeddings(part.vectors, precision), {"precision": precision}
    if "attributes" not in there and part.attributes is not None:
        tables["attributes"] = (
            {"attributes": np.asarray(part.attributes, np.float32).T},
            {"names": " ".join(ATTRIBUTES)},
        )
    if "captions" not in there and len(part.captions):
        tables["captions"] = part.captions.columns(), {}
    if "words" not in there:
        words = part.postings or Postings.of(part.clips, part.windows, part.captions)
        tables["words"] = words.columns(), {}
    if "deleted" not in there and len(part.deleted):
        tables["deleted"] = {"clips": part.deleted.astype(np.uint32)}, {}
    return tables


def _embeddings(vectors: Vectors, precision: str) -> Mapping[str, Array | Pieces]:
    if isinstance(vectors, Packed) and vectors.precision == precision:
        return {"vectors": vectors.numbers} | ({} if vectors.scales is None else {"scales": vectors.scales})
    kind = np.dtype(precision)
    if precision != "int8":
        return {"vectors": Pieces(kind, vectors.shape, lambda: (piece.astype(kind) for piece in chunks(vectors)))}
    scales = np.concatenate([scales_of(piece) for piece in chunks(vectors)])
    ends = np.cumsum([0, *(len(piece) for piece in chunks(vectors))])
    numbers = (coded(piece, scales[a : a + len(piece)]) for a, piece in zip(ends, chunks(vectors), strict=False))
    return {"vectors": Pieces(kind, vectors.shape, lambda: numbers), "scales": scales}


def _noted_source(source: Path | None, folder: Path) -> str | None:
    """Relative when the gallery lies inside the indexed folder, so that both can move; else absolute."""
    if source is None:
        return None
    source, folder = source.resolve(), folder.resolve()
    if folder.is_relative_to(source):
        return Path(os.path.relpath(source, folder)).as_posix()
    return source.as_posix()


def _source(folder: Path, noted: str | None) -> Path | None:
    return None if noted is None else Path(os.path.normpath(folder.absolute() / noted))
