"""Everything that the networks are trained on, from any corpus, in one reading of its files.

    python -m motionrt_training.corpora.prepare babel BABEL --amass AMASS -o runs/mine

writes into the folder ``runs/mine``: ``pairs.npz`` for TMR, ``recordings.npz`` with its ``.json`` for WalkNet, TransNet
and the pose prior, ``captions.jsonl`` beside it for TEMOS and latent diffusion, and ``positions.npz`` for the views of
the motion denoiser. ``--parts`` takes body parts of labels from a file (``motionrt parts --file labels.txt -o
parts.jsonl``) instead of the rules. A recording with clips in several splits is held out as a whole, for validation
where it can be; its clips keep their own splits.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from motionrt.errors import FormatError, InvalidInputError, LabellingError, MotionFileNotFoundError
from motionrt.formats.motion_pack import MotionPack
from motionrt.motion import Motion
from motionrt.motion.body_parts import PARTS, checked_parts
from motionrt.synthesis.parts import RulesLabeller
from motionrt_training.command import reports_errors
from motionrt_training.corpora.cmu import caption_rows
from motionrt_training.corpora.corpus import Clip, MotionCorpus
from motionrt_training.corpora.pack import Row, pack, rows_of
from motionrt_training.corpora.positions import FPS as POSITION_FPS
from motionrt_training.corpora.positions import SHORTEST, write_positions
from motionrt_training.corpora.reading import add_options, read_named
from motionrt_training.corpora.recordings import FPS, Recordings, write_recordings
from motionrt_training.corpora.report import ReadReport
from motionrt_training.data_record import DataRecord, data_record

PartsOf = Callable[[str], frozenset[str]]
LEAST = 2  # frames of a clip
STRICTNESS = ("train", "test", "val")  # a whole recording is of the last of these that its clips are of


@dataclass
class Prepared:
    """What is written, while it grows recording by recording."""

    pairs: list[Row] = field(default_factory=list)
    motions: list[Motion] = field(default_factory=list)
    ids: list[str] = field(default_factory=list)
    splits: list[str] = field(default_factory=list)
    captions: list[dict[str, Any]] = field(default_factory=list)
    positions: list[tuple[Any, dict[str, Any]]] = field(default_factory=list)


def prepare(corpus: MotionCorpus, folder: str | Path, parts_of: PartsOf, record: DataRecord, seed: int = 1) -> Path:
    """Read every recording of a corpus once and write all packs into ``folder``; returns it.

    Raises:
        InvalidInputError: no recording of the corpus can be read.
    """
    found = Prepared()
    for path, clips in tqdm(list(_by_recording(corpus)), desc="preparing", unit="recording"):
        recording = corpus.recording(path)
        if recording is None:
            continue
        cuts = [(clip, motion) for clip in clips if (motion := corpus.cut(clip, recording)) and motion.frames >= LEAST]
        if cuts:
            _add(found, "/".join(path.with_suffix("").parts[-3:]), recording, cuts, parts_of, seed)
    if not found.motions:
        raise InvalidInputError(f"no recording of {corpus.name} can be read:\n{corpus.report or ''}")
    target = Path(folder)
    target.mkdir(parents=True, exist_ok=True)
    if record and not record[0]["recordings"]:
        record = [{**record[0], "recordings": len(found.motions)}, *record[1:]]
    pack(found.pairs, target / "pairs.npz", record=record)
    recordings = Recordings(MotionPack.of(found.motions), tuple(found.ids), tuple(found.splits))
    write_recordings(recordings, target / "recordings.npz", record)
    lines = (json.dumps(row, ensure_ascii=False) for row in found.captions)
    (target / "captions.jsonl").write_text("\n".join(lines) + "\n", encoding="utf-8")
    write_positions(found.positions, target / "positions.npz", record)
    return target


def _by_recording(corpus: MotionCorpus) -> Iterator[tuple[Path, list[Clip]]]:
    grouped: dict[Path, list[Clip]] = {}
    for clip in corpus.clips:
        grouped.setdefault(clip.path, []).append(clip)
    yield from grouped.items()


def _add(
    found: Prepared, id_: str, recording: Motion, clips: list[tuple[Clip, Motion]], parts_of: PartsOf, seed: int
) -> None:
    split = max((clip.split for clip, _ in clips), key=STRICTNESS.index)
    found.pairs += rows_of(clips, seed)
    found.motions.append(recording.resample(FPS))
    found.ids.append(id_)
    found.splits.append(split)
    found.captions += [_caption(clip, id_, recording.duration, parts_of) for clip, _ in clips]
    joints = np.asarray(recording.resample(POSITION_FPS).positions(), np.float32)
    if len(joints) >= SHORTEST:
        spans = [span for clip, _ in clips if clip.split == split and (span := _span(clip, len(joints)))]
        found.positions.append((joints, {"id": id_, "split": split, "source": clips[0][0].source, "segments": spans}))


def _caption(clip: Clip, id_: str, seconds: float, parts_of: PartsOf) -> dict[str, Any]:
    """A row of ``captions.jsonl``."""
    end = seconds if clip.end_s is None else min(clip.end_s, seconds)
    labels = [
        {"text": text, "parts": [part for part in PARTS if part in parts]}
        for text in clip.labels
        if (parts := parts_of(text))
    ]
    return {
        "id": clip.id, "trial": id_, "start_s": clip.start_s, "end_s": end, "split": clip.split, "labels": labels,
        "captions": list(clip.texts),
    }  # fmt: skip


def _span(clip: Clip, frames: int) -> list[Any] | None:
    first = round(clip.start_s * POSITION_FPS)
    end = frames if clip.end_s is None else min(frames, round(clip.end_s * POSITION_FPS) + 1)
    return [first, end - first, list(clip.texts), list(clip.labels)] if end - first >= SHORTEST else None


def parts_by_rules() -> PartsOf:
    """The rules' labeller; no parts for labels that it does not know."""
    rules = RulesLabeller()

    def find(text: str) -> frozenset[str]:
        try:
            return rules(text)
        except LabellingError:
            return frozenset()

    return find


def parts_from(path: str | Path) -> PartsOf:
    """Body parts of labels as a file has them, ``{"text": ..., "parts": [...]}`` a line; by the rules for others.

    Raises:
        MotionFileNotFoundError: no such file.
        FormatError: a line that is not JSON, or misses a key, with its number.
    """
    source, known, rules = Path(path), dict[str, frozenset[str]](), parts_by_rules()
    if not source.is_file():
        raise MotionFileNotFoundError(f"{source} does not exist; make it with: motionrt parts --file labels.txt -o ...")
    for line, row in caption_rows(source):
        try:
            known[row["text"]] = checked_parts(row["parts"]) if row["parts"] else frozenset()
        except (KeyError, TypeError, InvalidInputError) as error:
            raise FormatError(source, f"a row of text and parts misses or garbles {error}", line) from None
    return lambda text: known[text] if text in known else rules(text)


@reports_errors
def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description="Read a corpus once and write all that the networks are trained on.")
    add_options(parser)
    parser.add_argument("--parts", type=Path, help="body parts of labels (default: by the rules)")
    parser.add_argument("--list-labels", type=Path, help="write the action labels here, one a line, and read no motion")
    parser.add_argument("-o", "--out", type=Path, help="the folder to write into")
    args = parser.parse_args()
    corpus = read_named(args)
    if args.list_labels is not None:
        labels = dict.fromkeys(label for clip in corpus.clips for label in clip.labels)
        args.list_labels.write_text("\n".join(labels) + "\n", encoding="utf-8")
        print(f"{args.list_labels}: {len(labels)} labels")
        return
    if args.out is None:
        raise InvalidInputError("name the folder to write into with -o")
    parts_of = parts_by_rules() if args.parts is None else parts_from(args.parts)
    record = data_record(corpus.name, 0, args.licence, args.origin)
    prepare(corpus, args.out, parts_of, record)
    print(corpus.report or ReadReport(corpus.name))


if __name__ == "__main__":
    main()
