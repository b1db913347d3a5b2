"""Reading and embedding one motion file, in this process or in several."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from motionrt.errors import FormatError, MotionRTError
from motionrt.formats import animations_of, load_motion
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval.records import AS_THEY_ARE, Clip, Reading, Skipped
from motionrt.retrieval.store import digest
from motionrt.retrieval.windows import MotionEmbedder, embed_windows, measured, motion_features, spans_in_seconds

FILES_PER_PROCESS = 4  # fewer are read before another process has started
OpenModel = Callable[[], MotionEmbedder]


@dataclass(frozen=True)
class FileJob:
    """A file to index: ``source / id``; ``known_sha256`` is its checksum when it was indexed before."""

    source: Path
    id: str
    reading: Reading = AS_THEY_ARE
    known_sha256: str | None = None


@dataclass(frozen=True, eq=False)
class IndexedClip:
    """A clip with its windows: spans in seconds, embeddings ``(W, 256)`` and attributes ``(W, A)``."""

    clip: Clip
    spans: list[tuple[float, float]]
    embeddings: FloatArray
    attributes: FloatArray | None = None


@dataclass(frozen=True, eq=False)
class IndexedFile:
    """What a file gave: a clip for each of its animations, and those that could not be read."""

    clips: tuple[IndexedClip, ...] = ()
    skipped: tuple[Skipped, ...] = ()


@dataclass(frozen=True)
class SameContent:
    """The file was only touched: its content is what was indexed before."""

    size: int
    mtime_ns: int


Outcome = IndexedFile | SameContent


def index_file(job: FileJob, model: MotionEmbedder) -> Outcome:
    """Read and embed one file, each animation of it; whatever is wrong becomes a reason to skip it."""
    path = job.source / job.id
    try:
        stat, checksum = path.stat(), digest(path)
        if checksum == job.known_sha256:
            return SameContent(stat.st_size, stat.st_mtime_ns)
        names = [] if job.reading.animation is not None else animations_of(path)
    except Exception as error:  # noqa: BLE001 - one odd file among thousands must not end the build
        return IndexedFile(skipped=(Skipped(job.id, _reason(error)),))
    whole = Clip(job.id, 0.0, stat.st_size, stat.st_mtime_ns, checksum)
    clips = [replace(whole, id=f"{job.id}#{name}", animation=name) for name in names] or [whole]
    found = [_indexed(job, clip, model) for clip in clips]
    indexed = tuple(one for one in found if isinstance(one, IndexedClip))
    skipped = [one for one in found if isinstance(one, Skipped)]
    if not indexed and len({one.reason for one in skipped}) == 1:  # what is wrong is wrong with the file
        skipped = [Skipped(job.id, skipped[0].reason)]
    return IndexedFile(indexed, tuple(skipped))


def _indexed(job: FileJob, clip: Clip, model: MotionEmbedder) -> IndexedClip | Skipped:
    try:
        motion = load_motion(job.source / job.id, **job.reading.arguments(job.source, clip.animation))
        features = motion_features(motion)
        if not np.isfinite(features).all():
            return Skipped(clip.id, "its positions are too large for numbers")
    except Exception as error:  # noqa: BLE001 - as above
        return Skipped(clip.id, _reason(error))
    embeddings, spans = embed_windows(model, features)
    seconds = spans_in_seconds(spans, motion.duration)
    return IndexedClip(replace(clip, duration_s=motion.duration), seconds, embeddings, measured(motion, seconds))


def index_files(
    jobs: Sequence[FileJob], model: MotionEmbedder, open_model: OpenModel, processes: int
) -> Iterator[Outcome]:
    """Outcomes in the order of ``jobs``; of several processes every one opens a model of its own.

    A process is only worth its start with a few files: there are never more than one for four.

    Raises:
        GalleryError: a process was killed, as by a lack of memory.
    """
    processes = min(processes, len(jobs) // FILES_PER_PROCESS)
    if processes <= 1:
        yield from (index_file(job, model) for job in jobs)
        return
    from motionrt.retrieval.processes import in_processes

    with closing(in_processes(jobs, partial(_indexer, open_model), processes)) as outcomes:
        yield from outcomes


def _indexer(open_model: OpenModel) -> Callable[[FileJob], Outcome]:
    """What a process of a build does with its jobs; it opens a model of its own."""
    return partial(index_file, model=open_model())


def _reason(error: Exception) -> str:
    if isinstance(error, FormatError):
        text = error.reason if error.line is None else f"line {error.line}: {error.reason}"
    elif isinstance(error, MotionRTError):
        text = str(error)
    elif isinstance(error, OSError):
        text = f"cannot be read: {error.strerror or error}"
    else:
        text = f"cannot be read: {type(error).__name__}: {error}"
    return " ".join(text.split())
