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
from motionrt.retrieval.head import array_files, captions_of, clips_of, model_of, reading_of, skipped_of, source_of
from motionrt.retrieval.records import WINDOW_TYPE, Clip, WindowTable
from motionrt.retrieval.words import WordIndex

_CHECKED = 256 * 2**20  # bytes of embeddings that are checked at the first search


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


def verify(folder: Path) -> dict[str, str]:
    """Check every array of a gallery against its checksum, and what the motions say; returns the files by role."""
    head = store.read_head(folder)
    files = array_files(head.get("files"), store.fails(folder / store.GALLERY_FILE))
    store.verify(folder, files)
    contents = _assembled(folder, head)
    if contents.pack is not None and len(contents.pack) != len(contents.clips):
        raise store.damaged(folder, "it holds another number of motions than of clips")
    return files


def check_embeddings(contents: Contents) -> None:
    """GalleryError if the embeddings on disk are damaged; those beyond 256 MiB are left to :func:`verify`."""
    mapped = contents.embeddings.base
    if not isinstance(mapped, np.memmap) or contents.folder is None or contents.embeddings.nbytes > _CHECKED:
        return
    name = Path(str(mapped.filename)).name
    if (contents.folder / name).is_file():  # otherwise another process has replaced the gallery: this one is mapped
        store.verify(contents.folder, {"embeddings": name})


def _assembled(folder: Path, head: dict[str, Any]) -> Contents:
    contents = _read(folder, head)
    _check(contents.embeddings, contents.windows, len(contents.clips), folder)
    found = contents.attributes
    if found is not None and (found.shape != (len(contents.windows), len(ATTRIBUTES)) or found.dtype.kind != "f"):
        raise store.damaged(folder, "windows and attributes do not fit together")
    return contents


def _read(folder: Path, head: dict[str, Any]) -> Contents:
    fail = store.fails(folder / store.GALLERY_FILE)
    files = array_files(head.get("files"), fail)
    if (folder / files["windows"]).is_file():  # small; the others are checked when they are first used
        store.verify(folder, {"windows": files["windows"]})
    return Contents(
        clips=clips_of(head.get("clips"), fail),
        embeddings=store.read_array(folder, files["embeddings"]),
        windows=store.read_array(folder, files["windows"]),
        model=model_of(head.get("model"), fail),
        source=_source(folder, source_of(head.get("source"), fail)),
        skipped=skipped_of(head.get("skipped"), fail),
        reading=reading_of(head.get("mapping"), head.get("reading", {}), fail),
        motions=folder / files["motions"] if "motions" in files else None,
        folder=folder,
        neighbours=folder / store.neighbours_name(files["embeddings"]),
        attributes=_attributes(folder, head, files),
        words_file=folder / files["words"] if "words" in files else None,
        captions=captions_of(head.get("captions", []), fail),
    )


def _attributes(folder: Path, head: dict[str, Any], files: dict[str, str]) -> FloatArray | None:
    """Attributes ``(W, A)``; None of a gallery that has none, or those of another version of motionrt."""
    if head.get("attributes") != list(ATTRIBUTES) or "attributes" not in files:
        return None
    return store.read_array(folder, files["attributes"])


def _check(embeddings: FloatArray, windows: WindowTable, clips: int, folder: Path) -> None:
    """GalleryError unless every clip has windows, in order, and every window an embedding."""
    if embeddings.dtype != np.float32 or embeddings.ndim != 2 or windows.dtype != WINDOW_TYPE:
        raise store.damaged(folder, "an array has the wrong type")
    if windows.ndim != 1 or len(embeddings) != len(windows) or not clips:
        raise store.damaged(folder, "clips, windows and embeddings do not fit together")
    owners, start, end = windows["clip"], windows["start_s"], windows["end_s"]
    if (np.diff(owners) < 0).any() or not _all_named(owners, clips):
        raise store.damaged(folder, "clips, windows and embeddings do not fit together")
    with np.errstate(invalid="ignore"):
        if not ((start >= 0) & (start <= end) & (end < np.inf)).all():
            raise store.damaged(folder, "a window has no beginning or no end")


def _all_named(owners: npt.NDArray[np.integer[Any]], clips: int) -> bool:
    """Whether these are the numbers of all clips and no others; `np.unique` would import numpy.ma, 10 ms of a start."""
    if len(owners) and (owners.min() < 0 or owners.max() >= clips):
        return False
    return bool(np.bincount(owners, minlength=clips).all())


def _head(gallery: Contents, folder: Path) -> dict[str, Any]:
    options = {
        name: value for name, value in asdict(gallery.reading).items() if name != "mapping" and value is not None
    }
    return {
        "model": asdict(gallery.model),
        "source": _noted_source(gallery.source, folder),
        "mapping": dict(gallery.mapping) if gallery.mapping else None,
        **({"reading": options} if options else {}),
        "clips": [_clip(clip) for clip in gallery.clips],
        "skipped": [asdict(skipped) for skipped in gallery.skipped],
        **({} if gallery.attributes is None else {"attributes": list(ATTRIBUTES)}),
        **({"captions": [asdict(caption) for caption in gallery.captions]} if gallery.captions else {}),
    }


def _clip(clip: Clip) -> dict[str, Any]:
    values = asdict(clip)
    return values if clip.animation is not None else {name: values[name] for name in values if name != "animation"}


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
