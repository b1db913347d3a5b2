"""The work of a build: index what is new, keep what is known, write the gallery in one step."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from motionrt.errors import GalleryError
from motionrt.retrieval import layout
from motionrt.retrieval.gallery import Gallery
from motionrt.retrieval.indexing import FileJob, IndexedClip, IndexedFile, OpenModel, Outcome, index_files
from motionrt.retrieval.records import AS_THEY_ARE, ModelStamp, Reading, Skipped, window_table
from motionrt.retrieval.sidecars import read_sidecars
from motionrt.retrieval.windows import MotionEmbedder

Progress = Callable[[int, int, str], None]


@dataclass(frozen=True)
class BuildReport:
    """What a build or update did.

    Attributes:
        gallery: the gallery as it is on disk now; ``gallery.skipped`` lists what could not be indexed.
        added, changed, unchanged, removed: ids of clips, against the gallery that was there.
    """

    gallery: Gallery
    added: tuple[str, ...]
    changed: tuple[str, ...]
    unchanged: tuple[str, ...]
    removed: tuple[str, ...]


@dataclass(frozen=True)
class Plan:
    """From where to where, and what is there already: clips by file (of files read in full), and all ids."""

    source: Path
    target: Path
    files: list[str]
    closed: list[Skipped]
    reading: Reading = AS_THEY_ARE
    known: dict[str, list[IndexedClip]] = field(default_factory=dict)
    before: tuple[str, ...] = ()


@dataclass(frozen=True)
class Workers:
    """Who does the work, and who is told."""

    open_model: OpenModel
    model: MotionEmbedder
    jobs: int
    progress: Progress | None


def run(plan: Plan, workers: Workers) -> BuildReport:
    """Index what is not known, and write the gallery; the caller holds the lock of its folder."""
    jobs = [_job(plan, name) for name in plan.files if not _same_on_disk(plan, name)]
    outcomes = _outcomes(jobs, workers)
    skipped = sorted([*plan.closed, *_skipped(outcomes)], key=lambda item: item.path)
    clips = [clip for name in plan.files for clip in _clips(name, outcomes, plan.known)]
    clips.sort(key=lambda item: item.clip.id)
    if not clips:
        raise GalleryError(
            f"none of the {len(plan.files)} motion files in {plan.source} could be read; "
            f"the first: {skipped[0].path}: {skipped[0].reason}"
        )
    stamp = ModelStamp(workers.model.name, workers.model.fingerprint)
    captions, closed = read_sidecars(plan.source, [item.clip.id for item in clips])
    gallery = replace(_assembled(plan, clips, [*skipped, *closed], stamp), captions=captions)
    layout.save(gallery, plan.target)
    return _report(plan, Gallery.open(plan.target), outcomes)


def _job(plan: Plan, name: str) -> FileJob:
    known = plan.known.get(name)
    return FileJob(plan.source, name, plan.reading, known[0].clip.sha256 if known and _complete(known) else None)


def _complete(clips: list[IndexedClip]) -> bool:
    """Clips of an old gallery have no attributes: their files are read again."""
    return all(item.attributes is not None for item in clips)


def _same_on_disk(plan: Plan, name: str) -> bool:
    known = plan.known.get(name)
    if known is None or not _complete(known):
        return False
    try:
        stat = (plan.source / name).stat()
    except OSError:
        return False
    return (stat.st_size, stat.st_mtime_ns) == (known[0].clip.size, known[0].clip.mtime_ns)


def _outcomes(jobs: list[FileJob], workers: Workers) -> dict[str, Outcome]:
    outcomes: dict[str, Outcome] = {}
    indexed = index_files(jobs, workers.model, workers.open_model, workers.jobs)
    for job, outcome in zip(jobs, indexed, strict=True):
        outcomes[job.id] = outcome
        if workers.progress is not None:
            workers.progress(len(outcomes), len(jobs), job.id)
    return outcomes


def _clips(name: str, outcomes: dict[str, Outcome], known: dict[str, list[IndexedClip]]) -> Sequence[IndexedClip]:
    """The clips of a file as it is now: just indexed, or from before."""
    outcome = outcomes.get(name)
    if isinstance(outcome, IndexedFile):
        return outcome.clips
    before = known[name]
    if outcome is None:
        return before
    return [replace(item, clip=replace(item.clip, size=outcome.size, mtime_ns=outcome.mtime_ns)) for item in before]


def _assembled(plan: Plan, clips: list[IndexedClip], skipped: list[Skipped], stamp: ModelStamp) -> Gallery:
    return Gallery(
        clips=tuple(item.clip for item in clips),
        embeddings=np.concatenate([item.embeddings for item in clips]).astype(np.float32, copy=False),
        windows=window_table([item.spans for item in clips]),
        model=stamp,
        source=plan.source,
        skipped=tuple(skipped),
        reading=plan.reading,
        attributes=np.concatenate([item.attributes for item in clips if item.attributes is not None]),
    )


def _report(plan: Plan, gallery: Gallery, outcomes: dict[str, Outcome]) -> BuildReport:
    files = [outcome for outcome in outcomes.values() if isinstance(outcome, IndexedFile)]
    read = {item.clip.id for file in files for item in file.clips}
    ids = [clip.id for clip in gallery.clips]
    return BuildReport(
        gallery,
        added=tuple(name for name in ids if name not in plan.before),
        changed=tuple(name for name in ids if name in plan.before and name in read),
        unchanged=tuple(name for name in ids if name not in read),
        removed=tuple(name for name in plan.before if name not in set(ids)),
    )


def _skipped(outcomes: dict[str, Outcome]) -> list[Skipped]:
    return [one for outcome in outcomes.values() if isinstance(outcome, IndexedFile) for one in outcome.skipped]
