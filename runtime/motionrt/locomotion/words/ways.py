"""Ways through a scene that is known by its labelled points alone: round the things, over what is labelled ground."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from motionrt.errors import PathError
from motionrt.locomotion.path import Path
from motionrt.locomotion.scene import Scene
from motionrt.locomotion.words.cloud import SemanticCloud
from motionrt.locomotion.words.footprint import plan
from motionrt.locomotion.words.standing_place import HIGH, LOW

CELL = 0.1  # metres
REACHES = 0.4  # metres from a point of the ground up to which there is ground
LARGEST = 4_000_000  # cells


@dataclass(frozen=True, eq=False)
class Ways:
    """Finds ways; where there is none, the straight one, and the path's ``notes`` say so."""

    scene: Scene

    def plan(self, start: Sequence[float], goal: Sequence[float], /) -> Path:
        """A path between two places (x, z)."""
        try:
            return self.scene.plan(start, goal)
        except PathError as error:
            ends = np.array([start, goal], dtype=np.float32)
            return Path(ends, notes=(f"straight through the points of the cloud: {error}",))


def ways_through(cloud: SemanticCloud) -> Ways | None:
    """Ways over the ground of a cloud, or None where nothing is labelled ground, or the ground is too large."""
    from scipy.spatial import cKDTree

    if cloud.floor_label is None:
        return None
    ground, things = plan(cloud.of(cloud.floor_label)), cloud.obstacles()
    low = ground.min(axis=0) - REACHES
    columns, rows = (int(count) for count in np.ceil((ground.max(axis=0) + REACHES - low) / CELL))
    if columns * rows > LARGEST:
        return None
    middles = np.stack(np.meshgrid(np.arange(columns) + 0.5, np.arange(rows) + 0.5), axis=-1) * CELL + low
    away, _ = cKDTree(ground).query(middles, distance_upper_bound=REACHES)
    heights = things[:, 1] - cloud.floor
    blocking = plan(things[(heights > LOW) & (heights < HIGH)])
    walkable = np.isfinite(away)
    if len(blocking):
        near, _ = cKDTree(blocking).query(middles, distance_upper_bound=CELL * 0.71)
        walkable &= ~np.isfinite(near)
    if not walkable.any():
        return None
    return Ways(Scene.from_cells(walkable, CELL, origin=(float(low[0]), float(low[1]))))
