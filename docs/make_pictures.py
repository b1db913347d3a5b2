"""Draw the README's filmstrips: for each query the first hit of a gallery, as stick figures over time.

    pip install ".[render]"
    python docs/make_pictures.py -o docs/images/retrieve.png "a person walks in a circle" [--gallery DIR]

Left limbs are blue, right limbs red; time runs from left to right.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import matplotlib as mpl
import numpy as np
import numpy.typing as npt

from motionrt import Motion, Runtime
from motionrt.motion.rotations import axis_rotation
from motionrt.motion.skeleton import SMPL24

mpl.use("Agg")
import matplotlib.pyplot as plt

POSES, SPACING, VIEW = 12, 0.95, np.radians(-55)
COLOURS = {"left": "#2b6cb0", "right": "#c53030", "middle": "#2d3748"}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("queries", nargs="+")
    parser.add_argument("--gallery", help="a gallery (default: the starter gallery)")
    parser.add_argument("-o", "--out", type=Path, required=True)
    args = parser.parse_args()
    runtime = Runtime()
    figure, axes = plt.subplots(len(args.queries), 1, figsize=(11, 1.9 * len(args.queries)), squeeze=False)
    for axis, query in zip(axes[:, 0], args.queries, strict=True):
        hit = runtime.retrieve(query, 1, args.gallery)[0]
        draw(axis, runtime.gallery(args.gallery).motion(hit).canonical())
        axis.set_title(f"“{query}”  →  {hit.id}  ({hit.score:.2f})", loc="left", fontsize=10)
    figure.tight_layout()
    args.out.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(args.out, dpi=80)


def draw(axis: plt.Axes, motion: Motion) -> None:
    """Poses at equal times, side by side, seen half from the front."""
    turn = axis_rotation("Y", VIEW)
    for column, frame in enumerate(np.linspace(0, motion.frames - 1, POSES).astype(int)):
        joints = motion.positions()[frame]
        local = (joints - joints[0] * [1, 0, 1]) @ turn.T
        bones(axis, local[:, :2] + [column * SPACING, 0.0])
    axis.axhline(0, color="#a0aec0", lw=0.8, zorder=0)
    top = max(1.9, float(motion.positions()[..., 1].max()) + 0.2)
    axis.set(xlim=(-0.6, POSES * SPACING - 0.35), ylim=(-0.1, top), aspect="equal")
    axis.axis("off")


def bones(
    axis: plt.Axes, points: npt.NDArray[np.floating], lw: float = 2.0, alpha: float = 1.0, zorder: float = 2
) -> None:
    """A stick figure of the joints ``(24, 2)`` as they lie on the paper."""
    for joint, parent in enumerate(SMPL24.parents):
        if parent >= 0:
            colour = COLOURS.get(SMPL24.names[joint].split("_")[0], COLOURS["middle"])
            ends = points[[parent, joint]].T
            axis.plot(*ends, color=colour, lw=lw, alpha=alpha, solid_capstyle="round", zorder=zorder)
    neck, head = (points[SMPL24.index(name)] for name in ("neck", "head"))
    crown = head + 0.8 * (head - neck)
    axis.plot(*crown, "o", color=COLOURS["middle"], ms=3 * lw, alpha=alpha, mew=0, zorder=zorder)


if __name__ == "__main__":
    main()
