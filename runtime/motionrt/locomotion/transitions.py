"""Transitions: two seconds from what a character does to a pose, wherever that pose stands  [Continual 3.6]."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.locomotion.bearings import joined
from motionrt.locomotion.crowd import to_motion
from motionrt.locomotion.goal_frame import Goal, frames_from_goal, frames_to_goal
from motionrt.models.transnet import SEED, WINDOW
from motionrt.motion import Motion
from motionrt.motion.features import ccf219
from motionrt.motion.feet.lock import lock_feet
from motionrt.motion.rotations import axis_angle_to_matrix, axis_rotation, matrix_to_axis_angle, project_to_so3
from motionrt.motion.skeleton import FloatArray
from motionrt.motion.transforms import heading
from motionrt.untrusted.arguments import check_flags, check_kind

FPS = ccf219.FPS
FRAMES = WINDOW - SEED  # of a transition: 59 that are filled, and the target
SETTLE = 4  # frames at the end of a transition into a held pose that already hold it
LONGEST = 20  # frames of a target
STOP_S, START_S = 0.7, 0.85  # seconds of its speed that a stop and a start take on the ground
_EASE = 6  # frames over which the foot lock's correction fades at both ends

Infill = Callable[[FloatArray, npt.NDArray[np.bool_]], FloatArray]
"""frames (B, 120, 219) in the targets' frames and which are hidden (B, 120) -> all frames (B, 120, 219)."""


def goal_of(pose: Motion) -> Goal:
    """Where the first frame of ``pose`` stands, and its heading."""
    return Goal(float(pose.root[0, 0]), float(pose.root[0, 2]), float(heading(pose)[0]))


def placed(pose: Motion, goal: Goal) -> Motion:
    """``pose`` moved over the ground and turned so that its first frame stands at ``goal``; heights stay."""
    own = goal_of(pose)
    about = np.array([own.x, 0, own.z], dtype=np.float32)
    turn = axis_rotation("Y", np.float32(goal.heading - own.heading)).astype(np.float32)
    rotations = pose.rotations.copy()
    rotations[:, 0] = turn @ rotations[:, 0]
    root = (pose.root - about) @ turn.T + np.array([goal.x, 0, goal.z])
    return replace(pose, rotations=rotations, root=root.astype(np.float32))


def transition(
    model: Infill,
    seed: Motion,
    target: Motion,
    goal: Goal | None = None,
    *,
    held: bool = False,
    foot_lock: bool = False,
) -> Motion:
    """The 60 frames (two seconds) that lead from ``seed`` to ``target``, whose pose the last of them is, exactly.

    Args:
        model: fills the gap: :class:`motionrt.models.transnet.TransitionModel`.
        seed: what the character did in the world, 30 fps. The last 60 frames count; a shorter one is preceded by its
            first frame.
        target: one frame in the world; or up to 20, of a motion that the transition ends with.
        goal: where the target's first frame shall stand instead, and facing where; see :func:`distance`.
        held: the pose (the target's last frame) will be held: the last 4 frames rest in it already.
        foot_lock: let standing feet stand (:func:`motionrt.motion.feet.lock.lock_feet`).

    Returns:
        60 frames at 30 fps in the world, to be played behind ``seed``.

    Raises:
        InvalidInputError: another frame rate than 30 fps, or a target of more than 20 frames.
    """
    check_kind(seed, Motion, "the motion before a transition", "a Motion")
    check_kind(target, Motion, "the pose after a transition", "a Motion")
    check_kind(goal, Goal | None, "goal", "a Goal")
    check_flags(held=held, foot_lock=foot_lock)
    aim = placed(_checked(target, "target"), goal) if goal is not None else _checked(target, "target")
    tail = _tail(aim, held)
    place = goal if goal is not None and aim.frames == 1 else goal_of(aim[aim.frames - 1 :])
    filled = to_motion(np.concatenate([_filled(model, seed, tail, place), tail]))
    return locked(joined([_seed_of(seed), filled]))[SEED:] if foot_lock else filled


def _filled(model: Infill, seed: Motion, tail: FloatArray, place: Goal) -> FloatArray:
    """The frames between seed and tail, which the model sees from where the last frame of the tail stands."""
    known = np.concatenate([_seed_frames(seed), tail])
    gap, row = WINDOW - len(known), np.array([place.row()])
    seen = frames_to_goal(known[None], row)
    frames = np.zeros((1, WINDOW, ccf219.WIDTH), np.float32)
    frames[:, :SEED], frames[:, SEED + gap :] = seen[:, :SEED], seen[:, SEED:]
    hidden = np.zeros((1, WINDOW), bool)
    hidden[:, SEED : SEED + gap] = True
    answer = model(frames, hidden)[:, SEED : SEED + gap]
    found: FloatArray = frames_from_goal(answer, row)[0].astype(np.float32)
    found[:, ccf219.ROTATIONS] = project_to_so3(found[:, ccf219.ROTATIONS].reshape(-1, 3, 3)).reshape(gap, -1)
    return found


def distance(before: float, after: float) -> float:
    """Metres that a character covers in a transition from ``before`` to ``after`` m/s: where to place its target.

    Both speeds are along the ground; a pose that is held has 0. Medians of two-second windows of the CMU recordings,
    in which half of the people cover between 0.5 and 1.5 times as much.

    Raises:
        InvalidInputError: a speed that is negative or not finite.
    """
    if not (np.isfinite([before, after]).all() and before >= 0 and after >= 0):
        raise InvalidInputError(f"speeds are metres per second from 0, not {before} and {after}")
    return float(STOP_S * before + START_S * after)


def speed_of(motion: Motion, seconds: float = 0.5) -> float:
    """Mean speed of the root over the ground in the last ``seconds``, m/s."""
    frames = min(max(1, round(seconds * motion.fps)), motion.frames - 1)
    way = motion.root[-1] - motion.root[-1 - frames]
    return float(np.hypot(way[0], way[2]) * motion.fps / frames) if frames else 0.0


def locked(window: Motion) -> Motion:
    """A window of 120 frames with the feet locked behind its seed; seed and last frame stay as they are.

    The target is held behind the window while contacts are looked for: a foot that stands in it is pinned where it
    stands there.
    """
    hold = [WINDOW - 1] * (FRAMES // 2)
    longer = replace(
        window,
        rotations=np.concatenate([window.rotations, window.rotations[hold]]),
        root=np.concatenate([window.root, window.root[hold]]),
    )
    fixed = lock_feet(longer)[:WINDOW]
    time = np.arange(WINDOW)
    share = np.clip(np.minimum(time - SEED + 1, WINDOW - 1 - time) / _EASE, 0, 1).astype(np.float32)
    share = share * share * (3 - 2 * share)
    turn = matrix_to_axis_angle(np.swapaxes(window.rotations, -1, -2) @ fixed.rotations)
    rotations = window.rotations @ axis_angle_to_matrix(turn * share[:, None, None])
    root = window.root + (fixed.root - window.root) * share[:, None]
    keep = share == 0
    rotations[keep] = window.rotations[keep]
    return replace(window, rotations=rotations.astype(np.float32), root=root)


def _seed_frames(seed: Motion) -> FloatArray:
    frames = ccf219.encode(_checked(seed, "seed")[-SEED:])
    short = SEED - len(frames)
    return np.concatenate([np.repeat(frames[:1], short, axis=0), frames]) if short else frames


def _seed_of(seed: Motion) -> Motion:
    """The last 60 frames, the first of them held before where there are fewer."""
    frames = np.maximum(np.arange(-SEED, 0), -seed.frames)
    return replace(seed, rotations=seed.rotations[frames], root=seed.root[frames])


def _tail(aim: Motion, held: bool) -> FloatArray:
    """The visible frames at the end of the window."""
    if aim.frames > LONGEST:
        raise InvalidInputError(
            f"target must be a pose or up to {LONGEST} frames, not {aim.frames}: take target[:{LONGEST}]"
        )
    rows = ccf219.encode(aim)
    return np.repeat(rows[-1:], SETTLE, axis=0) if held else rows


def _checked(motion: Motion, name: str) -> Motion:
    if abs(motion.fps - FPS) > 1e-6:
        raise InvalidInputError(f"{name} must be at {FPS:g} fps, not {motion.fps:g}: call .resample({FPS:g}) first")
    return motion
