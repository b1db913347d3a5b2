"""Build and update a gallery from a folder of motion files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from motionrt.errors import GalleryError, InvalidInputError
from motionrt.retrieval.assembly import BuildReport, Plan, Progress, Workers, run
from motionrt.retrieval.gallery import Gallery
from motionrt.retrieval.indexing import OpenModel
from motionrt.retrieval.locking import writing
from motionrt.retrieval.scan import find_motion_files
from motionrt.retrieval.store import DEFAULT_FOLDER
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
    progress: Progress | None = None,
    precision: str = "float32",
) -> BuildReport:
    """Index every motion file below ``folder``; files that cannot be read are reported, not fatal.

    The gallery replaces the one at ``out`` in one step when it is complete, and does not depend on ``jobs``. What was
    indexed is kept beside it meanwhile: a build that is killed goes on there, with the files that did not change.

    Args:
        folder: searched recursively, every supported format.
        open_model: opens the motion model, once per process; must survive pickling when ``jobs`` is above 1.
        out: where the gallery goes, by default ``.motionrt-gallery`` inside ``folder``.
        jobs: processes.
        mapping: joint names of an unusual rig (``smpl24`` name -> name in the files).
        progress: called with files done, files in all and the file's name.
        precision: what embeddings are stored in: ``float32``, ``float16`` (half of the bytes) or ``int8`` (a quarter).

    Raises:
        MotionFileNotFoundError, InvalidInputError: no such folder, no motion file in it, or ``jobs`` below 1.
        GalleryError: no file could be read, the place cannot be written, or another process writes there.
    """
    source = as_path(folder).resolve()
    stored = checked_precision(precision)
    found = find_motion_files(source)
    target = as_path(out) if out is not None else source / DEFAULT_FOLDER
    workers = Workers(open_model, open_model(), _checked_jobs(jobs), progress)
    with writing(target):
        return run(Plan(source, target, found, mapping, stored), workers)


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
        found = find_motion_files(old.source)
        return run(Plan(old.source, folder, found, old.mapping, old.precision, old), workers)


def _checked_jobs(jobs: int) -> int:
    if isinstance(jobs, bool) or not isinstance(jobs, int) or not 1 <= jobs <= _MOST_JOBS:
        raise InvalidInputError(f"jobs must be a whole number from 1 to {_MOST_JOBS}, not {shown(jobs)}")
    return jobs
