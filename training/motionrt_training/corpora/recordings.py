"""Whole recordings at 30 fps, packed once: what WalkNet, TransNet and the pose prior are trained on.

``NAME.npz`` holds the motions (:class:`motionrt.formats.motion_pack.MotionPack`), ``NAME.json`` their ids and splits.

    python -m motionrt_training.corpora.recordings ../shared/data/mocap -o runs/recordings.npz
    python -m motionrt_training.corpora.recordings ../shared/data/mocap --unpacked runs/more -o runs/more.npz

The second command adds the recorded sources of the second delivery; ``--sources`` names others.
"""

from __future__ import annotations

import argparse
import json
import logging
from collections.abc import Collection, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from tqdm import tqdm

from motionrt.errors import FormatError, InvalidInputError, MotionFileNotFoundError, RigError
from motionrt.formats import MOTION_SUFFIXES, load_motion
from motionrt.formats.motion_pack import MotionPack
from motionrt.motion import Motion
from motionrt_training.corpora.cmu import read_cmu
from motionrt_training.corpora.corpus import SPLITS
from motionrt_training.corpora.mocap import CMU, CMU_LICENCE, Recording, provenance, read_mocap
from motionrt_training.data_record import DataRecord, data_record

FPS = 30.0
LOCOMOTION_LICENCE = "MIT"
LOCOMOTION_TEST = ("jl_walk_run_short",)  # held out: the other walk of the same rig is trained on
RECORDED = ("apache_snu", "cmu_more", "mit_snu_biped")
"""Sources of the second delivery that were recorded from people, under terms that let weights be shipped."""

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Recordings:
    """Recordings by number; ``ids`` and ``splits`` run beside ``pack``."""

    pack: MotionPack
    ids: tuple[str, ...]
    splits: tuple[str, ...]

    def __len__(self) -> int:
        return len(self.ids)

    def split(self, name: str) -> Iterator[tuple[str, Motion]]:
        """(id, motion) of every recording of a split, in file order."""
        if name not in SPLITS:
            raise InvalidInputError(f"split '{name}' is none of {SPLITS}")
        return ((self.ids[i], self.pack[i]) for i in range(len(self)) if self.splits[i] == name)

    def named(self, id_: str) -> Motion:
        """The recording called ``id_``."""
        if id_ not in self.ids:
            raise InvalidInputError(f"no recording '{id_}' among {len(self)}")
        return self.pack[self.ids.index(id_)]


def recording_files(folder: str | Path) -> Iterator[tuple[Path, str]]:
    """(file, split) of every recording of a mocap folder with ``cmu/`` and ``locomotion/``."""
    cmu = read_cmu(Path(folder) / "cmu")
    yield from sorted({(clip.path, clip.split) for clip in cmu.clips})
    for path in sorted((Path(folder) / "locomotion").iterdir()):
        if path.suffix.lower() in MOTION_SUFFIXES and "tpose" not in path.stem:
            yield path, "test" if path.stem in LOCOMOTION_TEST else "train"


def pack_recordings(
    folder: str | Path,
    out: str | Path,
    unpacked: str | Path | None = None,
    sources: Collection[str] = RECORDED,
    processes: int = 1,
) -> Recordings:
    """Read every recording, ground it, resample to 30 fps and write ``out`` and its ``.json``; returns them.

    Args:
        folder: holds ``cmu/`` (with ``captions.jsonl``) and ``locomotion/``.
        out: the ``.npz`` to write.
        unpacked: where the archives of ``more/`` were unpacked; None leaves the second delivery out.
        sources: which sources of it are read.
        processes: how many read at the same time.
    """
    files = list(recording_files(folder))
    more = [each for each in read_mocap(folder, unpacked) if each.source != CMU] if unpacked is not None else []
    more = [each for each in more if each.source in sources]
    jobs: list[Path | Recording] = [*(path for path, _ in files), *more]
    ids = [*(path.stem for path, _ in files), *(each.id for each in more)]
    splits = [*(split for _, split in files), *(each.split for each in more)]
    with ProcessPoolExecutor(processes) as pool:
        read = list(tqdm(pool.map(_read, jobs, chunksize=4), total=len(jobs), desc="recordings", unit="file"))
    kept = [k for k, motion in enumerate(read) if motion is not None]
    recordings = Recordings(
        MotionPack.of([motion for motion in read if motion is not None]),
        tuple(ids[k] for k in kept),
        tuple(splits[k] for k in kept),
    )
    of_cmu = sum(path.parent.parent.name == CMU for path, _ in files)
    record = data_record(CMU, of_cmu, CMU_LICENCE, "mocap.cs.cmu.edu")
    record += data_record("locomotion", len(files) - of_cmu, LOCOMOTION_LICENCE)
    write_recordings(recordings, Path(out), [*record, *provenance(more)])
    return recordings


def _read(job: Path | Recording) -> Motion | None:
    """Grounded, at 30 fps; None for a recording of the second delivery that is no person's."""
    if isinstance(job, Path):
        return load_motion(job).grounded().resample(FPS)
    try:
        return job.load().resample(FPS)
    except (FormatError, RigError) as error:
        log.warning("left out: %s: %s", job.id, error)
        return None


def write_recordings(recordings: Recordings, path: Path, record: DataRecord) -> None:
    """Write what :func:`load_recordings` reads, and whose data it is."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("wb") as file:
        recordings.pack.write(file)
    rows = {"ids": recordings.ids, "splits": recordings.splits, "provenance": record}
    path.with_suffix(".json").write_text(json.dumps(rows), encoding="utf-8")


def load_recordings(path: str | Path) -> Recordings:
    """Read what :func:`pack_recordings` wrote.

    Raises:
        MotionFileNotFoundError: no such file; the message gives the command that makes it.
        InvalidInputError: the two files do not belong together.
    """
    source = Path(path)
    if not (source.is_file() and source.with_suffix(".json").is_file()):
        raise MotionFileNotFoundError(
            f"{source} or its .json does not exist; make them with: "
            f"python -m motionrt_training.corpora.recordings MOCAP_FOLDER -o {source}"
        )
    rows = json.loads(source.with_suffix(".json").read_text(encoding="utf-8"))
    pack = MotionPack.read(source)
    if not len(pack) == len(rows["ids"]) == len(rows["splits"]):
        raise InvalidInputError(f"{source} and its .json differ in their number of recordings; make them again")
    return Recordings(pack, tuple(rows["ids"]), tuple(rows["splits"]))


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description="Read, ground, resample and pack every recording of a mocap folder.")
    parser.add_argument("folder", help="holds cmu/ (with captions.jsonl) and locomotion/")
    parser.add_argument("-o", "--out", required=True, help="the .npz to write; its .json stands beside it")
    parser.add_argument("--unpacked", help="where the archives of more/ were unpacked; without it they are left out")
    parser.add_argument("--sources", nargs="+", default=RECORDED, help="sources of more/ to read (default: recorded)")
    parser.add_argument("--processes", type=int, default=1, help="how many read at the same time (default: 1)")
    args = parser.parse_args()
    pack_recordings(args.folder, args.out, args.unpacked, args.sources, args.processes)


if __name__ == "__main__":
    main()
