"""The work of a build: index what is new, keep what is known, write what changed in one step."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from motionrt.errors import GalleryError
from motionrt.formats.folder import FoundMotions
from motionrt.retrieval import layout
from motionrt.retrieval.captioning import captioned
from motionrt.retrieval.contents import Contents
from motionrt.retrieval.gallery import Gallery
from motionrt.retrieval.growth import settled
from motionrt.retrieval.indexing import FileJob, IndexedFile, OpenModel, Outcome, index_files
from motionrt.retrieval.journal import Journal
from motionrt.retrieval.known import Known
from motionrt.retrieval.records import AS_THEY_ARE, WINDOW_TYPE, ModelStamp, Reading, Skipped
from motionrt.retrieval.segments import Segment
from motionrt.retrieval.windows import MotionEmbedder

Progress = Callable[[int, int, str], None]


@dataclass(frozen=True)
class BuildReport:
    """What a build or update did.

    Attributes:
        gallery: the gallery as it is on disk now; ``gallery.skipped`` lists what could not be indexed.
        added, changed, unchanged, removed: ids of clips, against the gallery that was there.
        indexed: how many clips were read and embedded; a build that was killed had done the others before.
        seconds: how long that took.
    """

    gallery: Gallery
    added: tuple[str, ...]
    changed: tuple[str, ...]
    unchanged: tuple[str, ...]
    removed: tuple[str, ...]
    indexed: int = 0
    seconds: float = 0.0

    @property
    def clips_per_s(self) -> float:
        """Clips that were read and embedded in a second, by all processes together."""
        return self.indexed / self.seconds if self.seconds else 0.0


@dataclass(frozen=True)
class Plan:
    """From where to where, and what is there already."""

    source: Path
    target: Path
    found: FoundMotions
    reading: Reading = AS_THEY_ARE
    precision: str = "float32"
    old: Contents | None = None


@dataclass(frozen=True)
class Workers:
    """Who does the work, and who is told."""

    open_model: OpenModel
    model: MotionEmbedder
    jobs: int
    progress: Progress | None


@dataclass
class Work:
    """What became of the files.

    Attributes:
        known: the clips that were indexed before.
        journal: what was indexed now.
        read: ids of the clips whose content is new.
        skipped: files that could not be indexed.
        seconds: how long indexing took.
    """

    known: Known
    journal: Journal
    read: list[str] = field(default_factory=list)
    skipped: list[Skipped] = field(default_factory=list)
    seconds: float = 0.0


def run(plan: Plan, workers: Workers) -> BuildReport:
    """Index what is not known, and write what changed; the caller holds the lock of its folder."""
    facts = _facts(plan, ModelStamp(workers.model.name, workers.model.fingerprint))
    before = tuple(plan.old.segments) if plan.old is not None else ()
    journal = Journal.open(plan.target, facts)
    doubtful = [*journal.skipped, *(plan.old.skipped if plan.old is not None else ())]
    work = Work(Known.of([*journal.left, *before], doubtful), journal)
    _index(plan, workers, work)
    changed, unchanged = work.known.remaining()
    left = [part for part in changed + unchanged if part.folder == journal.folder]
    segments = settled(
        [part for part in changed if part.folder != journal.folder],
        [part for part in unchanged if part.folder != journal.folder],
        [*left, *journal.new()],
    )
    closed = [Skipped(*one) for one in plan.found.closed]
    if not any(part.clip_count for part in segments):
        first = min([*closed, *work.skipped], key=lambda item: item.path)
        raise GalleryError(
            f"none of the {len(plan.found.motions)} motion files in {plan.source} could be read; "
            f"the first: {first.path}: {first.reason}"
        )
    segments, odd = captioned(segments, plan.source, plan.found.beside, plan.old)
    skipped = sorted([*closed, *work.skipped, *odd], key=lambda item: item.path)
    gallery = replace(facts, skipped=tuple(skipped))
    if plan.old is None or not _same(plan.old, gallery, segments):
        layout.save(gallery, plan.target, segments)
    journal.close()
    return _report(plan, work, before)


def _facts(plan: Plan, model: ModelStamp) -> Contents:
    """What is known of the gallery before its clips are."""
    return Contents(
        clips=(),
        embeddings=np.zeros((0, 0), np.float32),
        windows=np.zeros(0, WINDOW_TYPE),
        model=model,
        source=plan.source,
        reading=plan.reading,
        precision=plan.precision,
        sidecars=plan.found.beside,
    )


def _index(plan: Plan, workers: Workers, work: Work) -> None:
    """Read and embed the files that are not as they were."""
    known, found = work.known, plan.found.motions
    jobs = [
        FileJob(plan.source, name, plan.reading, known.checksum(name))
        for name, stamp in found.items()
        if not known.keep(name, stamp)
    ]
    began = time.perf_counter()
    indexed = index_files(jobs, workers.model, workers.open_model, workers.jobs)
    for number, (job, outcome) in enumerate(zip(jobs, indexed, strict=True), 1):
        _note(job.id, outcome, work)
        if workers.progress is not None:
            workers.progress(number, len(jobs), job.id)
    work.seconds = time.perf_counter() - began


def _note(file: str, outcome: Outcome, work: Work) -> None:
    if isinstance(outcome, IndexedFile):
        work.read += [item.clip.id for item in outcome.clips]
        work.skipped += outcome.skipped
        work.journal.add(outcome)
    else:
        work.known.touched(file, (outcome.size, outcome.mtime_ns))


def _same(old: Contents, new: Contents, segments: Sequence[Segment]) -> bool:
    """Whether the gallery on disk says all that there is to say."""
    same = len(old.segments) == len(segments) and all(a is b for a, b in zip(old.segments, segments, strict=True))
    same = same and layout.is_current(old)
    return same and (old.skipped, dict(old.sidecars), old.source) == (new.skipped, dict(new.sidecars), new.source)


def _report(plan: Plan, work: Work, before: Sequence[Segment]) -> BuildReport:
    gallery = Gallery.open(plan.target)
    ids = [name for part in gallery.segments for name in _ids(part)]
    now, then = set(ids), dict.fromkeys(name for part in before for name in _ids(part))
    read = set(work.read)
    resumed = {name for part in work.journal.left for name in _ids(part)} - read
    return BuildReport(
        gallery,
        added=tuple(sorted(name for name in ids if name not in then)),
        changed=tuple(sorted(name for name in ids if name in then and name in read)),
        unchanged=tuple(sorted(name for name in ids if name not in read and (name in then or name not in resumed))),
        removed=tuple(name for name in then if name not in now),
        indexed=len(work.read),
        seconds=work.seconds,
    )


def _ids(part: Segment) -> list[str]:
    ids = part.clips.ids.texts()
    return ids if part.kept_clips is None else [ids[number] for number in part.kept_clips.tolist()]
