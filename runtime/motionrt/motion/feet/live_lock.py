"""Foot locking one frame at a time, for a game's loop: causal, for one character or many at once."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.motion.feet.contacts import LOOSE_HEIGHT, LOOSE_SPEED, STRICT_HEIGHT, STRICT_SPEED
from motionrt.motion.feet.lock import BLEND_S, CLEARANCE, MAX_DROP, MAX_SHIFT, lift, needed_drop
from motionrt.motion.feet.two_bone import LEG_JOINTS, bend_legs
from motionrt.motion.kinematics import fk
from motionrt.motion.rotations import Array
from motionrt.motion.runs import BoolArray
from motionrt.motion.skeleton import SMPL24, FloatArray

_TOES = [leg[3] for leg in LEG_JOINTS]
_PLANE = np.array([1.0, 0.0, 1.0])


@dataclass
class _Feet:
    """What is remembered from frame to frame."""

    toes: Array  # (..., 2, 3) as they came in
    planted: BoolArray  # (..., 2)
    offset: Array  # (..., 2, 3) in the ground plane, what they were moved by
    velocity: Array  # of the offset, per second
    drop: Array  # (...) of the pelvis
    sinking: Array  # of the drop, per second


class FootLocker:
    """Holds the toes of standing feet in the ground plane, and swinging ones clear of the floor, frame by frame.

    A toe is caught when it is low and slow and let go when it rises, moves or has been moved by more than 0.1 m; the
    correction then decays like a critically damped spring that starts with the speed it has.

    Args:
        fps: frames per second.
        floor: height in metres of the toe joint of a standing foot.
        blend_s: seconds in which a correction has all but gone.
        clearance: metres that a swinging toe keeps above the floor; no toe is below it.

    Raises:
        InvalidInputError: ``fps`` or ``blend_s`` is not positive.
    """

    def __init__(self, fps: float, floor: float = 0.0, blend_s: float = BLEND_S, clearance: float = CLEARANCE) -> None:
        if not (fps > 0 and blend_s > 0):
            raise InvalidInputError(f"fps and blend_s must be positive, not {fps} and {blend_s}")
        self.fps, self.floor, self.clearance = float(fps), float(floor), float(clearance)
        self._stiffness = 5.0 / blend_s
        self._feet: _Feet | None = None

    def reset(self) -> None:
        """Forget the past: the next frame starts a new motion."""
        self._feet = None

    def step(self, rotations: FloatArray, root: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The next frame, locked.

        Args:
            rotations: ``(..., 24, 3, 3)`` local rotations of ``smpl24``; batch axes stay the same from step to step.
            root: ``(..., 3)`` metres.

        Returns:
            Rotations and root of the same shapes, float32.
        """
        local, place = np.asarray(rotations, dtype=np.float64), np.asarray(root, dtype=np.float64)
        positions, turned = fk(local, place, SMPL24.offsets.astype(np.float64), SMPL24.parents)
        toes = positions[..., _TOES, :]
        feet = self._feet if self._feet is not None else _first(toes)
        if feet.toes.shape != toes.shape:
            raise InvalidInputError(f"the batch changed from {feet.toes.shape[:-2]} to {toes.shape[:-2]}; call reset()")
        speed = np.linalg.norm(toes - feet.toes, axis=-1) * self.fps
        feet = self._caught(feet, toes, speed)
        offset = feet.offset.copy()
        offset[..., 1] = lift(toes[..., 1] - self.floor, speed, self.clearance)
        self._feet = feet = self._sunk(feet, needed_drop(positions, offset, feet.planted, MAX_DROP))
        sunk = np.array([0.0, 1.0, 0.0]) * feet.drop[..., None]
        out = bend_legs(local, positions - sunk[..., None, :], turned, offset + sunk[..., None, :])
        return out.astype(np.float32), (place - sunk).astype(np.float32)

    def _caught(self, feet: _Feet, toes: Array, speed: Array) -> _Feet:
        """Feet that stand are pinned to where they were; the offset of the others decays."""
        pinned = feet.offset + (feet.toes - toes) * _PLANE
        planted = self._standing(feet, toes, speed, np.linalg.norm(pinned, axis=-1))
        hold, catch = (planted & feet.planted)[..., None], (planted & ~feet.planted)[..., None]
        offset, velocity = self._decayed(feet.offset, feet.velocity)
        offset = np.where(hold, pinned, offset)
        velocity = np.where(hold, (pinned - feet.offset) * self.fps, np.where(catch, 0, velocity))
        return replace(feet, toes=toes, planted=planted, offset=offset, velocity=velocity)

    def _standing(self, feet: _Feet, toes: Array, speed: Array, shift: Array) -> BoolArray:
        """``(..., 2)``: strict to catch, loose to hold."""
        height = toes[..., 1] - self.floor
        hold = (speed < LOOSE_SPEED) & (height < LOOSE_HEIGHT) & (shift < MAX_SHIFT)
        catch = (speed < STRICT_SPEED) & (height < STRICT_HEIGHT) & (shift < MAX_SHIFT / 2)
        return np.asarray(np.where(feet.planted, hold, catch))

    def _sunk(self, feet: _Feet, wanted: Array) -> _Feet:
        """The pelvis follows the drop that is ``wanted`` as a critically damped spring."""
        gap, sinking = self._decayed(feet.drop - wanted, feet.sinking)
        return replace(feet, drop=np.maximum(wanted + gap, 0), sinking=sinking)

    def _decayed(self, offset: Array, velocity: Array) -> tuple[Array, Array]:
        """One frame of a critically damped spring towards zero, in closed form."""
        k, t = self._stiffness, 1 / self.fps
        pull = velocity + k * offset
        shrink = np.exp(-k * t)
        return (offset + pull * t) * shrink, (velocity - k * pull * t) * shrink


def _first(toes: Array) -> _Feet:
    nothing = np.zeros(toes.shape[:-2])
    return _Feet(toes, np.zeros(toes.shape[:-1], bool), np.zeros_like(toes), np.zeros_like(toes), nothing, nothing)
