"""Action keypoints: where hands, feet and pelvis go for an instruction, by simple geometric rules."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.locomotion.lying import seat_keypoints
from motionrt.locomotion.words.beds import Bed, find_bed
from motionrt.locomotion.words.cloud import SemanticCloud
from motionrt.locomotion.words.footprint import Plan, Side, sides
from motionrt.locomotion.words.instruction import Instruction, parse_instruction
from motionrt.locomotion.words.seats import Seat, backrest_front, find_seat, seat_height
from motionrt.locomotion.words.standing_place import BODY, TOES, Spot, best, spot_at
from motionrt.locomotion.words.things import Thing, find_thing, ground_place
from motionrt.motion.skeleton import FloatArray
from motionrt.untrusted.arguments import check_kind

PELVIS_ABOVE_SEAT = 0.15  # metres from the surface to the joint
PELVIS_STANDING = 0.94  # above the ground
SEATED_DEPTH = 0.33  # metres that the pelvis is behind the edge of a deep seat ...
SEATED_BACK = 0.15  # ... and at least in front of a backrest
KNEE_TO_TOES = 0.50  # metres from the pelvis to the balls of the feet of somebody who sits
STEP_AWAY = 0.45  # metres from the edge of a seat to where one stands before sitting down
FOOT = 0.11  # metres from the middle to each foot
SHOULDER = 0.12  # metres that a hand's side is off the middle
COMFORTABLE = 1.1  # metres: where a hand goes on a tall thing
SMALL = 0.6  # metres: lower things are taken at their middle
LEANING = 0.12  # metres that feet are farther away for leaning than for a grip
HANDLE = 1.0  # metres of a door's handle
_BY_HEIGHT = (
    (0.2, 0.6, 1.2, 1.6, 2.0),
    (0.35, 0.42, 0.42, 0.32, 0.20),
)  # height of the hand -> its distance from the toes


@dataclass(frozen=True, eq=False)
class ActionKeypoints:
    """Where to be for an action.

    Attributes:
        name: the action, as in "sit sofa".
        keypoints: ``{joint of smpl24: (3,) float32 metres}``, for ``solve_pose``.
        heading: yaw of the body, radians from +Z towards +X.
        approach: ``(2,)`` float32 x and z: where to walk to before.
        bed: where to lie and to sit down before, of somebody who shall lie; its keypoints are those of the seat.
    """

    name: str
    keypoints: Mapping[str, FloatArray]
    heading: float
    approach: FloatArray
    bed: Bed | None = None


def action_keypoints(
    instruction: Instruction | str, cloud: SemanticCloud, near: npt.ArrayLike | None = None
) -> ActionKeypoints:
    """Keypoints, heading and approach for an instruction in a scene.

    Args:
        instruction: a sentence, or what `parse_instruction` made of it.
        cloud: the scene.
        near: ``(2,)`` x and z or ``(3,)`` metres: where one comes from; of several things of a name the nearest is
            taken, without it the largest.

    Raises:
        InvalidInputError: an unknown verb or object, no seat to sit on, or a height that the object does not have.
    """
    check_kind(cloud, SemanticCloud, "cloud", "a SemanticCloud")
    told = instruction if isinstance(instruction, Instruction) else parse_instruction(instruction)
    here = ground_place(near)
    thing = find_thing(told, cloud, here)
    if told.verb == "lie":
        return _lie(thing)
    rules = {"sit": _sit, "stand": _stand, "lean": _lean, "look": _look, "open": _open}
    rules |= dict.fromkeys(("grab", "reach", "touch"), _hand_at)
    if told.verb not in rules:
        raise InvalidInputError(f"unknown verb '{told.verb}'; there are: lie, {', '.join(rules)}")
    keypoints, heading, approach = rules[told.verb](told, thing)
    named = {joint: np.asarray(point, dtype=np.float32) for joint, point in keypoints.items()}
    return ActionKeypoints(f"{told.verb} {thing.label}", named, heading, approach.astype(np.float32))


_Answer = tuple[dict[str, tuple[float, float, float]], float, Plan]


def _sit(_: Instruction, thing: Thing) -> _Answer:
    """Pelvis on the seat, feet before its edge, the backrest behind."""
    floor = thing.around.floor
    around = sides(thing.points)
    front = backrest_front(thing.points, seat_height(thing.points, floor), around) or _open_side(thing, around)
    seat = find_seat(thing.points, floor, front, thing.near)
    depth = min(SEATED_DEPTH, max(seat.back - seat.front - SEATED_BACK, 0.1))
    pelvis = -seat.front - depth  # metres in front of the side
    toes = max(pelvis + KNEE_TO_TOES, -seat.front + 0.08)
    keypoints = {"pelvis": _point(front.at(seat.across, pelvis), seat.height + PELVIS_ABOVE_SEAT)}
    keypoints |= _feet(front.at(seat.across, toes), -front.along, floor)
    return keypoints, front.heading_out, _before(seat, thing)


def _lie(thing: Thing) -> ActionKeypoints:
    bed = find_bed(thing)
    points, heading, approach = seat_keypoints(bed.at, bed.edge, thing.around.floor)
    named = {joint: np.asarray(point, dtype=np.float32) for joint, point in points.items()}
    return ActionKeypoints(f"lie {thing.label}", named, heading, np.array(approach, dtype=np.float32), bed)


def _before(seat: Seat, thing: Thing) -> Plan:
    """Where to walk to before sitting down: in front of the seat, beside it where a table is there."""
    ahead = seat.side.at(seat.across, -seat.front + STEP_AWAY)
    beside = [seat.side.at(sign * (seat.side.width / 2 + BODY + 0.1), -seat.front - 0.1) for sign in (1.0, -1.0)]
    return next((place for place in (ahead, *beside) if not thing.around.blocked(place)), ahead)


def _open_side(thing: Thing, around: tuple[Side, Side, Side, Side]) -> Side:
    """Of a seat without a backrest: the side with free ground before it, a long one if there is a choice."""
    spots = [spot_at(side, 0.0, STEP_AWAY, thing.around) for side in around]
    return min(zip(spots, around, strict=True), key=lambda pair: pair[0].cost - 0.5 * pair[1].width)[1]


def _stand(_: Instruction, thing: Thing) -> _Answer:
    """Both feet before the thing, facing it."""
    spot = best(
        [spot_at(side, _across(side, thing.points, thing.near), 0.40, thing.around) for side in sides(thing.points)]
    )
    floor, side = thing.around.floor, spot.side
    keypoints = {"pelvis": _point(spot.place, floor + PELVIS_STANDING)}
    keypoints |= _feet(side.at(spot.across, spot.outside - TOES), side.along, floor)
    return keypoints, side.heading_in, spot.place


def _lean(told: Instruction, thing: Thing) -> _Answer:
    """Both hands on the surface, the feet a little farther away than for a grip."""
    one = replace(told, hand=None, height=_leaning_height(told, thing))
    keypoints, heading, place = _hand_at(one, thing)
    hand = np.array(keypoints["right_hand"])
    left = np.array([np.cos(heading), 0.0, -np.sin(heading)])
    away = -LEANING * np.array([np.sin(heading), 0.0, np.cos(heading)])
    leaning = {name: tuple((np.array(point) + away).tolist()) for name, point in keypoints.items() if "foot" in name}
    hands = {"right_hand": tuple(hand.tolist()), "left_hand": tuple((hand + 2 * SHOULDER * 1.4 * left).tolist())}
    return {**hands, **leaning}, heading, place + away[[0, 2]]


def _look(_: Instruction, thing: Thing) -> _Answer:
    """Upright where one comes from, turned to the thing."""
    if thing.near is None:
        return _stand(_, thing)
    here, floor = np.asarray(thing.near, dtype=np.float64), thing.around.floor
    way = thing.points[:, [0, 2]].astype(np.float64).mean(axis=0) - here
    heading = float(np.arctan2(way[0], way[1]))
    ahead, left = np.array([np.sin(heading), np.cos(heading)]), np.array([np.cos(heading), -np.sin(heading)])
    keypoints = {"pelvis": _point(here, floor + PELVIS_STANDING)}
    return keypoints | _feet(here + TOES * ahead, left, floor), heading, here


def _open(told: Instruction, thing: Thing) -> _Answer:
    """A hand where a handle is, unless a height is told."""
    floor = thing.around.floor
    low, high = np.percentile(thing.points[:, 1] - floor, [2.0, 98.0])
    return _hand_at(told if told.height is not None else replace(told, height=float(np.clip(HANDLE, low, high))), thing)


def _leaning_height(told: Instruction, thing: Thing) -> float:
    low, high = np.percentile(thing.points[:, 1] - thing.around.floor, [2.0, 98.0])
    return told.height if told.height is not None else float(np.clip(COMFORTABLE, low, high))


def _hand_at(told: Instruction, thing: Thing) -> _Answer:
    """A hand on the surface at the height, both feet before it, facing it."""
    floor, hand = thing.around.floor, told.hand or "right"
    height = floor + (_usual_height(thing.points, floor) if told.height is None else told.height)
    band = _band(thing, height, told)
    options = [_hand_spot(side, band, thing, height, hand) for side in sides(thing.points)]
    spot, target = min(options, key=lambda option: option[0].cost)
    keypoints = {f"{hand}_hand": _point(target, height)}
    keypoints |= _feet(spot.side.at(spot.across, spot.outside - TOES), spot.side.along, floor)
    return keypoints, spot.side.heading_in, spot.place


def _hand_spot(side: Side, band: FloatArray, thing: Thing, height: float, hand: str) -> tuple[Spot, Plan]:
    """Where to stand at a side, and the ground plan (2,) of where the hand goes."""
    across = _across(side, band, thing.near)
    offset = np.abs(side.across(band) - across)
    patch = band[offset <= max(0.15, float(offset.min()) + 0.02)]
    surface = -float(np.percentile(side.inside(patch), 2.0))  # metres in front of the side, 0 or less
    floor = thing.around.floor
    legs = thing.points[(thing.points[:, 1] < floor + 0.9) & (np.abs(side.across(thing.points) - across) < 0.3)]
    foremost = -float(side.inside(legs).min()) if len(legs) else -np.inf
    toes = max(surface + float(np.interp(height - floor, *_BY_HEIGHT)), foremost + 0.05)
    middle = across - SHOULDER if hand == "left" else across + SHOULDER  # left is towards +along
    return spot_at(side, middle, toes + TOES, thing.around), side.at(across, surface)


def _across(side: Side, points: FloatArray, near: Plan | None) -> float:
    """Where along a side: nearest to where one comes from, else its middle; never beyond the points."""
    low, high = np.percentile(side.across(points), [5.0, 95.0])
    wanted = (low + high) / 2 if near is None else float((near - side.centre) @ side.along)
    return float(np.clip(wanted, low, high))


def _usual_height(points: FloatArray, floor: float) -> float:
    """Metres above the ground: the middle of a small thing, the comfortable height on a tall one."""
    low, high = np.percentile(points[:, 1] - floor, [2.0, 98.0])
    return float((low + high) / 2 if high - low < SMALL else np.clip(COMFORTABLE, low, high))


def _band(thing: Thing, height: float, told: Instruction) -> FloatArray:
    """The thing's points ``(n, 3)`` at about a height."""
    distance = np.abs(thing.points[:, 1] - height)
    nearest = float(distance.min())
    if nearest > 0.25:
        low, high = thing.points[:, 1].min() - thing.around.floor, thing.points[:, 1].max() - thing.around.floor
        raise InvalidInputError(
            f"the {thing.label} has nothing at {height - thing.around.floor:.2f} m; "
            f"{told.verb} at {low:.2f} to {high:.2f} m above the ground"
        )
    return np.asarray(thing.points[distance <= max(0.08, nearest + 0.04)])


def _feet(toes: Plan, left: Plan, floor: float) -> dict[str, tuple[float, float, float]]:
    """Both balls of the feet on the ground, the left one towards ``left``."""
    return {"left_foot": _point(toes + FOOT * left, floor), "right_foot": _point(toes - FOOT * left, floor)}


def _point(place: Plan, height: float) -> tuple[float, float, float]:
    return float(place[0]), float(height), float(place[1])
