"""A segment out of the files of a gallery's folder, memory-mapped, with all that strangers may have written checked."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from motionrt.motion.attributes import ATTRIBUTES
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval import store
from motionrt.retrieval.caption_table import CaptionTable
from motionrt.retrieval.clip_table import clips_of_columns
from motionrt.retrieval.head import SegmentHead
from motionrt.retrieval.records import WindowTable
from motionrt.retrieval.segments import Segment
from motionrt.retrieval.strings import Strings
from motionrt.retrieval.vectors import Packed, Vectors
from motionrt.retrieval.words import Postings
from motionrt.untrusted.safetensors import Columns, checked, read_columns


def read_segment(folder: Path, head: SegmentHead) -> Segment:
    """The segment that the head of a gallery tells of; FileNotFoundError where a file is gone."""
    files = head.files
    columns, told = _columns(folder, files["clips"])
    clips, windows = clips_of_columns(columns, told.get("ordered") == "yes", store.fails(folder / files["clips"]))
    vectors = _vectors(folder, files["embeddings"])
    check_windows(windows, len(clips), folder)
    if (len(clips), len(windows), len(vectors)) != (head.clips, head.windows, head.windows):
        raise store.damaged(folder, "clips, windows and embeddings do not fit together")
    return Segment(
        clips,
        windows,
        vectors,
        _attributes(folder, files.get("attributes"), len(windows)),
        _captions(folder, files.get("captions"), clips.ids),
        folder / files["motions"] if "motions" in files else None,
        _deleted(folder, files.get("deleted"), len(clips)),
        folder,
        files,
        folder / store.neighbours_name(files["embeddings"]),
        _postings(folder, files.get("words"), len(windows)),
    )


def check_windows(windows: WindowTable, clips: int, folder: Path) -> None:
    """GalleryError unless every clip has windows, in order, and every window is a span of seconds."""
    owners, start, end = windows["clip"], windows["start_s"], windows["end_s"]
    if not clips or not _all_named(owners, clips):
        raise store.damaged(folder, "clips, windows and embeddings do not fit together")
    with np.errstate(invalid="ignore"):
        if not ((start >= 0) & (start <= end) & (end < np.inf)).all():
            raise store.damaged(folder, "a window has no beginning or no end")


def _all_named(owners: npt.NDArray[np.int32], clips: int) -> bool:
    """Whether these are the numbers of all clips in order, and no others."""
    if not len(owners) or owners[0] != 0 or owners[-1] != clips - 1:
        return False
    steps = owners[1:] - owners[:-1]
    return bool(((steps == 0) | (steps == 1)).all())


def _columns(folder: Path, name: str) -> tuple[Columns, dict[str, str]]:
    return read_columns(folder / name, store.fails(folder / name))


def _vectors(folder: Path, name: str) -> Vectors:
    columns, _ = _columns(folder, name)
    found, scales = columns.get("vectors"), columns.get("scales")
    if found is None or found.ndim != 2 or found.dtype not in (np.float32, np.float16, np.int8):
        raise store.damaged(folder / name, "it has no vectors")
    if found.dtype == np.float32:
        vectors: FloatArray = found
        return vectors
    if found.dtype == np.float16:
        return Packed(found)
    checked(columns, {"scales": ("F32", (len(found),))}, store.fails(folder / name))
    return Packed(found, scales)


def _attributes(folder: Path, name: str | None, windows: int) -> FloatArray | None:
    """Attributes ``(W, A)``; None of a segment that has none, or those of another version of motionrt."""
    if name is None:
        return None
    columns, told = _columns(folder, name)
    if told.get("names") != " ".join(ATTRIBUTES):
        return None
    column = checked(columns, {"attributes": ("F32", (len(ATTRIBUTES), windows))}, store.fails(folder / name))
    table: FloatArray = column("attributes").T
    return table


def _captions(folder: Path, name: str | None, ids: Strings) -> CaptionTable:
    if name is None:
        return CaptionTable.of((), ids)
    return CaptionTable.of_columns(_columns(folder, name)[0], ids, store.fails(folder / name))


def _postings(folder: Path, name: str | None, windows: int) -> Postings | None:
    return None if name is None else Postings.of_columns(_columns(folder, name)[0], windows, store.fails(folder / name))


def _deleted(folder: Path, name: str | None, clips: int) -> npt.NDArray[np.uint32]:
    if name is None:
        return np.zeros(0, np.uint32)
    found = checked(_columns(folder, name)[0], {"clips": ("U32", (None,))}, store.fails(folder / name))("clips")
    if not len(found) or found[-1] >= clips or bool((found[1:] <= found[:-1]).any()) or len(found) == clips:
        raise store.damaged(folder / name, "it deletes clips that there are not")
    return found
