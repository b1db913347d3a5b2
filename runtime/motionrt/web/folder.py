"""The folder that a page loads: ``models.json``, the models, the tokenizer, and galleries in plain arrays."""

from __future__ import annotations

import hashlib
import json
import shutil
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.models import Manifest, find_manifest, load_manifest
from motionrt.models.checks import verified
from motionrt.motion import Motion
from motionrt.motion.rotations import matrix_to_quaternion
from motionrt.retrieval import Gallery
from motionrt.web.blocks import unfolded

MODELS = ("walknet", "tmr_text", "motion_denoiser", "tmr_student")
"""The models that a page may load; each is loaded when it is first needed."""
VERSION = 1

Change = Callable[[bytes], bytes]
"""A model's content as it is written, out of that which is shipped."""


def write_folder(
    out: str | Path,
    galleries: Mapping[str, Gallery],
    *,
    models: str | Path | None = None,
    pages: str | Path | None = None,
    only: Sequence[str] = MODELS,
    exact: bool = False,
    native: bool = False,
) -> Path:
    """Write everything that a page needs, below ``out``; what is there under the same names is replaced.

    Args:
        out: the folder, made where it is missing.
        galleries: name -> gallery; those that carry their motions bring them along.
        models: manifest or folder of the models, by default the shipped ones.
        pages: a folder of built pages, copied beside; None leaves pages out.
        only: which models.
        exact: files whose activations are float32. Walks and motions are then those that another machine makes of the
            same files, within 1e-3; quantised ones drift apart after some frames, and take two thirds of the time.
        native: files as they are shipped, for Node.js with onnxruntime-node, which computes products by 8-bit blocks
            itself; in WebAssembly texts take longer with them.

    Returns:
        ``out`` as a path.

    Raises:
        InvalidInputError: an unknown model, pages that are not there, a folder that cannot be written, or files that
            are to be both exact and native.
        ModelFileError, ChecksumError: a model's file is missing, or not the one that the manifest means.
    """
    if exact and native:
        raise InvalidInputError("files are exact or native, not both: native ones are those that are shipped")
    manifest, folder = load_manifest(find_manifest(models)), Path(out)
    kept: Change = _as_shipped if native else partial(unfolded, exact=exact)
    if unknown := sorted(set(only) - set(manifest.models)):
        raise InvalidInputError(f"unknown model {', '.join(unknown)}; there are: {', '.join(manifest.models)}")
    if pages is not None and not (Path(pages) / "index.html").is_file():
        raise InvalidInputError(f"{pages} holds no index.html; build the pages: cd integrations/web && npm run demo")
    try:
        (folder / "models").mkdir(parents=True, exist_ok=True)
        entries = {name: _model(manifest, name, folder, kept) for name in only}
        _tokenizer(manifest, folder)
        for name, gallery in galleries.items():
            _gallery(gallery, folder / "galleries" / name)
        if pages is not None:
            shutil.copytree(pages, folder, dirs_exist_ok=True)
        _json(folder / "models.json", {"version": _version(entries), "models": entries, "galleries": [*galleries]})
    except OSError as error:
        raise InvalidInputError(f"cannot write {error.filename or folder}: {error.strerror or error}") from error
    return folder


def _as_shipped(model: bytes) -> bytes:
    return model


def _model(manifest: Manifest, name: str, folder: Path, change: Change) -> dict[str, Any]:
    variant = manifest.variant(name)
    content = change(verified(manifest, variant))
    file = f"models/{Path(variant.file).name}"
    (folder / file).write_bytes(content)
    return {"file": file, "bytes": len(content), "sha256": hashlib.sha256(content).hexdigest()}


def _tokenizer(manifest: Manifest, folder: Path) -> None:
    found = next(model.tokenizer for model in manifest.models.values() if model.tokenizer is not None)
    shutil.copyfile(manifest.locate(found.file), folder / "tokenizer.json")


def _version(entries: Mapping[str, Mapping[str, Any]]) -> str:
    """Changes with any model, so that what a browser keeps is never another's."""
    return hashlib.sha256("".join(str(entry["sha256"]) for entry in entries.values()).encode()).hexdigest()[:12]


def _gallery(gallery: Gallery, folder: Path) -> None:
    """``gallery.json``, ``embeddings.npy`` ``(W, 256)`` float32, and ``clips/N.npy`` for motions it carries."""
    folder.mkdir(parents=True, exist_ok=True)
    np.save(folder / "embeddings.npy", np.ascontiguousarray(gallery.embeddings, dtype=np.float32))
    windows = [[int(row["clip"]), float(row["start_s"]), float(row["end_s"])] for row in gallery.windows]
    clips = [{"id": clip.id, "text": clip.text or "", "seconds": clip.duration_s} for clip in gallery.clips]
    carried = gallery.motions is not None
    _json(folder / "gallery.json", {"version": VERSION, "clips": clips, "windows": windows, "motions": carried})
    if carried:
        (folder / "clips").mkdir(exist_ok=True)
        for number, clip in enumerate(gallery.clips):
            np.save(folder / "clips" / f"{number}.npy", motion_rows(gallery.motion(clip.id).resample(30.0)))


def motion_rows(motion: Motion) -> np.ndarray[Any, np.dtype[np.float32]]:
    """``(F, 99)`` float32: the pelvis in metres, then 24 quaternions wxyz."""
    quaternions = matrix_to_quaternion(motion.rotations).reshape(motion.frames, -1)
    return np.concatenate([motion.root, quaternions], axis=1).astype(np.float32)


def _json(path: Path, value: Any) -> None:
    path.write_text(json.dumps(value, ensure_ascii=False, separators=(",", ":")) + "\n", encoding="utf-8")
