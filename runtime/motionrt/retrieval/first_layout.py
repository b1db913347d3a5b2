"""Galleries of the first version: all clips in ``gallery.json``, arrays as ``.npy``. They are read, never written."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from motionrt.motion.attributes import ATTRIBUTES
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval import store
from motionrt.retrieval.caption_table import CaptionTable
from motionrt.retrieval.clip_table import ClipTable
from motionrt.retrieval.head import array_files, captions_of, clips_of
from motionrt.retrieval.reading import check_windows
from motionrt.retrieval.records import WINDOW_TYPE
from motionrt.retrieval.segments import Segment


def read_first(folder: Path, head: dict[str, Any]) -> Segment:
    """The gallery as one segment; FileNotFoundError where a file is gone, GalleryError where it is damaged."""
    fail = store.fails(folder / store.GALLERY_FILE)
    files = array_files(head.get("files"), fail)
    clips = clips_of(head.get("clips"), fail)
    embeddings, windows = (store.read_array(folder, files[role]) for role in ("embeddings", "windows"))
    if embeddings.dtype != np.float32 or embeddings.ndim != 2 or windows.dtype != WINDOW_TYPE:
        raise store.damaged(folder, "an array has the wrong type")
    if windows.ndim != 1 or len(embeddings) != len(windows):
        raise store.damaged(folder, "clips, windows and embeddings do not fit together")
    check_windows(windows, len(clips), folder)
    return Segment(
        ClipTable.of(clips),
        windows,
        embeddings,
        _attributes(folder, head, files, len(windows)),
        CaptionTable.of(captions_of(head.get("captions", []), fail), [clip.id for clip in clips]),
        folder / files["motions"] if "motions" in files else None,
        folder=folder,
        files={role: name for role, name in files.items() if role != "words"},  # which are found again
        neighbours=folder / store.neighbours_name(files["embeddings"]),
    )


def _attributes(folder: Path, head: dict[str, Any], files: dict[str, str], windows: int) -> FloatArray | None:
    """Attributes ``(W, A)``; None of a gallery that has none, or those of another version of motionrt."""
    if head.get("attributes") != list(ATTRIBUTES) or "attributes" not in files:
        return None
    found = store.read_array(folder, files["attributes"])
    if found.shape != (windows, len(ATTRIBUTES)) or found.dtype.kind != "f":
        raise store.damaged(folder, "windows and attributes do not fit together")
    return found
