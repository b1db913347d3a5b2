"""The packed positions: joints of every recording at 20 fps, computed once, for the generator.

Arrays: ``joints`` ``(frames of all recordings, 24, 3)`` float32, metres, Y up, the floor at 0, ``start`` and ``length``
``(recordings,)`` int64 into them, and ``meta``, a JSON list of ``id``, ``split``, ``source`` and ``segments`` of each:
``[first frame, frames, captions, labels]``, the first frame counted from the recording's own.

    python -m motionrt_training.corpora.positions ../shared/data/mocap --unpacked runs/more -o runs/positions.npz
"""

from __future__ import annotations

import argparse
import json
import logging
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from motionrt.errors import FormatError, RigError
from motionrt_training.corpora.mocap import Recording, provenance, read_mocap
from motionrt_training.data_record import DataRecord

FPS = 20.0
SHORTEST = 8  # frames of a segment or a recording that are worth training on

log = logging.getLogger(__name__)
Row = tuple[NDArray[np.float32], dict[str, Any]]


@dataclass(frozen=True)
class CaptionedSpan:
    """Frames ``first`` to ``first + count`` of a recording, and what is said of them."""

    first: int
    count: int
    captions: tuple[str, ...]
    labels: tuple[str, ...]


@dataclass(frozen=True)
class PackedRecording:
    """One recording of the pack: ``joints`` is a view ``(F, 24, 3)`` float32 at 20 fps."""

    id: str
    split: str
    source: str
    joints: NDArray[np.float32]
    spans: tuple[CaptionedSpan, ...]


def pack_positions(recordings: Iterable[Recording], path: str | Path) -> Path:
    """Write the joints of `recordings` to ``path``; returns it. Recordings that are no people are left out."""
    recordings = list(recordings)
    with ProcessPoolExecutor(2) as pool:
        found = tqdm(pool.map(_row, recordings, chunksize=8), total=len(recordings), unit="recording")
        rows = [row for row in found if row is not None]
    return write_positions(rows, path, provenance(recordings))


def write_positions(rows: Sequence[Row], path: str | Path, record: DataRecord) -> Path:
    """Write joints and what is said of them, and whose data it is, to ``path``; returns it."""
    lengths = np.array([len(joints) for joints, _ in rows])
    target = Path(path)
    target.parent.mkdir(parents=True, exist_ok=True)
    np.savez(
        target,
        joints=np.concatenate([joints for joints, _ in rows]),
        start=np.cumsum(lengths) - lengths,
        length=lengths,
        meta=json.dumps([meta for _, meta in rows], ensure_ascii=False),
        provenance=json.dumps(record),
    )
    return target


def unpack_positions(path: str | Path) -> Iterator[PackedRecording]:
    """The recordings of a pack."""
    with np.load(path) as pack:
        joints, starts, lengths = pack["joints"], pack["start"].tolist(), pack["length"].tolist()
        metas = json.loads(str(pack["meta"]))
    for start, length, meta in zip(starts, lengths, metas, strict=True):
        spans = tuple(CaptionedSpan(a, n, tuple(said), tuple(labels)) for a, n, said, labels in meta["segments"])
        yield PackedRecording(meta["id"], meta["split"], meta["source"], joints[start : start + length], spans)


def _row(recording: Recording) -> Row | None:
    try:
        motion = recording.load().resample(FPS)
    except (FormatError, RigError) as error:
        log.warning("left out: %s: %s", recording.id, error)
        return None
    joints = np.asarray(motion.positions(), np.float32)
    spans = []
    for segment in recording.segments:
        first = round(segment.start_s * FPS)
        count = min(len(joints), round(segment.end_s * FPS) + 1) - first
        if count >= SHORTEST:
            spans.append([first, count, segment.captions, [text for text, _ in segment.labels]])
    if len(joints) < SHORTEST:
        return None
    return joints, {"id": recording.id, "split": recording.split, "source": recording.source, "segments": spans}


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description="Compute the joint positions of the mocap corpus once.")
    parser.add_argument("folder", help="the folder of the deliveries")
    parser.add_argument("--unpacked", help="where the archives of the second delivery were unpacked")
    parser.add_argument("-o", "--output", required=True, help="the pack (.npz)")
    args = parser.parse_args()
    print(pack_positions(read_mocap(args.folder, args.unpacked), args.output))


if __name__ == "__main__":
    main()
