"""BABEL as SINC trains on it: single actions, and the stretches in which two actions overlap [SINC 4.1].

A pair lasts as long as both of its labels hold; singles and pairs last from 0.5 to 20 s. Pairs of the validation files
are the test set: without those of 'stand' and those whose two labels are a pair of the training files as well. Singles
of the validation files are for validation.
"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

from motionrt_training.corpora.babel import Label, read_sequences
from motionrt_training.corpora.corpus import Clip, MotionCorpus
from motionrt_training.corpora.report import ReadReport

SHORTEST, LONGEST = 0.5, 20.0
STAND = "stand"


def read_babel_pairs(
    folder: str | Path, amass: str | Path, *, spelling: str = "proc", every: bool = False
) -> MotionCorpus:
    """Single actions and simultaneous pairs of BABEL.

    ``every`` keeps all pairs of the test set, those of 'stand' and those seen in training, too; the others as in
    :func:`motionrt_training.corpora.babel.read_babel`.
    """
    corpus = read_sequences("babel_pairs", folder, amass, _singles_and_pairs, spelling)
    report = corpus.report or ReadReport(corpus.name)
    clips = corpus.clips if every else tuple(_fresh(corpus.clips, report))
    report.found.clear()
    report.count(clip.split for clip in clips)
    return MotionCorpus(corpus.name, clips, report=report)


def overlaps(labels: list[Label]) -> list[tuple[float, float, tuple[str, str]]]:
    """(start, end, texts) of every stretch in which exactly two labels hold, in order of time."""
    edges = sorted({edge for label in labels for edge in (label.start, label.end)})
    found: list[tuple[float, float, tuple[str, str]]] = []
    for start, end in pairwise(edges):
        active = [label.text for label in labels if label.start <= start and label.end >= end]
        if len(active) == 2 and active[0] != active[1]:
            found.append((start, end, (active[0], active[1])))
    return found


def _singles_and_pairs(key: str, path: Path, labels: list[Label], split: str, report: ReadReport) -> list[Clip]:
    clips = [
        Clip(f"{key}_{number}", path, one.start, one.end, (one.text,), split, (one.text,), categories=one.categories)
        for number, one in enumerate(labels)
        if _fits(f"{key}_{number}", one.start, one.end, report)
    ]
    held_out = "test" if split == "val" else split
    for number, (start, end, pair) in enumerate(overlaps(labels)):
        name = f"{key}_pair_{number}"
        if _fits(name, start, end, report):
            clips.append(Clip(name, path, start, end, (" while ".join(pair),), held_out, pair))
    return clips


def _fits(name: str, start: float, end: float, report: ReadReport) -> bool:
    fits = SHORTEST <= end - start <= LONGEST
    if not fits:
        report.skip(name, f"shorter than {SHORTEST:g} s or longer than {LONGEST:g} s")
    return fits


def _fresh(clips: tuple[Clip, ...], report: ReadReport) -> list[Clip]:
    seen = {frozenset(clip.labels) for clip in clips if len(clip.labels) > 1 and clip.split == "train"}
    kept = []
    for clip in clips:
        if clip.split == "test" and STAND in {label.lower() for label in clip.labels}:
            report.skip(clip.id, "a pair of the test set with 'stand'")
        elif clip.split == "test" and frozenset(clip.labels) in seen:
            report.skip(clip.id, "a pair of the test set that training has, too")
        else:
            kept.append(clip)
    return kept
