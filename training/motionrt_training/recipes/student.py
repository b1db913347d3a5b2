"""Distil TMR's text tower, sentence encoder included, into a small one.

    python -m motionrt_training.recipes.student --corpus runs/mocap.npz --teacher runs/tmr/best.pt --out runs/student \
        --sentences 100000 --minutes 15

The teacher reads every caption of the training split, their mirror images, and as many sentences of a grammar
(`motionrt_training.wording`); what it says of them is kept in the run's folder. The command goes on where it stopped.
"""

from __future__ import annotations

import argparse
import dataclasses
import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import torch
from numpy.typing import NDArray

from motionrt_training.backbones import MiniLMBackbone
from motionrt_training.checkpoint import load_any
from motionrt_training.data_record import data_of
from motionrt_training.networks.tmr import TMR
from motionrt_training.options import from_namespace, recipe_parser
from motionrt_training.packed import PackedCorpus, load_packed
from motionrt_training.student_task import Examination, Lesson, StudentSettings, StudentTask
from motionrt_training.text_cache import cached_features
from motionrt_training.trainer import Schedule, Trainer
from motionrt_training.validation import embed_motions, embed_texts
from motionrt_training.wording.grammar import sentences

LONGEST = 200  # frames of a motion that are embedded


def train(args: argparse.Namespace) -> dict[str, float]:
    """Train into `args.out`; returns the last validation."""
    schedule, settings = from_namespace(Schedule, args), from_namespace(StudentSettings, args)
    if schedule.threads:
        torch.set_num_threads(schedule.threads)
    corpus, teacher, backbone = load_packed(args.corpus), load_any(args.teacher, TMR), MiniLMBackbone()
    digest = hashlib.sha256(Path(args.teacher).read_bytes()).hexdigest()
    school = School(teacher, backbone, args.cache or Path(args.corpus).parent, args.out / f"lessons-{digest[:12]}")
    spoken = school.lesson("captions", corpus.texts())
    place = {text: number for number, text in enumerate(corpus.texts())}
    captions = spoken.chosen([place[text] for text in _training_texts(corpus)])
    made = school.lesson("grammar", sentences(args.sentences, np.random.default_rng(schedule.seed)))
    exams = {split: _examination(teacher, corpus, spoken, place, split) for split in ("val", "test")}
    known = _motions(teacher, corpus, "train", args.motions)
    task = StudentTask(captions, made, known, exams, backbone.model, settings, schedule.seed)
    notes = {
        **dataclasses.asdict(settings),
        "teacher_sha256": digest,
        "sentences": len(captions) + len(made),
        "network": task.model.config,
    }
    return Trainer(task, schedule, args.out, notes, args.init, data_of(args.corpus)).run()


class School:
    """What the teacher says of texts: features of its backbone from the cache, its embeddings kept in a folder."""

    def __init__(self, teacher: TMR, backbone: MiniLMBackbone, cache: Path, folder: Path) -> None:
        self.teacher, self.backbone, self.cache, self.folder = teacher, backbone, cache, folder

    def lesson(self, name: str, texts: Sequence[str]) -> Lesson:
        """Token ids and the teacher's embeddings of `texts`."""
        ids = [np.array(one.ids, dtype=np.int64) for one in self.backbone.tokenizer.encode_batch(list(texts))]
        path = self.folder / f"{name}-{len(texts)}.npy"
        if not path.is_file():
            features = cached_features(texts, self.backbone, self.cache)
            found = embed_texts(self.teacher, [features.of(number) for number in range(len(texts))])
            path.parent.mkdir(parents=True, exist_ok=True)
            np.save(path, found.numpy().astype(np.float16))
        return Lesson(ids, np.load(path))


def _examination(
    teacher: TMR, corpus: PackedCorpus, spoken: Lesson, place: Mapping[str, int], split: str
) -> Examination:
    """The captions of a split by style, and its motions."""
    clips = corpus.split(split)
    count = min(len(clip.texts) for clip in clips)
    styles = [spoken.chosen([place[clip.texts[number]] for clip in clips]) for number in range(count)]
    return Examination(styles, _motions(teacher, corpus, split))


def _training_texts(corpus: PackedCorpus) -> list[str]:
    clips = corpus.split("train")
    parts = [part for clip in clips for part in (clip, *clip.windows)]
    return list(dict.fromkeys(text for part in parts for text in (*part.texts, *part.texts_mirror)))


def _motions(teacher: TMR, corpus: PackedCorpus, split: str, most: int | None = None) -> NDArray[np.float32]:
    """Unit embeddings (M, 256) of the first 10 s of the clips of a split, at most so many, evenly drawn."""
    clips = corpus.split(split)
    step = max(1, len(clips) // most) if most else 1
    shown = [corpus.motion(clip)[:LONGEST].astype(np.float32) for clip in clips[::step]]
    return np.asarray(embed_motions(teacher, shown).numpy(), dtype=np.float32)


def parser() -> argparse.ArgumentParser:
    """Every setting with its default."""
    result = recipe_parser("Distil TMR's text tower.", Schedule, StudentSettings)
    result.add_argument("--teacher", type=Path, required=True, help="best.pt or .safetensors of TMR")
    result.add_argument("--cache", type=Path, help="folder of text features (default: beside the corpus)")
    result.add_argument("--sentences", type=int, default=80000, help="sentences of the grammar (default: %(default)s)")
    result.add_argument(
        "--motions", type=int, default=1000, help="motions whose ranks are learnt (default: %(default)s)"
    )
    return result


def main(arguments: Sequence[str] | None = None) -> None:
    """The command line."""
    train(parser().parse_args(arguments))


if __name__ == "__main__":
    main()
