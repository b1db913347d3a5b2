"""Draw the README's picture of generated motion: a strip of poses for each prompt, all in one picture.

    pip install ".[render]"
    python docs/generate_pictures.py -o docs/images/generate.png ["jump forward" ...] [--seconds 4] [--seed 0]

Left limbs are blue, right limbs red, time runs from left to right; thin lines are the ways of hands and feet.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from motionrt import Runtime, render

PROMPTS = (
    "kick with the left foot",
    "jump forward",
    "a person raises both arms above the head",
    "walk in a circle to the left",
    "crawl on hands and knees",
    "squat down",
)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("prompts", nargs="*", default=PROMPTS, help="default: six that the README shows")
    parser.add_argument("-o", "--out", type=Path, required=True)
    parser.add_argument("--seconds", type=float, default=4.0, help="of every motion (default: 4)")
    parser.add_argument("--seed", type=int, default=0, help="the same for all prompts (default: 0)")
    parser.add_argument("--sampler", help="motion, diffusion or vae (default: motion)")
    parser.add_argument("--models", type=Path, help="models manifest or folder (default: the shipped models)")
    args = parser.parse_args()
    how = {"sampler": args.sampler} if args.sampler else {}
    motions = Runtime(args.models).generate(list(args.prompts), args.seconds, seed=args.seed, candidates=8, **how)
    args.out.parent.mkdir(parents=True, exist_ok=True)
    captions = [f"“{prompt}”" for prompt in args.prompts]
    render(motions, args.out, captions=captions, columns=2, poses=8, camera=40, trails=True, size=(1600, 0))


if __name__ == "__main__":
    main()
