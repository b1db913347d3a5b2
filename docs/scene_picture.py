"""Draw what a script plays: the room with the character along its way, and below it the poses that it takes.

    pip install ".[render]"
    python docs/scene_picture.py examples/living_room.yaml -o docs/images/perform.png [--models PATH]

Left limbs are blue, right limbs red; points are furniture, and the character is paler the earlier it was there.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image

from motionrt import Performance, Runtime, Script
from motionrt.locomotion import load_cloud
from motionrt.rendering import Look, Take, picture

WIDTH, LOW = 1600, 0.05  # pixels; metres below which a point is floor
ROOM = Look(layout="path", camera=110, elevation=36, size=(WIDTH, 900), poses=22, times=False)
POSES = Look(camera=70, follow=True, size=(WIDTH, 0))
CLOSE_UPS = 9


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("script", type=Path, help="a script whose scene is made of polygons")
    parser.add_argument("-o", "--out", type=Path, required=True)
    parser.add_argument("--models", type=Path, help="models manifest or folder (default: the shipped models)")
    args = parser.parse_args()
    script = Script.read(args.script)
    performance = Runtime(args.models).play(script)
    args.out.parent.mkdir(parents=True, exist_ok=True)
    room = Take(performance.motion, paths=[path.points for path in performance.paths])
    if script.scene is not None:
        room = replace(room, areas=[np.array(outline) for outline in script.scene.floor], things=_things(script))
    _stacked([picture(room, ROOM), picture(close_ups(performance), POSES)]).save(args.out, optimize=True)


def _things(script: Script) -> np.ndarray:
    """The points of the script's cloud that do not lie on the floor, ``(N, 3)``."""
    points = load_cloud(script.cloud).points if script.cloud else np.zeros((0, 3), np.float32)
    return points[points[:, 1] > LOW]


def close_ups(performance: Performance) -> Take:
    """The poses that are held, and what is between them, in order."""
    fps, held = performance.motion.fps, 0
    moments: list[tuple[float, str]] = []
    for segment in performance.segments:
        words = ""
        if segment.kind == "hold" and segment.name != "start":
            held += 1
            words = f"{held}: {segment.name}"
        elif segment.kind == "walk" and segment.frames > fps:
            words = "walk"
        if words or (segment.kind == "transition" and moments and moments[-1][1]):
            moments.append(((segment.start + segment.end) / 2 / fps, words))
    return Take(performance.motion, moments=_fewer(moments))


def _fewer(moments: Sequence[tuple[float, str]]) -> list[tuple[float, str]]:
    """All that have a name, then as many of the others as there is room for."""
    free = CLOSE_UPS - sum(bool(words) for _, words in moments)
    others = [moment for moment in moments if not moment[1]][: max(0, free)]
    return [moment for moment in moments if moment[1] or moment in others]


def _stacked(pictures: Sequence[Image.Image]) -> Image.Image:
    """Pictures of one width, one below the other."""
    sheet = Image.new("RGB", (WIDTH, sum(one.height for one in pictures)), "white")
    for number, one in enumerate(pictures):
        sheet.paste(one, (0, sum(before.height for before in pictures[:number])))
    return sheet


if __name__ == "__main__":
    main()
