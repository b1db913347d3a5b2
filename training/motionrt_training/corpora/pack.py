"""The packed corpus: features of every clip, computed once into one ``.npz``.

Arrays: ``features`` ``(frames of all clips, 263)`` float16, ``start`` and ``length`` ``(clips,)`` int64 into them,
``meta``, a JSON list with ``id``, ``split``, ``texts``, ``texts_mirror`` (what is said of the mirror image), ``group``,
``source`` and ``windows`` of each (see `motionrt_training.packed`), and ``provenance``, a JSON list that says whose
data it is (`motionrt_training.data_record`).

    python -m motionrt_training.corpora.pack mocap ../shared/data/mocap --unpacked runs/more -o runs/mocap.npz
    python -m motionrt_training.corpora.pack cmu ../shared/data/mocap/cmu -o runs/cmu.npz
    python -m motionrt_training.corpora.pack humanml3d HumanML3D --amass AMASS -o runs/humanml3d.npz
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from motionrt.motion import Motion
from motionrt.motion.features import guo263
from motionrt_training.command import reports_errors
from motionrt_training.corpora.corpus import Clip
from motionrt_training.corpora.joining import joined_clips
from motionrt_training.corpora.mocap import Recording, provenance, read_mocap
from motionrt_training.corpora.reading import add_options, read_named
from motionrt_training.corpora.stretches import recorded_clips, take_pairs
from motionrt_training.corpora.text_mirror import mirror_text
from motionrt_training.corpora.windows import windows_of
from motionrt_training.data_record import DataRecord, data_record

Row = tuple[NDArray[np.float16], dict[str, object]]


def pack(
    rows: Iterable[Row], path: str | Path, *, joined: int = 0, seed: int = 1, record: DataRecord | None = None
) -> Path:
    """Write rows of features, texts and windows to ``path``; returns it.

    ``joined``: so many clips more, each of two training clips one after the other ("A, then B"). ``record``: whose data
    it is.
    """
    rows = list(rows)
    training = [row for row in rows if row[1]["split"] == "train"]
    rows += joined_clips(training, joined, np.random.default_rng(seed))
    lengths = np.array([len(features) for features, _ in rows])
    target = Path(path)
    target.parent.mkdir(parents=True, exist_ok=True)
    np.savez_compressed(
        target,
        features=np.concatenate([features for features, _ in rows]),
        start=np.cumsum(lengths) - lengths,
        length=lengths,
        meta=json.dumps([meta for _, meta in rows], ensure_ascii=False),
        provenance=json.dumps(record or []),
    )
    return target


def rows_of(clips: Iterable[tuple[Clip, Motion]], seed: int = 1) -> Iterator[Row]:
    """Features at 20 fps and all that is kept of each clip."""
    rng = np.random.default_rng(seed)
    for clip, motion in clips:
        positions = motion.resample(guo263.FPS).positions()
        features = guo263.encode_positions(positions).astype(np.float16)
        yield features, _meta(clip) | {"windows": windows_of(positions, rng) if clip.split == "train" else []}


def _meta(clip: Clip) -> dict[str, object]:
    texts = _texts(clip)
    said = {"texts": texts, "texts_mirror": [mirror_text(text) for text in texts]}
    return {"id": clip.id, "split": clip.split, "group": clip.group or clip.id, "source": clip.source, **said}


def _texts(clip: Clip) -> list[str]:
    """The clip's captions; to train on, also its action labels as one more."""
    joined = " and ".join(clip.labels)
    extra = [joined] if clip.split == "train" and joined and joined not in clip.texts else []
    return [*clip.texts, *extra]


@reports_errors
def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description="Compute the features of a captioned corpus once.")
    add_options(parser, "mocap")
    parser.add_argument("--unpacked", help="mocap: where the archives of its second delivery were unpacked")
    parser.add_argument("--sources", nargs="+", help="mocap: only these sources (default: all)")
    parser.add_argument("--joined", type=int, default=800, help="clips of two windows one after the other")
    parser.add_argument("--jobs", type=int, default=2, help="mocap: processes (default: %(default)s)")
    parser.add_argument("-o", "--out", required=True, help="the .npz to write")
    args = parser.parse_args()
    if args.corpus == "mocap":
        recordings = read_mocap(args.folder, args.unpacked, args.sources)
        rows = _rows_of_mocap((*recordings, *take_pairs(recordings, Path(args.folder) / "cmu")), args.jobs)
        pack(rows, args.out, joined=args.joined, record=provenance(recordings))
        return
    corpus = read_named(args)
    rows = rows_of(tqdm(corpus.motions(), total=len(corpus), desc="packing", unit="clip"))
    record = data_record(corpus.name, len({clip.path for clip in corpus.clips}), args.licence, args.origin)
    pack(rows, args.out, joined=args.joined, record=record)
    print(corpus.report or f"{corpus.name}: {len(corpus)} clips")


def _rows_of_mocap(recordings: Sequence[Recording], jobs: int) -> Iterator[Row]:
    with ProcessPoolExecutor(jobs) as pool:
        done = pool.map(_recorded, recordings, range(len(recordings)), chunksize=8)
        for rows in tqdm(done, total=len(recordings), desc="packing", unit="recording"):
            yield from rows


def _recorded(recording: Recording, seed: int) -> list[Row]:
    return list(rows_of(recorded_clips([recording], seed), seed))


if __name__ == "__main__":
    main()
