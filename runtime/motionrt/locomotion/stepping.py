"""From one stand to another by steps: feet are lifted, set down and stay; the body follows them.

No network is asked: where the feet go is planned (:mod:`motionrt.locomotion.footfalls`), the body moves over them with
its weight on the foot that stands, and the legs reach by inverse kinematics. Turns on the spot, moves of up to a few
metres in any direction, and the last correction behind a walk are made this way; they arrive exactly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from motionrt.locomotion.crowd import FPS, at_30_fps
from motionrt.locomotion.footfalls import Footfall, duration, eased, plan_steps, shares, swings
from motionrt.locomotion.goal_frame import Goal, uncanonicalise
from motionrt.motion import SMPL24, Motion
from motionrt.motion.feet.lock import needed_drop, smooth_cover
from motionrt.motion.feet.two_bone import LEG_JOINTS, two_bone
from motionrt.motion.kinematics import fk
from motionrt.motion.rotations import (
    axis_angle_to_matrix,
    axis_rotation,
    matrix_to_axis_angle,
    matrix_to_quaternion,
    quaternion_to_matrix,
    slerp,
    wrapped,
)
from motionrt.motion.transforms import heading

FIRST_WAY = 1.8  # metres of the way that the first step of a walk belongs to
LIFT, LIFT_FAR = 0.075, 0.03  # metres that an ankle is lifted, and what a long step adds
TIPS = 0.35  # radians that the toes point down as a foot leaves the ground
LIFTS_FIRST = 0.13  # of the time of a step in which a foot only rises, and only sinks
SHIFT = 0.45  # share of the way to the standing foot that the weight goes
SMOOTH = 3.5  # frames: standard deviation of what the body makes of its feet
SINKS = 0.12  # metres that the body may sink for a leg to reach
MOVING = 0.3  # m/s at which somebody is in the middle of a walk
FAR, LONGER, MOST_LONGER = 0.55, 10.0, 5.0  # metres of a first step, frames that each more takes, and the most of them
SETTLED = 0.22  # seconds in which the speed from before is forgotten
MOVED, TURNED = 0.015, 0.06  # metres and radians: feet that are displaced by less are not lifted
IN_THE_AIR = 0.03  # metres above its stand: a foot that is as high goes first
ARMS, TRUNK = 0.75, 0.15  # radians per metre that a foot is ahead of the other
_SHOULDERS = tuple(SMPL24.index(f"{side}_shoulder") for side in ("left", "right"))
_ANKLES = [leg[2] for leg in LEG_JOINTS]
_SPINE = SMPL24.index("spine2")
_LEGS = [joint for leg in LEG_JOINTS for joint in leg[:3]]

Values = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Steps:
    """A stepping motion.

    Attributes:
        motion: frames at 30 fps behind the seed; the last one is the target.
        landings: numbers of the frames after which both feet stand and something else may begin; the last one is where
            the body rests.
    """

    motion: Motion
    landings: tuple[int, ...]


def step_to(seed: Motion, target: Motion, pace: float = np.inf) -> Steps:
    """Step from the last frame of ``seed`` to the pose ``target``.

    Args:
        seed: what came before, at 30 fps; its last speed dies away within the first steps.
        target: one frame, standing upright on the same ground.
        pace: m/s that is not exceeded; steps are as long as is comfortable by default.

    Returns:
        The motion; its last frame is ``target``, and feet that stand do not move.

    Raises:
        InvalidInputError: another frame rate than 30 fps.
    """
    now, target = at_30_fps(seed)[-1:], at_30_fps(target)[-1:]
    start, end = Stand.of(now), Stand.of(target)
    speed = last_speed(seed)
    steps = _planned(start, end, speed, pace)
    frames = duration(steps)
    placed = shares(steps, frames)
    body = _smoothed(placed.mean(axis=1))
    coasted = _coasting(speed, frames)
    root = _body_path(start, end, body, swings(steps, frames)) + coasted
    upper = _upper(now, target, body, start, end)
    feet, turns = feet_over(start, end, steps, frames)
    rotations, root = with_legs(upper, root, feet, turns, _ahead(start, end, feet, body))
    rotations[-1], root[-1] = target.rotations[0], target.root[0]
    made = Motion(rotations.astype(np.float32), root.astype(np.float32), FPS)
    return Steps(made, (*(step.end for step in steps), frames))


def set_off(seed: Motion, standing: Motion, way: float) -> Motion:
    """The first step of a walk along a heading, from a stand; a walk goes on from its last frame.

    Args:
        seed: what came before, at 30 fps, standing at the end.
        standing: the pose that it stands in, one frame.
        way: radians from +Z towards +X.
    """
    x, z = float(seed.root[-1, 0]), float(seed.root[-1, 2])
    goal = Goal(x + FIRST_WAY * float(np.sin(way)), z + FIRST_WAY * float(np.cos(way)), way)
    steps = step_to(seed, uncanonicalise(standing, goal))
    return steps.motion[: steps.landings[0]]


@dataclass(frozen=True)
class Stand:
    """Somebody who stands: root (3,), yaw, ankles (2, 3) and their global rotations (2, 3, 3)."""

    root: Values
    yaw: float
    ankles: Values
    turns: Values

    @classmethod
    def of(cls, pose: Motion) -> Stand:
        """The stand of a pose, one frame."""
        rotations, root = pose.rotations[0].astype(np.float64), pose.root[0].astype(np.float64)
        positions, turned = fk(rotations, root, SMPL24.offsets.astype(np.float64), SMPL24.parents)
        ankles, turns = positions[_ANKLES].astype(np.float64), turned[_ANKLES].astype(np.float64)
        return cls(root, float(heading(pose)[0]), ankles, turns)


def _planned(start: Stand, end: Stand, speed: Values, pace: float) -> list[Footfall]:
    turn = float(wrapped(end.yaw - start.yaw))
    way = end.root - start.root
    facing = start.yaw + turn / 2
    ahead = way[0] * np.sin(facing) + way[2] * np.cos(facing)
    left = way[0] * np.cos(facing) - way[2] * np.sin(facing)
    high, moves = start.ankles[:, 1] - end.ankles[:, 1], displaced(start, end)
    first = int(high.argmax()) if high.max() > IN_THE_AIR else None
    behind = foot_behind(start, speed)
    if behind is not None:
        first, moves[behind] = (behind if first is None else first), True
    told = float(ahead), float(left), turn, (bool(moves[0]), bool(moves[1])), first
    steps = plan_steps(*told, pace=pace)
    if not steps:
        return steps
    aim = _placed(start, end, steps[0].share)[0][steps[0].foot]
    far = float(np.linalg.norm(aim - start.ankles[steps[0].foot]))
    return plan_steps(*told, longer=longer_for(far), pace=pace)


def displaced(start: Stand, end: Stand) -> npt.NDArray[np.bool_]:
    """``(2,)`` which feet have to be lifted: they stand elsewhere, or turned, or are in the air."""
    off = np.hypot(*(end.ankles - start.ankles)[:, [0, 2]].T)
    twist = np.linalg.norm(matrix_to_axis_angle(np.swapaxes(start.turns, -1, -2) @ end.turns), axis=-1)
    return np.asarray((off > MOVED) | (twist > 3 * TURNED) | (start.ankles[:, 1] - end.ankles[:, 1] > IN_THE_AIR))


def foot_behind(start: Stand, speed: Values) -> int | None:
    """Of somebody who walks, at ``(3,)`` m/s, the foot that is behind; None of who stands."""
    return int((start.ankles @ speed).argmin()) if np.hypot(*speed[[0, 2]]) > MOVING else None


def longer_for(far: float) -> int:
    """Frames that a step of so many metres takes longer than others."""
    return round(float(np.clip((far - FAR) * LONGER, 0, MOST_LONGER)))


def _placed(start: Stand, end: Stand, share: float) -> tuple[Values, Values]:
    """Ankles and their rotations where they would stand if the body stood at a share of its way."""
    turn = float(wrapped(end.yaw - start.yaw)) * (share - 1)
    rotation = axis_rotation("Y", turn)
    place = (start.root + share * (end.root - start.root)) * [1, 0, 1]
    off = end.ankles - end.root * [1, 0, 1]
    return off @ rotation.T + place, rotation @ end.turns


def feet_over(start: Stand, end: Stand, steps: list[Footfall], frames: int) -> tuple[Values, Values]:
    """``(F, 2, 3)`` ankles and ``(F, 2, 3, 3)`` their rotations: standing, or in the air."""
    ankles = np.repeat(start.ankles[None], frames, axis=0)
    turns = np.repeat(start.turns[None], frames, axis=0)
    now = np.arange(1, frames + 1)
    for step in steps:
        foot = step.foot
        aim, turned = (part[foot] for part in _placed(start, end, step.share))
        before, before_turn = ankles[step.start - 1, foot].copy(), turns[step.start - 1, foot].copy()
        s = np.clip((now - step.start) / (step.end - step.start), 0.0, 1.0)
        ease, moving = eased((s - LIFTS_FIRST) / (1 - 2 * LIFTS_FIRST)), now > step.start
        far = float(np.hypot(*(aim - before)[[0, 2]]))
        air = np.sin(np.pi * s)
        path = before + ease[:, None] * (aim - before)
        path[:, 1] += air * (LIFT + LIFT_FAR * min(1.0, far / 0.4))
        pair = np.stack([before_turn, turned])
        quaternions = matrix_to_quaternion(pair)
        way = quaternion_to_matrix(slerp(quaternions[:1], quaternions[1:], ease))
        tipped = way @ axis_rotation("X", TIPS * air * (1.0 - s))
        ankles[moving, foot], turns[moving, foot] = path[moving], tipped[moving]
        landed = now >= step.end
        ankles[landed, foot], turns[landed, foot] = aim, turned
    return ankles, turns


def _body_path(start: Stand, end: Stand, body: Values, air: Values) -> Values:
    """``(F, 3)`` the pelvis: on its way, its weight over the foot that stands."""
    path = start.root + body[:, None] * (end.root - start.root)
    yaw = start.yaw + wrapped(end.yaw - start.yaw) * body
    side = np.stack([np.cos(yaw), np.zeros_like(yaw), -np.sin(yaw)], axis=1)  # to the left
    half = float(np.linalg.norm((end.ankles[0] - end.ankles[1])[[0, 2]])) / 2
    lean = np.sin(np.pi * air[:, 1]) - np.sin(np.pi * air[:, 0])  # to the left while the right foot is in the air
    return np.asarray(path + side * (SHIFT * half * _smoothed(lean, pinned=True))[:, None])


def _upper(now: Motion, target: Motion, body: Values, start: Stand, end: Stand) -> Values:
    """``(F, 24, 3, 3)`` all joints from one pose to the other; the pelvis keeps its lean while it turns."""
    first, last = now.rotations[0].astype(float), target.rotations[0].astype(float)
    first[0], last[0] = axis_rotation("Y", -start.yaw) @ first[0], axis_rotation("Y", -end.yaw) @ last[0]
    ways = matrix_to_axis_angle(np.swapaxes(first, -1, -2) @ last)
    out = first @ axis_angle_to_matrix(ways * _covered(body)[:, None, None])
    yaw = start.yaw + wrapped(end.yaw - start.yaw) * body
    out[:, 0] = axis_rotation("Y", yaw) @ out[:, 0]
    return np.asarray(out)


def _ahead(start: Stand, end: Stand, feet: Values, body: Values) -> Values:
    """``(F,)`` metres that the left foot is ahead of the right, beyond what the poses have."""
    yaw = start.yaw + wrapped(end.yaw - start.yaw) * body
    apart = feet[:, 0] - feet[:, 1]
    ahead = apart[:, 0] * np.sin(yaw) + apart[:, 2] * np.cos(yaw)

    def own(stand: Stand) -> float:
        way = stand.ankles[0] - stand.ankles[1]
        return float(way[0] * np.sin(stand.yaw) + way[2] * np.cos(stand.yaw))

    return _smoothed(ahead - (own(start) + body * (own(end) - own(start))), pinned=True)


def with_legs(upper: Values, root: Values, feet: Values, turns: Values, ahead: Values) -> tuple[Values, Values]:
    """Rotations and root whose ankles are where they shall be; arms and trunk swing against the legs."""
    rotations = upper.copy()
    swing = np.clip(ARMS * ahead, -0.6, 0.6)
    for shoulder, sign in zip(_SHOULDERS, (1.0, -1.0), strict=True):
        rotations[:, shoulder] = axis_rotation("X", sign * swing) @ rotations[:, shoulder]
    rotations[:, _SPINE] = axis_rotation("Y", TRUNK * ahead) @ rotations[:, _SPINE]
    offsets = SMPL24.offsets.astype(float)
    positions, turned = fk(rotations, root, offsets, SMPL24.parents)
    down = np.ones((len(root), 2), dtype=bool)
    drop = smooth_cover(needed_drop(positions, feet - positions[:, _ANKLES], down, SINKS), 4)
    root = root - np.array([0, 1, 0]) * (drop * _inside(len(root)))[:, None]
    positions, turned = fk(rotations, root, offsets, SMPL24.parents)
    legs = np.array(LEG_JOINTS)
    pole = turned[:, legs[:, 0]][..., 2]
    _, bent = two_bone(positions[:, legs[:, :3]], turned[:, legs[:, :2]], feet, pole)
    hip, knee = bent[..., 0, :, :], bent[..., 1, :, :]
    rotations[:, legs[:, 0]] = np.swapaxes(turned[:, None, 0], -1, -2) @ hip
    rotations[:, legs[:, 1]] = np.swapaxes(hip, -1, -2) @ knee
    rotations[:, legs[:, 2]] = np.swapaxes(knee, -1, -2) @ turns
    return rotations, root


def last_speed(seed: Motion) -> Values:
    """``(3,)`` m/s of the pelvis at the end."""
    if seed.frames < 2:
        return np.zeros(3)
    return np.asarray((seed.root[-1] - seed.root[-2]).astype(np.float64) * FPS)


def _coasting(speed: Values, frames: int) -> Values:
    """``(F, 3)`` metres: where a speed leads before it is forgotten."""
    time = np.arange(1, frames + 1)[:, None] / FPS
    left = np.clip(1.0 - np.arange(1, frames + 1) / frames, 0.0, 1.0)[:, None]
    return np.asarray(speed * time * np.exp(-time / SETTLED) * left)


def _covered(body: Values) -> Values:
    """The part of the change of pose that is done: none at first, all at the end, also where the body goes nowhere."""
    return eased(np.arange(1, len(body) + 1) / len(body))


def _inside(frames: int) -> Values:
    """1, falling to 0 at the last frames."""
    return eased((frames - np.arange(1, frames + 1)) / 6.0)


def _smoothed(values: Values, *, pinned: bool = False) -> Values:
    """Gaussian average of ``(F,)``, ends held; the last value stays. ``pinned``: zero beyond both ends."""
    reach = int(np.ceil(3 * SMOOTH))
    bell = np.exp(-0.5 * (np.arange(-reach, reach + 1) / SMOOTH) ** 2)
    first, last = (0.0, 0.0) if pinned else (0.0, values[-1])
    padded = np.concatenate([np.full(reach, first), values, np.full(reach, last)])
    made = np.convolve(padded, bell / bell.sum(), mode="valid")
    time = np.arange(1, len(values) + 1)
    ease = eased(time / LEADING)
    tail = eased((len(values) - time) / LEADING)
    return np.asarray(first + (made - first) * ease * tail + (1 - tail) * (last - first))


LEADING = 6.0  # frames at both ends over which the average gives way to the ends themselves
