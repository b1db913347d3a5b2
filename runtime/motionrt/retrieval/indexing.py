"""Reading and embedding one motion file, in this process or in several."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from motionrt.errors import FormatError, MotionRTError
from motionrt.formats import load_motion
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval.records import Clip, Skipped
from motionrt.retrieval.store import digest
from motionrt.retrieval.windows import MotionEmbedder, embed_windows, measured, motion_features, spans_in_seconds

FILES_PER_PROCESS = 4  # fewer are read before another process has started
OpenModel = Callable[[], MotionEmbedder]


@dataclass(frozen=True)
class FileJob:
    """A file to index: ``source / id``; ``known_sha256`` is its checksum when it was indexed before."""

    source: Path
    id: str
    mapping: Mapping[str, str] | None = None
    known_sha256: str | None = None


@dataclass(frozen=True, eq=False)
class IndexedClip:
    """A clip with its windows: spans in seconds, embeddings ``(W, 256)`` and attributes ``(W, A)``."""

    clip: Clip
    spans: list[tuple[float, float]]
    embeddings: FloatArray
    attributes: FloatArray | None = None


@dataclass(frozen=True)
class SameContent:
    """The file was only touched: its content is what was indexed before."""

    size: int
    mtime_ns: int


Outcome = IndexedClip | SameContent | Skipped


def index_file(job: FileJob, model: MotionEmbedder) -> Outcome:
    """Read and embed one file; whatever is wrong with it becomes a reason to skip it."""
    path = job.source / job.id
    try:
        stat, checksum = path.stat(), digest(path)
        if checksum == job.known_sha256:
            return SameContent(stat.st_size, stat.st_mtime_ns)
        motion = load_motion(path, mapping=job.mapping)
        features = motion_features(motion)
        if not np.isfinite(features).all():
            return Skipped(job.id, "its positions are too large for numbers")
    except Exception as error:  # noqa: BLE001 - one odd file among thousands must not end the build
        return Skipped(job.id, _reason(error))
    embeddings, spans = embed_windows(model, features)
    clip = Clip(job.id, motion.duration, stat.st_size, stat.st_mtime_ns, checksum)
    seconds = spans_in_seconds(spans, motion.duration)
    return IndexedClip(clip, seconds, embeddings, measured(motion, seconds))


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
