"""What the commands that make motion share: options of the generator, and what they say of motions written."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from motionrt.cli.console import say
from motionrt.cli.measures import rounded

if TYPE_CHECKING:
    from motionrt.motion import Motion


def add_chance(parser: argparse.ArgumentParser) -> None:
    """``--seed``, ``--temperature`` and ``--sampler``."""
    parser.add_argument("--seed", type=int, metavar="N", help="the same seed, the same motion (default: a new one)")
    parser.add_argument("--temperature", type=float, default=1.0, metavar="T", help="0 is the mean (default: 1)")
    parser.add_argument("--sampler", metavar="NAME", help="motion, diffusion or vae")


def chance(arguments: argparse.Namespace) -> dict[str, object]:
    """The keyword arguments that :func:`add_chance` stands for; a seed that nobody gave is drawn."""
    from motionrt.synthesis.sampling import DEFAULT_SAMPLER, fresh_seed

    seed = fresh_seed() if arguments.seed is None else arguments.seed
    sampler = DEFAULT_SAMPLER if arguments.sampler is None else arguments.sampler
    return {"seed": seed, "temperature": arguments.temperature, "sampler": sampler}


def tell_seed(arguments: argparse.Namespace, seed: object) -> None:
    """Say which seed was drawn, where nobody gave one and one was needed."""
    if arguments.seed is None and seed is not None:
        say(f"seed {seed}: --seed {seed} makes the same again")


def as_json(motion: Motion, path: Path) -> dict[str, object]:
    """What ``--json`` says of a motion that was made and written."""
    return {
        "path": str(path),
        "frames": motion.frames,
        "fps": motion.fps,
        **rounded({"seconds": motion.duration, "foot_skate_cm": skate(motion)}),
    }


def skate(motion: Motion) -> float:
    """Foot skate in cm per frame at 30 fps, over the floor of the motion."""
    from motionrt.metrics.locomotion import foot_skate

    return foot_skate(motion.resample(30.0).grounded().positions()) if motion.frames > 1 else 0.0
