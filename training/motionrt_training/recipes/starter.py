"""Make the starter gallery: motions that the shipped generator draws of prompts written for it.

    python -m motionrt_training.recipes.starter --to runtime/motionrt/_assets/starter

Of every prompt several motions are drawn. The one that the retrieval model likes best is taken among those that do what
the prompt says as far as it can be measured, with their feet on the floor; a prompt that no motion does is left out,
and said.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from motionrt import Gallery, Runtime
from motionrt.models import TextMotionModel
from motionrt.motion import Motion
from motionrt.motion.attributes import measure
from motionrt.motion.skeleton import SMPL24
from motionrt.retrieval import motion_features
from motionrt.text import agreement, parse_query
from motionrt_training.evaluate.prompts import read_prompts as prompts_of

AGREES, FLOATS = 0.75, 0.03
"""Least agreement of a motion with its prompt, and metres that its lowest toe may be off the floor on average."""
PROMPTS = Path(__file__).with_name("starter_prompts.txt")
_TOES = [SMPL24.index("left_foot"), SMPL24.index("right_foot")]


@dataclass(frozen=True)
class Drawn:
    """A motion of a prompt: how well it agrees, and its likeness to the prompt."""

    motion: Motion
    agreement: float
    likeness: float


def make(folder: Path, *, tries: int = 16, runtime: Runtime | None = None, prompts: Path = PROMPTS) -> list[str]:
    """Write the gallery with its motions to ``folder``; returns the prompts that nothing was good enough for."""
    rt = runtime or Runtime(text_tower="full")
    kept: list[tuple[str, Motion]] = []
    missing = []
    for number, (seconds, text) in enumerate(read_prompts(prompts)):
        best = chosen(draw(rt, text, seconds, tries, number), said=bool(parse_query(text).said))
        if best is None:
            missing.append(text)
        else:
            kept.append((text, best.motion))
    ids = [re.sub(r"[^a-z0-9]+", "-", text.lower()).strip("-") for text, _ in kept]
    texts, motions = [text for text, _ in kept], [motion for _, motion in kept]
    Gallery.from_motions(motions, ids, rt.model, texts=texts).save(folder)
    return missing


def draw(runtime: Runtime, text: str, seconds: float, tries: int, seed: int) -> list[Drawn]:
    """Motions of a prompt, measured."""
    motions = runtime.generate(text, seconds, n=tries, seed=seed)
    said = parse_query(text)
    likeness = _likeness(runtime.model, text, motions)
    agreements = [float(agreement(said, measure(motion))) for motion in motions]
    return [Drawn(*each) for each in zip(motions, agreements, likeness, strict=True)]


def chosen(drawn: Sequence[Drawn], *, said: bool) -> Drawn | None:
    """The likest of those that are good enough; where the prompt says nothing measurable, agreement does not count."""
    good = [one for one in drawn if (one.agreement >= AGREES or not said) and stands(one.motion)]
    return max(good, key=lambda one: one.likeness, default=None)


def stands(motion: Motion) -> bool:
    """Whether the lower toe is at the floor most of the time, or comes back to it."""
    lowest = motion.positions()[:, _TOES, 1].min(axis=1)
    return bool(abs(float(np.median(lowest))) <= FLOATS or float(np.percentile(lowest, 10)) <= FLOATS)


def read_prompts(path: Path) -> Iterator[tuple[float, str]]:
    """(seconds, prompt) of every line that is neither empty nor a comment."""
    return ((prompt.seconds, prompt.text) for prompt in prompts_of(path))


def _likeness(model: TextMotionModel, text: str, motions: Sequence[Motion]) -> list[float]:
    embedded = model.embed_motion([motion_features(motion) for motion in motions])
    return (embedded @ model.embed_text([text])[0]).tolist()


def main(arguments: Sequence[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description="Make the starter gallery.")
    parser.add_argument("--to", type=Path, default=Path("runtime/motionrt/_assets/starter"), help="the gallery")
    parser.add_argument("--tries", type=int, default=16, help="motions of every prompt")
    args = parser.parse_args(arguments)
    for text in make(args.to, tries=args.tries):
        print(f"nothing was good enough for: {text}")


if __name__ == "__main__":
    main()
