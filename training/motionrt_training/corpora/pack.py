"""The packed corpus: features of every clip, computed once into one ``.npz``.

Arrays: ``features`` ``(frames of all clips, 263)`` float16, ``start`` and ``length`` ``(clips,)`` int64 into them, and
``meta``, a JSON list with ``id``, ``split``, ``texts``, ``texts_mirror`` (what is said of the mirror image), ``group``,
``source`` and ``windows`` of each (see `motionrt_training.packed`).

    python -m motionrt_training.corpora.pack mocap ../shared/data/mocap --unpacked runs/more -o runs/mocap.npz
    python -m motionrt_training.corpora.pack cmu ../shared/data/mocap/cmu -o runs/cmu.npz
    python -m motionrt_training.corpora.pack humanml3d HumanML3D --amass AMASS -o runs/humanml3d.npz
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from motionrt.errors import InvalidInputError
from motionrt.motion import Motion
from motionrt.motion.features import guo263
from motionrt_training.corpora.babel import read_babel
from motionrt_training.corpora.cmu import read_cmu
from motionrt_training.corpora.corpus import Clip, MotionCorpus
from motionrt_training.corpora.humanml3d import read_humanml3d
from motionrt_training.corpora.joining import joined_clips
from motionrt_training.corpora.kitml import read_kitml
from motionrt_training.corpora.mocap import Recording, read_mocap
from motionrt_training.corpora.stretches import recorded_clips, take_pairs
from motionrt_training.corpora.text_mirror import mirror_text
from motionrt_training.corpora.windows import windows_of

AMASS_READERS: dict[str, Callable[[str, str], MotionCorpus]] = {
    "babel": read_babel,
    "humanml3d": read_humanml3d,
    "kitml": read_kitml,
}
Row = tuple[NDArray[np.float16], dict[str, object]]


def read_corpus(name: str, folder: str, amass: str | None = None) -> MotionCorpus:
    """The corpus called ``name`` (cmu, kitml, humanml3d, babel); all but cmu annotate an AMASS folder."""
    if name == "cmu":
        return read_cmu(folder)
    if name not in AMASS_READERS:
        raise InvalidInputError(f"no corpus reader '{name}'; there are: cmu, {', '.join(sorted(AMASS_READERS))}")
    if amass is None:
        raise InvalidInputError(f"{name} annotates AMASS sequences: name their folder with --amass")
    return AMASS_READERS[name](folder, amass)


def pack(rows: Iterable[Row], path: str | Path, *, joined: int = 0, seed: int = 1) -> Path:
    """Write rows of features, texts and windows to ``path``; returns it.

    ``joined``: so many clips more, each of two training clips one after the other ("A, then B").
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


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description="Compute the features of a captioned corpus once.")
    parser.add_argument("corpus", choices=["mocap", "cmu", *sorted(AMASS_READERS)])
    parser.add_argument("folder", help="the data set's folder of annotations (and, for mocap and cmu, motions)")
    parser.add_argument("--amass", help="the AMASS folder that kitml, humanml3d and babel annotate")
    parser.add_argument("--unpacked", help="mocap: where the archives of its second delivery were unpacked")
    parser.add_argument("--sources", nargs="+", help="mocap: only these sources (default: all)")
    parser.add_argument("--joined", type=int, default=800, help="clips of two windows one after the other")
    parser.add_argument("--jobs", type=int, default=2, help="mocap: processes (default: %(default)s)")
    parser.add_argument("-o", "--out", required=True, help="the .npz to write")
    args = parser.parse_args()
    pack(_rows(args), args.out, joined=args.joined)


def _rows(args: argparse.Namespace) -> Iterator[Row]:
    if args.corpus != "mocap":
        corpus = read_corpus(args.corpus, args.folder, args.amass)
        yield from rows_of(tqdm(corpus.motions(), total=len(corpus), desc="packing", unit="clip"))
        return
    recordings = read_mocap(args.folder, args.unpacked, args.sources)
    recordings = (*recordings, *take_pairs(recordings, Path(args.folder) / "cmu"))
    with ProcessPoolExecutor(args.jobs) as pool:
        done = pool.map(_recorded, recordings, range(len(recordings)), chunksize=8)
        for rows in tqdm(done, total=len(recordings), desc="packing", unit="recording"):
            yield from rows


def _recorded(recording: Recording, seed: int) -> list[Row]:
    return list(rows_of(recorded_clips([recording], seed), seed))


if __name__ == "__main__":
    main()
