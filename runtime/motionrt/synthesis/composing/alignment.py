"""Layers brought to one time: the same length, and the same step if they walk."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from numbers import Real
from typing import Literal, get_args

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import Array
from motionrt.synthesis.composing.phase import gait_phase, in_phase
from motionrt.synthesis.composing.timing import held, looped, stretched, warped
from motionrt.untrusted.words import shown

Align = Literal["start", "stretch", "phase"]
LONGEST_S = 600.0  # seconds; a loop of ten minutes


def aligned(motions: Sequence[Motion], leader: int, align: Align, seconds: float | None) -> list[Motion]:
    """``motions``, all of one frame rate, with the same number of frames.

    Args:
        motions: at one frame rate; one of a single frame is a pose, held as long as the others last.
        leader: number of the motion that moves the pelvis; its own timing is changed as little as may be.
        align: "start" plays all from their first frame. "stretch" plays each from its first to its last frame, in
            the time of the leader. "phase" reads the others so that they step when the leader steps.
        seconds: length wanted. "start" and "phase" cut or loop to it, "stretch" makes everything slower or faster.
            ``None``: "start" and "phase" trim to the shortest.

    Raises:
        InvalidInputError: an unknown ``align``; ``seconds`` that are not positive or above 600; "phase" without two
            motions that walk or swing their arms for a whole cycle.
    """
    if not isinstance(align, str) or align not in get_args(Align):
        raise InvalidInputError(f"align must be one of {', '.join(get_args(Align))}, not {shown(align)}")
    frames = None if seconds is None else frames_of(seconds, motions[0].fps)
    moving = [number for number, motion in enumerate(motions) if motion.frames > 1]
    if not moving:
        return [held(motion, frames or 1) for motion in motions]
    lead = leader if leader in moving else moving[0]
    align_by: Callable[..., dict[int, Motion]] = {"start": _from_start, "stretch": _stretched, "phase": _in_step}[align]
    found = align_by({number: motions[number] for number in moving}, lead, frames)
    shortest = min(motion.frames for motion in found.values())
    return [found[n][:shortest] if n in found else held(motion, shortest) for n, motion in enumerate(motions)]


def frames_of(seconds: float, fps: float) -> int:
    """``seconds`` in frames, at least one; InvalidInputError unless they are above 0 and at most 600."""
    if isinstance(seconds, bool) or not isinstance(seconds, Real) or not 0 < seconds <= LONGEST_S:
        raise InvalidInputError(f"seconds must be a number above 0 and at most {LONGEST_S:g}, not {seconds!r}")
    return max(1, round(seconds * fps))


def _from_start(motions: dict[int, Motion], _: int, frames: int | None) -> dict[int, Motion]:
    return motions if frames is None else {n: looped(motion, frames) for n, motion in motions.items()}


def _stretched(motions: dict[int, Motion], lead: int, frames: int | None) -> dict[int, Motion]:
    wanted = frames or motions[lead].frames
    return {n: stretched(motion, wanted) for n, motion in motions.items()}


def _in_step(motions: dict[int, Motion], lead: int, frames: int | None) -> dict[int, Motion]:
    """The lead's own time; others that have a gait are read in its phase, the rest from their start."""
    found = _from_start(motions, lead, frames)
    gait = gait_phase(found[lead])
    others = {n: phase for n, motion in motions.items() if n != lead and (phase := gait_phase(motion)) is not None}
    if gait is None or not others:
        raise InvalidInputError(
            'align="phase" needs two motions that walk, run or swing their arms for a whole cycle; '
            'use align="start" or "stretch"'
        )
    for number, phase in others.items():
        found[number] = _read_in_phase(motions[number], phase, gait, loop=frames is not None)
    return found


def _read_in_phase(motion: Motion, phase: Array, gait: Array, loop: bool) -> Motion:
    missing = gait[-1] - gait[0] + 1 - (phase[-1] - phase[0])
    if loop and missing > 0:
        pace = (phase[-1] - phase[0]) / (len(phase) - 1)
        motion = looped(motion, motion.frames + int(np.ceil(1.2 * (missing + 1) / pace)))
        longer = gait_phase(motion)
        phase = phase if longer is None else longer
    return warped(motion, in_phase(gait, phase))
