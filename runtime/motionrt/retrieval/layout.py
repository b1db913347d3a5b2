"""Between the :class:`~motionrt.retrieval.contents.Contents` of a gallery and what its folder holds."""

from __future__ import annotations

import os
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import IO, Any

import numpy as np
import numpy.typing as npt

from motionrt.motion.attributes import ATTRIBUTES
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval import store
from motionrt.retrieval.contents import Contents
from motionrt.retrieval.records import WINDOW_TYPE, Caption, Clip, ModelStamp, Skipped, WindowTable
from motionrt.retrieval.words import WordIndex


def save(gallery: Contents, folder: Path) -> None:
    """Write the gallery's files; the caller holds the folder's lock."""
    arrays: dict[str, tuple[str, store.Writer]] = {
        "embeddings": (".npy", partial(_write_npy, array=gallery.embeddings)),
        "windows": (".npy", partial(_write_npy, array=gallery.windows)),
    }
    if gallery.attributes is not None:
        arrays["attributes"] = (".npy", partial(_write_npy, array=gallery.attributes))
    words = WordIndex.of(gallery.clips, gallery.windows, gallery.captions)
    arrays["words"] = (".npz", words.write)
    pack = gallery.pack
    if pack is not None:
        arrays["motions"] = (".npz", pack.write)
    store.write(folder, _head(gallery, folder), arrays)


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


def _assembled(folder: Path, head: dict[str, Any]) -> Contents:
    try:
        contents = _read(folder, head)
    except (KeyError, TypeError, AttributeError) as error:
        raise store.damaged(folder / store.GALLERY_FILE, f"{type(error).__name__}: {error}") from error
    _check(contents.embeddings, contents.windows, len(contents.clips), folder)
    if contents.attributes is not None and contents.attributes.shape != (len(contents.windows), len(ATTRIBUTES)):
        raise store.damaged(folder, "windows and attributes do not fit together")
    return contents


def _read(folder: Path, head: dict[str, Any]) -> Contents:
    files = head["files"]
    return Contents(
        clips=tuple(Clip(**clip) for clip in head["clips"]),
        embeddings=store.read_array(folder, files["embeddings"]),
        windows=store.read_array(folder, files["windows"]),
        model=ModelStamp(**head["model"]),
        source=_source(folder, head["source"]),
        skipped=tuple(Skipped(**skipped) for skipped in head["skipped"]),
        mapping=head["mapping"],
        motions=folder / files["motions"] if "motions" in files else None,
        folder=folder,
        neighbours=folder / store.neighbours_name(files["embeddings"]),
        attributes=_attributes(folder, head),
        words_file=folder / files["words"] if "words" in files else None,
        captions=tuple(_caption(row) for row in head.get("captions", ())),
    )


def _attributes(folder: Path, head: dict[str, Any]) -> FloatArray | None:
    """Attributes ``(W, A)``; None of a gallery that has none, or those of another version of motionrt."""
    if head.get("attributes") != list(ATTRIBUTES):
        return None
    return store.read_array(folder, head["files"]["attributes"])


def _caption(row: dict[str, Any]) -> Caption:
    return Caption(**{**row, "tags": tuple(row["tags"])})


def _check(embeddings: FloatArray, windows: WindowTable, clips: int, folder: Path) -> None:
    """GalleryError unless every clip has windows, in order, and every window an embedding."""
    if embeddings.dtype != np.float32 or embeddings.ndim != 2 or windows.dtype != WINDOW_TYPE:
        raise store.damaged(folder, "an array has the wrong type")
    owners = windows["clip"]
    if len(embeddings) != len(windows) or not np.array_equal(np.unique(owners), np.arange(clips)):
        raise store.damaged(folder, "clips, windows and embeddings do not fit together")


def _head(gallery: Contents, folder: Path) -> dict[str, Any]:
    return {
        "model": asdict(gallery.model),
        "source": _noted_source(gallery.source, folder),
        "mapping": dict(gallery.mapping) if gallery.mapping else None,
        "clips": [asdict(clip) for clip in gallery.clips],
        "skipped": [asdict(skipped) for skipped in gallery.skipped],
        **({} if gallery.attributes is None else {"attributes": list(ATTRIBUTES)}),
        **({"captions": [asdict(caption) for caption in gallery.captions]} if gallery.captions else {}),
    }


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


def _write_npy(file: IO[bytes], array: npt.NDArray[Any]) -> None:
    np.lib.format.write_array(file, np.ascontiguousarray(array), allow_pickle=False)
