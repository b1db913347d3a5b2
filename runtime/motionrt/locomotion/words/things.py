"""The thing that an instruction means, among all those of its name."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.locomotion.words.cloud import SemanticCloud
from motionrt.locomotion.words.footprint import Plan, plan
from motionrt.locomotion.words.instruction import Instruction
from motionrt.locomotion.words.standing_place import Surroundings, surroundings
from motionrt.locomotion.words.vocabulary import find_label
from motionrt.motion.skeleton import FloatArray
from motionrt.untrusted.arguments import checked_array
from motionrt.untrusted.words import shown

LARGE = 2.5  # metres: of longer things (a wall) only the nearest stretch counts


@dataclass(frozen=True, eq=False)
class Thing:
    """A thing of the scene.

    Attributes:
        label: what it is called there.
        points: ``(N, 3)`` float32, metres.
        around: what is around it.
        near: ``(2,)`` where one comes from, if that is known.
    """

    label: str
    points: FloatArray
    around: Surroundings
    near: Plan | None


def ground_place(near: npt.ArrayLike | None) -> Plan | None:
    """The ground plan, x and z, ``(2,)`` of ``(x, z)`` or ``(x, y, z)``; InvalidInputError for anything else."""
    if near is None:
        return None
    place = checked_array(near, "near", "(x, z) or (x, y, z) metres")
    if place.shape not in ((2,), (3,)) or not np.isfinite(place).all():
        raise InvalidInputError(f"near must be (x, z) or (x, y, z) metres, not {shown(near)}")
    return place[[0, -1]]


def find_thing(told: Instruction, cloud: SemanticCloud, near: Plan | None) -> Thing:
    """The instance that is meant, with what surrounds it."""
    label = cloud.label(told.object)
    indices = _nearest(cloud, label, near)
    if told.item is not None and (item := find_label(told.item, cloud.names)) is not None:
        label, indices = item, _nearest(cloud, item, plan(cloud.points[indices]).mean(axis=0))
    middle = plan(cloud.points).mean(axis=0)
    points = cloud.points[indices]
    if told.verb not in {"sit", "lie"}:
        points = _stretch(points, middle if near is None else near)
    ground = None if cloud.floor_label is None else plan(cloud.of(cloud.floor_label))
    weight = 0.1 if near is None else 0.3
    others = cloud.obstacles(indices)
    around = surroundings(others, cloud.floor, ground, middle if near is None else near, weight)
    return Thing(label, points, around, near)


def _nearest(cloud: SemanticCloud, label: str, near: Plan | None) -> npt.NDArray[np.int64]:
    """Indices of the instance of a label that is nearest in the ground plane, else of the largest."""
    things = cloud.instances(label)
    if near is None:
        return things[0]
    return min(things, key=lambda thing: float(np.linalg.norm(plan(cloud.points[thing]) - near, axis=1).min()))


def _stretch(points: FloatArray, near: Plan) -> FloatArray:
    """All points of a thing, or of a large one those within half a metre of its point nearest to ``near``."""
    ground = plan(points)
    if float(np.ptp(ground, axis=0).max()) <= LARGE:
        return points
    nearest = ground[int(np.argmin(np.linalg.norm(ground - near, axis=1)))]
    return np.asarray(points[np.linalg.norm(ground - nearest, axis=1) < 0.5])
