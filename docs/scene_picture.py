"""Draw what a script plays: the room from above, the character along its way, and its poses side by side.

    pip install ".[render]"
    python docs/scene_picture.py examples/living_room.yaml -o docs/images/perform.png [--models PATH]

Left limbs are blue, right limbs red. In the room, strong figures hold a pose and pale ones are on their way.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
from make_pictures import bones

from motionrt import Performance, Runtime, Script
from motionrt.locomotion.performance import Segment
from motionrt.locomotion.words import load_cloud

mpl.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.patches import Polygon

Floats = npt.NDArray[np.float64]

ELEVATION, TURN = np.radians(38), np.radians(24)  # of the eye above the ground, and to the side
FLOOR, WALL, WAY = "#edf2f7", "#a0aec0", "#718096"
THING, SHADE = "#b7791f", "#d6d3cd"
APART = 1.3  # metres between figures on their way
CLOSE_UPS = 9


@dataclass(frozen=True)
class Room:
    """Polygons ``(N, 2)`` of x and z: where one may walk, and what stands there, with its points ``(n, 3)``."""

    floor: list[Floats]
    things: list[tuple[Floats, Floats]]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("script", type=Path, help="a script whose scene is made of polygons")
    parser.add_argument("-o", "--out", type=Path, required=True)
    parser.add_argument("--models", type=Path, help="models manifest or folder (default: the shipped models)")
    args = parser.parse_args()
    script = Script.read(args.script)
    figure = picture(Runtime(args.models).play(script), room_of(script))
    args.out.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(args.out, dpi=80)


def room_of(script: Script) -> Room:
    """The script's polygons, and the points of its cloud that stand on them."""
    if script.scene is None:
        return Room([], [])
    points = load_cloud(script.cloud).points.astype(float) if script.cloud else np.zeros((0, 3))
    things = [np.array(outline, float) for outline in script.scene.obstacles]
    return Room([np.array(outline, float) for outline in script.scene.floor], [(t, _above(t, points)) for t in things])


def _above(outline: Floats, points: Floats) -> Floats:
    low, high = outline.min(axis=0) - 0.02, outline.max(axis=0) + 0.02
    within = ((points[:, [0, 2]] >= low) & (points[:, [0, 2]] <= high)).all(axis=1)
    return np.asarray(points[within & (points[:, 1] > 0.05)])


def picture(performance: Performance, room: Room) -> plt.Figure:
    """The room above, poses side by side below."""
    positions = performance.motion.positions().astype(float)
    figure, (above, below) = plt.subplots(2, 1, figsize=(11, 9.4), height_ratios=(3.3, 1))
    draw_room(above, positions, performance, room)
    draw_poses(below, positions, performance.segments)
    figure.tight_layout()
    return figure


# -- the room


def draw_room(axis: plt.Axes, positions: Floats, performance: Performance, room: Room) -> None:
    """Floor, ways, furniture and figures, the far ones first."""
    for outline in room.floor:
        axis.add_patch(Polygon(seen(_raised(outline, 0.0)), closed=True, fc=FLOOR, ec=WALL, lw=1, zorder=0))
    for path in performance.paths:
        axis.plot(*seen(_raised(path.points.astype(float), 0.0)).T, color=WAY, lw=1, ls=(0, (4, 3)), zorder=1)
    for outline, points in room.things:
        axis.add_patch(Polygon(seen(_raised(outline, 0.0)), closed=True, fc=SHADE, ec="none", zorder=1))
        axis.scatter(*seen(points).T, s=5, color=THING, lw=0, zorder=_layer(outline.mean(axis=0)))
    for frame, strong in figures(positions, performance.segments):
        body = positions[frame]
        bones(
            axis, seen(body), lw=2.0 if strong else 1.3, alpha=1.0 if strong else 0.55, zorder=_layer(body[0, [0, 2]])
        )
    _label(axis, positions, performance.segments)
    axis.set_aspect("equal")
    axis.axis("off")


def figures(positions: Floats, segments: Sequence[Segment]) -> Iterator[tuple[int, bool]]:
    """Frames to draw: the middle of every hold (strong), and on the way one every 1.3 m."""
    last = None
    for segment in segments:
        middle = (segment.start + segment.end) // 2
        if segment.kind == "hold":
            last = positions[middle, 0]
            yield middle, True
            continue
        for frame in range(segment.start, segment.end):
            if last is None or np.linalg.norm((positions[frame, 0] - last)[[0, 2]]) >= APART:
                last = positions[frame, 0]
                yield frame, False


def seen(points: Floats) -> Floats:
    """Points ``(..., 3)`` on the paper ``(..., 2)``: from above and from behind +Z, turned a little."""
    x, y, z = np.moveaxis(points, -1, 0)
    aside, away = -x * np.cos(TURN) + z * np.sin(TURN), x * np.sin(TURN) + z * np.cos(TURN)
    return np.stack([aside, y * np.cos(ELEVATION) + away * np.sin(ELEVATION)], axis=-1)


def _layer(xz: Floats) -> float:
    """What is nearer is drawn later."""
    return float(100 - xz[0] * np.sin(TURN) - xz[1] * np.cos(TURN))


def _raised(outline: Floats, height: float) -> Floats:
    return np.insert(outline, 1, height, axis=1)


def _label(axis: plt.Axes, positions: Floats, segments: Sequence[Segment]) -> None:
    """Numbers at the poses that are held, as below; poses in one place share a label."""
    labels: list[tuple[Floats, list[str]]] = []
    for number, segment in enumerate(_held(segments), 1):
        body = positions[(segment.start + segment.end) // 2]
        at = seen(np.array([body[0, 0], 1.85, body[0, 2]]))
        if labels and np.linalg.norm(labels[-1][0] - at) < 0.6:
            labels[-1][1].append(str(number))
        else:
            labels.append((at, [str(number)]))
    for at, numbers in labels:
        axis.annotate(", ".join(numbers), at, fontsize=11, weight="bold", ha="center", zorder=1000)


# -- the poses


def draw_poses(axis: plt.Axes, positions: Floats, segments: Sequence[Segment]) -> None:
    """Held poses and what is between them, in order, each seen from its right."""
    chosen = _chosen(segments)
    for column, (frame, text) in enumerate(chosen):
        body = positions[frame]
        local = _from_the_side(body) + np.array([1.15 * column, 0.0])
        bones(axis, local, lw=2.0)
        axis.annotate(text, (1.15 * column, -0.2), ha="center", va="top", fontsize=8)
    axis.axhline(0, color=WALL, lw=0.8, zorder=0)
    axis.set(xlim=(-0.6, 1.15 * len(chosen) - 0.5), ylim=(-0.75, 2.0), aspect="equal")
    axis.axis("off")


def _chosen(segments: Sequence[Segment]) -> list[tuple[int, str]]:
    """(frame, what it shows) of the close-ups."""
    held, found = _held(segments), []
    for segment in segments:
        middle = (segment.start + segment.end) // 2
        if segment in held:
            found.append((middle, f"{held.index(segment) + 1}: {_wrapped(segment.name)}"))
        elif segment.kind == "walk" and segment.frames > 30:
            found.append((middle, "walk"))
        elif segment.kind == "transition" and found and found[-1][1] != "":
            found.append((middle, ""))
    return found[:CLOSE_UPS] if len(found) <= CLOSE_UPS else [found[i] for i in _spread(found)]


def _spread(found: Sequence[tuple[int, str]]) -> list[int]:
    """All that have a name, then as many of the others as there is room for."""
    named = [i for i, (_, text) in enumerate(found) if text]
    others = [i for i, (_, text) in enumerate(found) if not text]
    return sorted([*named, *others[: max(0, CLOSE_UPS - len(named))]])


def _held(segments: Sequence[Segment]) -> list[Segment]:
    return [segment for segment in segments if segment.kind == "hold" and segment.name != "start"]


def _wrapped(name: str) -> str:
    words = name.split()
    return "\n".join(" ".join(words[i : i + 2]) for i in range(0, len(words), 2))


def _from_the_side(body: Floats) -> Floats:
    """Joints ``(24, 3)`` seen from the right and a little from the front: ahead is to the right on the paper."""
    aside = body[1, [0, 2]] - body[2, [0, 2]]  # from the right hip to the left one
    aside /= max(float(np.linalg.norm(aside)), 1e-9)
    ahead = np.array([-aside[1], aside[0]])
    across = 0.35 * aside + 0.94 * ahead  # not quite from the side, so that both legs show
    return np.stack([(body - body[0])[:, [0, 2]] @ across, body[:, 1]], axis=1)


if __name__ == "__main__":
    main()
