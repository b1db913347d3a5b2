"""What notebooks show: strips of stick figures in SVG, and tables; drawn with NumPy alone, no extra is needed."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

import numpy as np

from motionrt.motion.frames import Frames
from motionrt.motion.skeleton import FloatArray

POSES = 8
PICTURED = 3
"""Clips that are drawn where a notebook shows many."""
_HEIGHT, _CELL, _MARGIN = 150.0, 110.0, 8.0  # pixels
_VIEW = np.radians(35.0)  # from the character's front towards its left: a three-quarter view
_COLOURS = {"left": "#2f7bc8", "right": "#c8452f", "": "#777777"}


def strip(motion: Frames, poses: int = POSES) -> str:
    """SVG of ``poses`` poses at equal distances in time, each above its own place, seen from the front and the left.

    Left limbs are blue, right limbs red. All poses have the same scale; the seconds stand below.
    """
    frames = np.unique(np.linspace(0, motion.frames - 1, min(poses, motion.frames)).round().astype(int))
    places = np.concatenate([motion[frame : frame + 1].positions() for frame in frames.tolist()])
    flat = _seen(places)
    low, high = flat[..., 1].min(), flat[..., 1].max()
    scale = min(_HEIGHT / max(high - low, 1e-6), (_CELL - _MARGIN) / max(np.ptp(flat[..., 0], axis=1).max(), 1e-6))
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{_CELL * len(frames):.0f}" height="{_HEIGHT + 28:.0f}" '
        'role="img" font-family="sans-serif" font-size="11">'
    ]
    for cell, (frame, pose) in enumerate(zip(frames.tolist(), flat, strict=True)):
        middle = _CELL * (cell + 0.5) - scale * (pose[:, 0].min() + pose[:, 0].max()) / 2
        drawn = np.stack([middle + scale * pose[:, 0], _MARGIN + scale * (high - pose[:, 1])], axis=1)
        parts += _figure(drawn, motion.skeleton.names, motion.skeleton.parents)
        place = f'x="{_CELL * (cell + 0.5):.0f}" y="{_HEIGHT + 24:.0f}" text-anchor="middle" fill="#777"'
        parts.append(f"<text {place}>{frame / motion.fps:.1f} s</text>")
    return "".join([*parts, "</svg>"])


def page(title: str, *parts: str) -> str:
    """HTML of a heading, which is escaped, and of parts, which are HTML."""
    return "".join(["<div>", f"<div>{escape(title)}</div>", *parts, "</div>"])


def table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """HTML of a table whose cells are escaped."""
    lines = ["".join(f"<td>{escape(cell)}</td>" for cell in row) for row in rows]
    head = "".join(f"<th>{escape(cell)}</th>" for cell in header)
    return "".join(["<table>", f"<tr>{head}</tr>", *(f"<tr>{line}</tr>" for line in lines), "</table>"])


def _seen(places: FloatArray) -> FloatArray:
    """``(P, J, 2)``: right and up in the picture of every pose above its own place, ``(P, J, 3)`` in the world."""
    local = places - places[:, :1] * np.array([1, 0, 1], np.float32)
    first = local[0]
    across = first[1] - first[2] if len(first) > 2 else np.array([1.0, 0, 0])  # from the right hip to the left
    facing = float(np.arctan2(-across[2], across[0]))
    turn = facing + _VIEW
    right = local[..., 0] * np.cos(turn) - local[..., 2] * np.sin(turn)
    return np.stack([right, local[..., 1]], axis=-1)


def _figure(drawn: FloatArray, names: tuple[str, ...], parents: tuple[int, ...]) -> list[str]:
    lines = []
    for joint, parent in enumerate(parents):
        if parent >= 0:
            side = next((side for side in ("left", "right") if names[joint].startswith(side)), "")
            (a, b), (c, d) = drawn[parent], drawn[joint]
            lines.append(
                f'<line x1="{a:.1f}" y1="{b:.1f}" x2="{c:.1f}" y2="{d:.1f}" stroke="{_COLOURS[side]}" '
                'stroke-width="4" stroke-linecap="round"/>'
            )
    if "head" in names:
        x, y = drawn[names.index("head")]
        lines.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="7" fill="{_COLOURS[""]}"/>')
    return lines
