"""Draw the README's picture of generated motion: a strip of poses for each prompt, all in one picture.

    pip install ".[render]"
    python docs/generate_pictures.py -o docs/images/generate.png ["jump forward" ...] [--seconds 4] [--seed 0]

Left limbs are blue, right limbs red, time runs from left to right; thin lines are the ways of hands and feet.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from textwrap import shorten

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
from make_pictures import COLOURS, bones

from motionrt import Motion, Runtime
from motionrt.motion.rotations import axis_rotation
from motionrt.motion.skeleton import SMPL24
from motionrt.motion.transforms import heading

mpl.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.collections import LineCollection

Floats = npt.NDArray[np.float64]

PROMPTS = (
    "jump forward with both feet",
    "climbing a ladder hand over hand",
    "several deep squats",
    "drinking from a bottle",
    "a person sits down on a stool",
    "wave the right hand while walking",
)
COLUMNS, POSES, SPACING = 2, 8, 0.92  # metres on the paper between poses
EYE = np.radians(-40)  # from the front of the first pose to its right
GROUND, TEXT, FAINT = "#cbd5e0", "#1a202c", "#718096"
TRAILS = tuple((side, SMPL24.index(f"{side}_{joint}")) for side in ("left", "right") for joint in ("wrist", "ankle"))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("prompts", nargs="*", default=PROMPTS, help="default: six that the README shows")
    parser.add_argument("-o", "--out", type=Path, required=True)
    parser.add_argument("--seconds", type=float, default=4.0, help="of every motion (default: 4)")
    parser.add_argument("--seed", type=int, default=0, help="the same for all prompts (default: 0)")
    parser.add_argument("--sampler", help="diffusion or vae (default: that of generate)")
    parser.add_argument("--models", type=Path, help="models manifest or folder (default: the shipped models)")
    args = parser.parse_args()
    how = {"sampler": args.sampler} if args.sampler else {}
    motions = Runtime(args.models).generate(list(args.prompts), args.seconds, seed=args.seed, **how)
    args.out.parent.mkdir(parents=True, exist_ok=True)
    picture(args.prompts, motions).savefig(args.out, dpi=144)


def picture(prompts: Sequence[str], motions: Sequence[Motion]) -> plt.Figure:
    """A strip for each prompt, in two columns; all figures have one size."""
    paper = [on_paper(motion) for motion in motions]
    tops = [max(1.75, float(points[..., 1].max()) + 0.1) for points in paper]
    rows = [max(tops[first : first + COLUMNS]) for first in range(0, len(paper), COLUMNS)]
    figure, axes = plt.subplots(
        len(rows), COLUMNS, figsize=(11, 0.3 + sum(0.74 * (top + 0.6) for top in rows)),
        height_ratios=[top + 0.6 for top in rows], squeeze=False,
    )  # fmt: skip
    for axis in axes.flat:
        axis.axis("off")
    for axis, prompt, motion, points, row in zip(
        axes.flat, prompts, motions, paper, np.repeat(rows, COLUMNS), strict=False
    ):
        draw(axis, prompt, motion, points, float(row))
    figure.subplots_adjust(0.01, 0.01, 0.99, 0.99, wspace=0.03, hspace=0.0)
    return figure


def draw(axis: plt.Axes, prompt: str, motion: Motion, points: Floats, top: float) -> None:
    """One strip: the caption, the ground with its seconds, the ways of the limbs, the poses."""
    width = (POSES - 1) * SPACING
    axis.plot([-0.65, width + 0.65], [0, 0], color=GROUND, lw=1.2, solid_capstyle="round", zorder=0)
    for second in range(int(motion.duration) + 1):
        at = width * min(1.0, second * motion.fps / max(motion.frames - 1, 1))
        axis.plot([at, at], [0, -0.06], color=GROUND, lw=1.2, zorder=0)
        axis.text(at, -0.1, f"{second} s", color=FAINT, fontsize=6.5, ha="center", va="top")
    trails(axis, points)
    for frame in np.linspace(0, motion.frames - 1, POSES).round().astype(int):
        bones(axis, points[frame], lw=2.1, zorder=3 + frame / motion.frames)
    axis.text(-0.65, top + 0.28, f"“{shorten(prompt, 60)}”", color=TEXT, fontsize=10.5, va="top")
    axis.set(xlim=(-0.75, width + 0.75), ylim=(-0.27, top + 0.33), aspect="equal")


def on_paper(motion: Motion) -> Floats:
    """``(F, 24, 2)``: seen from one side, the pelvis moved along the strip with time."""
    turn = axis_rotation("Y", EYE - float(heading(motion)[0]))
    joints = motion.positions().astype(np.float64)
    seen = (joints - joints[:, :1] * np.array([1.0, 0.0, 1.0])) @ turn.T
    along = np.linspace(0, (POSES - 1) * SPACING, motion.frames)
    return np.stack([seen[..., 0] + along[:, None], seen[..., 1]], axis=-1)


def trails(axis: plt.Axes, points: Floats) -> None:
    """The ways of wrists and ankles."""
    for side, joint in TRAILS:
        way = points[:, joint]
        axis.add_collection(
            LineCollection(np.stack([way[:-1], way[1:]], axis=1), colors=COLOURS[side], lw=0.8, alpha=0.4, zorder=1)
        )


if __name__ == "__main__":
    main()
