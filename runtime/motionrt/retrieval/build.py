"""Build and update a gallery from a folder of motion files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from motionrt.errors import GalleryError, InvalidInputError
from motionrt.formats import find_motions
from motionrt.formats.folder import FoundMotions
from motionrt.motion.checks import checked_fps
from motionrt.retrieval.assembly import BuildReport, Plan, Progress, Workers, run
from motionrt.retrieval.gallery import Gallery
from motionrt.retrieval.head import stays_below
from motionrt.retrieval.indexing import OpenModel
from motionrt.retrieval.locking import writing
from motionrt.retrieval.records import Reading
from motionrt.retrieval.sidecars import SIDECARS
from motionrt.retrieval.store import DEFAULT_FOLDER, GALLERY_FILE
from motionrt.retrieval.vectors import checked_precision
from motionrt.untrusted.files import as_path
from motionrt.untrusted.words import shown

_MOST_JOBS = 256


def build_gallery(
    folder: str | Path,
    open_model: OpenModel,
    *,
    out: str | Path | None = None,
    jobs: int = 1,
    mapping: Mapping[str, str] | None = None,
    fps: float | None = None,
    up: str | None = None,
    asf: str | Path | None = None,
    animation: int | str | None = None,
    progress: Progress | None = None,
    precision: str = "float32",
) -> BuildReport:
    """Index every motion file below ``folder``; files that cannot be read are reported, not fatal.

    Each animation of a file that holds several is a clip of its own. How files are read is kept for updates. The
    gallery replaces the one at ``out`` in one step when it is complete, and does not depend on ``jobs``. What was
    indexed is kept beside it meanwhile: a build that is killed goes on there, with the files that did not change.

    Args:
        folder: searched recursively, every supported format.
        open_model: opens the motion model, once per process; must survive pickling when ``jobs`` is above 1.
        out: where the gallery goes, by default ``.motionrt-gallery`` inside ``folder``.
        jobs: processes.
        mapping: joint names of an unusual rig (``smpl24`` name -> name in the files).
        fps: frames per second of all files, where they say it wrongly.
        up: ``"y"`` or ``"z"``, the vertical axis of all files, where they and the body do not tell it rightly.
        asf: the skeleton of all ``.amc``, a file in ``folder`` or below it; otherwise looked for beside each.
        animation: the one to read of files that hold several, instead of each.
        progress: called with files done, files in all and the file's name.
        precision: what embeddings are stored in: ``float32``, ``float16`` (half of the bytes) or ``int8`` (a quarter).

    Raises:
        MotionFileNotFoundError, InvalidInputError: no such folder, no motion file in it, ``jobs`` below 1, or an option
            of reading that cannot be.
        GalleryError: no file could be read, the place cannot be written, or another process writes there.
    """
    source = as_path(folder).resolve()
    reading = checked_reading(source, mapping, fps, up, asf, animation)
    stored = checked_precision(precision)
    found = _found(source)
    target = as_path(out) if out is not None else source / DEFAULT_FOLDER
    workers = Workers(open_model, open_model(), _checked_jobs(jobs), progress)
    with writing(target):
        return run(Plan(source, target, found, reading, stored), workers)


def update_gallery(
    path: str | Path, open_model: OpenModel, *, jobs: int = 1, progress: Progress | None = None
) -> BuildReport:
    """Bring a gallery up to date with its folder: only new and changed files are read, removed ones go.

    What did not change is not written again, but for small segments (:mod:`motionrt.retrieval.growth`).

    A file is unchanged when its size and modification time are, or else its checksum. Files that were skipped
    are tried again. An ``.amc`` counts as unchanged when only its ``.asf`` changed; build again then.

    Raises:
        GalleryNotFoundError, GalleryError: no gallery, damaged, by another model, or not from files.
        MotionFileNotFoundError, InvalidInputError: the indexed folder is gone, or empty now.
    """
    folder = Gallery.open(path).folder or Path(path)
    workers = Workers(open_model, open_model(), _checked_jobs(jobs), progress)
    with writing(folder):
        old = Gallery.open(folder)
        if old.source is None:
            raise GalleryError(f"the gallery in {folder} was not made from files: nothing to update it from")
        old.check_model(workers.model.fingerprint, workers.model.name)
        return run(Plan(old.source, folder, _found(old.source), old.reading, old.precision, old), workers)


def _found(source: Path) -> FoundMotions:
    """Motion files and files of words below a folder; other galleries are left out."""
    return find_motions(source, without=GALLERY_FILE, beside=SIDECARS)


def checked_reading(
    source: Path | None,
    mapping: Mapping[str, str] | None,
    fps: float | None,
    up: str | None,
    asf: str | Path | None,
    animation: int | str | None,
) -> Reading:
    """How files are read, of the arguments of :func:`build_gallery`; without ``source`` ``asf`` is a path below it."""
    if not (up is None or (isinstance(up, str) and up in ("y", "z"))):
        raise InvalidInputError(f"up must be 'y' or 'z', not {shown(up)}")
    rate = None if fps is None else checked_fps(fps)
    chosen = None if animation is None else str(animation)
    if asf is None:
        return Reading(mapping, rate, up, None, chosen)
    if source is None:
        below = as_path(asf).as_posix()
        if not stays_below(below):
            raise InvalidInputError(f"asf= must name a file by its path below the indexed folder, not {asf}")
        return Reading(mapping, rate, up, below, chosen)
    skeleton = as_path(asf).resolve()
    if not skeleton.is_file() or not skeleton.is_relative_to(source):
        raise InvalidInputError(f"asf= must name a file in {source}, where the gallery finds it again, not {asf}")
    return Reading(mapping, rate, up, skeleton.relative_to(source).as_posix(), chosen)


def _checked_jobs(jobs: int) -> int:
    if isinstance(jobs, bool) or not isinstance(jobs, int) or not 1 <= jobs <= _MOST_JOBS:
        raise InvalidInputError(f"jobs must be a whole number from 1 to {_MOST_JOBS}, not {shown(jobs)}")
    return jobs
