"""Captioned recordings of several sources in one: whole recordings, the segments that captions speak of, and licences.

A delivery is a folder with ``index.csv`` (one row a recording: ``trial``, ``format``, ``fps`` and, where it applies,
``archive``, ``file``, ``asf``, ``animation``, ``licence``, ``source``), ``captions.jsonl`` (one row a segment, as in
:mod:`motionrt_training.corpora.cmu`) and, where there are any, ``paraphrases.jsonl`` (``id``, ``short``, ``more``).
Its files lie in ``bvh/``, ``amc/`` and ``asf/`` beside it, or in the folders that its archives were unpacked to.
"""

from __future__ import annotations

import csv
import json
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from motionrt.errors import FormatError, InvalidInputError, MotionFileNotFoundError
from motionrt.formats import load_motion
from motionrt.motion import Motion
from motionrt.motion.body_parts import checked_parts
from motionrt_training.corpora.cmu import caption_rows

CMU = "cmu"
CMU_LICENCE = "CMU (free for all uses)"
HAND_KEYED = ("cc0",)
"""Sources that were animated by hand: good for the names of actions, poor for their dynamics."""
SPARE_SKELETON = "14"  # CMU subjects without a skeleton of their own are close to this one


@dataclass(frozen=True)
class Segment:
    """A captioned stretch of a recording.

    Attributes:
        id: unique over all deliveries.
        start_s, end_s: seconds of the recording as :meth:`Recording.load` returns it.
        captions: sentences and searches on the whole stretch.
        labels: simultaneous actions, each a text with its body parts.
    """

    id: str
    start_s: float
    end_s: float
    captions: tuple[str, ...]
    labels: tuple[tuple[str, frozenset[str]], ...]


@dataclass(frozen=True)
class Recording:
    """One recording: where its file lies, how it is read, whose it is.

    Attributes:
        id: its trial, unique over all deliveries.
        split: ``train``, ``val`` or ``test``, the same for all its segments.
        source: the pack it came in, as in ``"cmu"`` or ``"apache_snu"``.
        licence, origin: terms, and the repository that published it.
        fps: frames per second of the file, which not every file says.
        asf: skeleton of an ``.amc``.
        animation: name of one among several animations of a ``.glb``.
        segments: in order of time; none for a recording without captions.
    """

    id: str
    path: Path
    split: str
    source: str
    licence: str
    origin: str
    fps: float
    asf: Path | None = None
    animation: str | None = None
    segments: tuple[Segment, ...] = ()

    def load(self) -> Motion:
        """The whole recording on ``smpl24``, grounded; a leading calibration pose is dropped."""
        motion = load_motion(self.path, asf=self.asf, fps=self.fps, animation=self.animation)
        return motion.grounded()


def read_mocap(
    folder: str | Path, unpacked: str | Path | None = None, sources: Collection[str] | None = None
) -> tuple[Recording, ...]:
    """Every recording of the deliveries in ``folder``.

    Args:
        folder: holds ``cmu/`` and, where there is more, ``more/``.
        unpacked: where the archives of ``more/`` were unpacked, each in a folder of its name; None leaves them out.
        sources: names of the sources to read, as :attr:`Recording.source` has them; None reads all.

    Raises:
        MotionFileNotFoundError: a missing index or motion file.
        FormatError: a captions row that is not JSON or misses a key, with its line number.
        InvalidInputError: a source that there is not.
    """
    found = list(_delivery(Path(folder) / CMU, None))
    if unpacked is not None:
        found += _delivery(Path(folder) / "more", Path(unpacked))
    known = {recording.source for recording in found}
    if unknown := sorted(set(sources or ()) - known):
        raise InvalidInputError(f"no source {', '.join(unknown)}; there are: {', '.join(sorted(known))}")
    return tuple(recording for recording in found if sources is None or recording.source in sources)


def provenance(recordings: Iterable[Recording]) -> list[dict[str, Any]]:
    """What a model's sheet says of its data: source, licence, origin and number of recordings, sorted."""
    counts: dict[tuple[str, str, str], int] = {}
    for recording in recordings:
        key = recording.source, recording.licence, recording.origin
        counts[key] = counts.get(key, 0) + 1
    names = ("source", "licence", "origin")
    return [dict(zip(names, key, strict=True)) | {"recordings": n} for key, n in sorted(counts.items())]


def _delivery(folder: Path, unpacked: Path | None) -> Iterable[Recording]:
    index = folder / "index.csv"
    if not index.is_file():
        raise MotionFileNotFoundError(f"{index} does not exist; point to the folder that holds {folder.name}/")
    segments, splits = _segments(folder)
    with index.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            trial = row["trial"]
            placed = _in_folders(folder, row) if unpacked is None else _in_archive(unpacked, row)
            yield _recording(row, placed, splits.get(trial, "train"), tuple(segments.get(trial, ())))


def _recording(
    row: dict[str, str], placed: tuple[str, Path, Path | None], split: str, segments: tuple[Segment, ...]
) -> Recording:
    source, path, asf = placed
    if not path.is_file():
        raise MotionFileNotFoundError(
            f"recording {row['trial']} needs {path}, which does not exist; unpack its archive"
        )
    licence, origin = row.get("licence") or CMU_LICENCE, row.get("source") or row.get("source_repo") or ""
    fps, animation = float(row["fps"]), row.get("animation") or None
    return Recording(row["trial"], path, split, source, licence, origin, fps, asf, animation, segments)


def _in_folders(folder: Path, row: dict[str, str]) -> tuple[str, Path, Path | None]:
    """Source, motion file and skeleton of a recording whose folders are named after formats."""
    kind, trial = row["format"], row["trial"]
    own = folder / "asf" / f"{trial.split('_')[0]}.asf"
    skeleton = own if own.is_file() else own.with_stem(SPARE_SKELETON)
    return CMU, folder / kind / f"{trial}.{kind}", skeleton if kind == "amc" else None


def _in_archive(unpacked: Path, row: dict[str, str]) -> tuple[str, Path, Path | None]:
    """The same of a recording whose file lies in an archive's folder."""
    source = row["archive"].split(".")[0]
    path = unpacked / source / row["file"]
    return source, path, path.parent / row["asf"] if row["asf"] else None


def _segments(folder: Path) -> tuple[dict[str, list[Segment]], dict[str, str]]:
    """Segments of every trial in order of time, and the split of every trial."""
    source, more = folder / "captions.jsonl", _paraphrases(folder / "paraphrases.jsonl")
    segments: dict[str, list[Segment]] = {}
    splits: dict[str, str] = {}
    for line, row in caption_rows(source):
        try:
            found = _segment(row, more.get(row["id"], ()))
            segments.setdefault(row["trial"], []).append(found)
            splits[row["trial"]] = row["split"]
        except (KeyError, TypeError) as error:
            raise FormatError(source, f"caption row misses or garbles {error}", line) from None
    return {trial: sorted(rows, key=lambda row: row.start_s) for trial, rows in segments.items()}, splits


def _segment(row: dict[str, Any], more: tuple[str, ...]) -> Segment:
    labels = tuple((label["text"], checked_parts(label["parts"])) for label in row["labels"])
    return Segment(row["id"], row["start_s"], row["end_s"], (*row["captions"], *more), labels)


def _paraphrases(path: Path) -> dict[str, tuple[str, ...]]:
    """Further sentences on segments, by their id; none where there is no such file."""
    if not path.is_file():
        return {}
    rows = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines() if line.strip()]
    return {row["id"]: (row["short"], *row["more"]) for row in rows}
