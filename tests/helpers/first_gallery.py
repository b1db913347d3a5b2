"""Galleries as the first motionrt wrote them: everything about clips in ``gallery.json``, arrays as ``.npy``."""

from __future__ import annotations

import hashlib
import io
import json
import os
from dataclasses import asdict
from pathlib import Path

import numpy as np

from motionrt.motion.attributes import ATTRIBUTES
from motionrt.retrieval import Gallery


def write_first(gallery: Gallery, folder: Path, *, attributes: bool = True) -> Path:
    """Write a gallery so, in place of what is in the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for path in folder.iterdir():
        path.unlink()
    arrays = {"embeddings": np.asarray(gallery.embeddings), "windows": np.asarray(gallery.windows)}
    if attributes:
        arrays["attributes"] = np.ascontiguousarray(gallery.attributes)
    files = {role: _write(folder, role, array) for role, array in arrays.items()}
    if gallery.pack is not None:
        content = io.BytesIO()
        gallery.pack.write(content)
        files["motions"] = _named(folder, "motions", ".npz", content.getvalue())
    head = {
        "format": "motionrt-gallery",
        "version": 1,
        "model": asdict(gallery.model),
        "source": None if gallery.source is None else Path(os.path.relpath(gallery.source, folder)).as_posix(),
        "mapping": gallery.mapping,
        "clips": [asdict(clip) for clip in gallery.clips],
        "skipped": [asdict(skipped) for skipped in gallery.skipped],
        **({"attributes": list(ATTRIBUTES)} if attributes else {}),
        "captions": [asdict(caption) for caption in gallery.captions],
        "files": files,
    }
    (folder / "gallery.json").write_text(json.dumps(head), encoding="utf-8")
    return folder


def _write(folder: Path, role: str, array: np.ndarray) -> str:
    content = io.BytesIO()
    np.save(content, array)
    return _named(folder, role, ".npy", content.getvalue())


def _named(folder: Path, role: str, suffix: str, content: bytes) -> str:
    name = f"{role}-{hashlib.sha256(content).hexdigest()[:16]}{suffix}"
    (folder / name).write_bytes(content)
    return name
