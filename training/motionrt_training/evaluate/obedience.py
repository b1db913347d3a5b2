"""Do generated motions do what their texts say, attribute by attribute, and how that depends on the steps?

    python -m motionrt_training.evaluate.obedience --seeds 16
    python -m motionrt_training.evaluate.obedience --seeds 4 --steps 3 4 6 8 12 20

Own validation prompts, one draw a seed through `Runtime.generate`; what is said is compared with what is measured
(`motionrt.text.agreement`). Motions of the other prompts and a pose that is held, under the same texts, say what
agreement is worth. Markdown goes to the screen or to -o.
"""

from __future__ import annotations

import argparse
import time
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import numpy as np

from motionrt import Runtime, metrics
from motionrt.motion import Motion
from motionrt.motion.attributes import Attributes, measure
from motionrt.text import TextAttributes, agreement, parse_query
from motionrt_training.evaluate.prompts import held
from motionrt_training.evaluate.tables import markdown
from motionrt_training.generator_trial import PASSED, PROMPTS, read_prompts

SECONDS = 4.0
GROUPS: Mapping[str, tuple[str, ...]] = {
    "turn": ("turn", "turn_side"),
    "path": ("path", "path_side"),
    "travel": ("travel", "speed"),
    "side of a limb": ("arm", "leg", "foot_lift"),
    "hands": ("arms_up", "hands_low", "hands_together", "claps"),
    "posture": ("posture_end", "posture_lowest", "level", "lean"),
    "air": ("jumps",),
    "still": ("still",),
}
"""Attributes of a text by what they are about."""


@dataclass(frozen=True)
class Drawn:
    """Motions of prompts, one list for every prompt, and the median seconds that one took."""

    texts: tuple[str, ...]
    motions: list[list[Motion]]
    seconds: float


def draw(runtime: Runtime, texts: Sequence[str], seeds: int, steps: int | None = None) -> Drawn:
    """Motions of every text with seeds 0, 1, ..."""
    motions: list[list[Motion]] = []
    times: list[float] = []
    for text in texts:
        row = []
        for seed in range(seeds):
            began = time.perf_counter()
            row.append(runtime.generate(text, SECONDS, seed=seed, steps=steps))
            times.append(time.perf_counter() - began)
        motions.append(row)
    return Drawn(tuple(texts), motions, median(times))


def by_attribute(drawn: Drawn) -> list[list[object]]:
    """Rows of the first table: texts that say it, the share of motions that pass, and that of others and of a pose."""
    said = [parse_query(text) for text in drawn.texts]
    seen = [[measure(motion) for motion in row] for row in drawn.motions]
    frozen = [[measure(held(motion)) for motion in row] for row in drawn.motions]
    everything = [attributes for row in seen for attributes in row]
    members: dict[str, list[int]] = defaultdict(list)
    for number, text in enumerate(said):
        for group, names in GROUPS.items():
            if any(name in text.said for name in names):
                members[group].append(number)
        if text.said:
            members["all"].append(number)
    rows: list[list[object]] = []
    for group in (*GROUPS, "all"):
        numbers = members[group]
        if numbers:
            own = [share(said[number], seen[number]) for number in numbers]
            still = [share(said[number], frozen[number]) for number in numbers]
            others = [share(said[number], everything) for number in numbers]
            rows.append([group, len(numbers), *(f"{100 * np.mean(part):.0f}" for part in (own, others, still))])
    return rows


def share(said: TextAttributes, motions: Sequence[Attributes]) -> float:
    """Share of measured motions that do what is said."""
    return float(np.mean([float(agreement(said, attributes)) >= PASSED for attributes in motions]))


def by_steps(runtime: Runtime, texts: Sequence[str], seeds: int, steps: Sequence[int]) -> list[list[object]]:
    """Rows of the second table: steps, passing and mean agreement, skate, jerk, energy, milliseconds."""
    rows: list[list[object]] = []
    for count in steps:
        drawn = draw(runtime, texts, seeds, count)
        scores = [
            float(agreement(parse_query(text), measure(motion)))
            for text, row in zip(texts, drawn.motions, strict=True)
            for motion in row
        ]
        motions = [motion for row in drawn.motions for motion in row]
        looks = [
            np.mean([how(motion) for motion in motions])
            for how in (
                lambda motion: metrics.foot_skate(motion.positions()),
                lambda motion: metrics.jerk(motion.positions(), motion.fps),
                lambda motion: metrics.motion_energy(motion.positions(), motion.fps),
            )
        ]
        passed = 100 * np.mean([score >= PASSED for score in scores])
        shown = [f"{passed:.0f}", f"{np.mean(scores):.2f}", f"{looks[0]:.2f}", f"{looks[1]:.0f}", f"{looks[2]:.2f}"]
        rows.append([count, *shown, f"{1000 * drawn.seconds:.0f}"])
    return rows


def main(arguments: Sequence[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--models", type=Path, help="models manifest or folder (default: the shipped ones)")
    parser.add_argument("--prompts", type=Path, default=PROMPTS, help="a text a line")
    parser.add_argument("--seeds", type=int, default=16, help="motions of every text (default: %(default)s)")
    parser.add_argument("--steps", type=int, nargs="+", help="the table of these steps instead")
    parser.add_argument("-o", "--out", type=Path, help="write the Markdown there instead of printing it")
    args = parser.parse_args(arguments)
    runtime, texts = Runtime(args.models), read_prompts(args.prompts)
    if args.steps:
        head = ["steps", "pass, %", "agreement", "foot skate", "jerk", "energy", "ms"]
        page = markdown(head, by_steps(runtime, texts, args.seeds, args.steps))
    else:
        head = ["what is said", "texts", "pass, %", "motions of other texts", "first pose, held"]
        page = markdown(head, by_attribute(draw(runtime, texts, args.seeds)))
    if args.out:
        args.out.write_text(page + "\n", encoding="utf-8")
    else:
        print(page)


if __name__ == "__main__":
    main()
