"""The last touches of generated motions: where they begin, the floor, and feet that stand still."""

from __future__ import annotations

from motionrt.motion import Motion
from motionrt.motion.feet.flat_ground import upright_ground
from motionrt.motion.feet.lock import lock_feet
from motionrt.motion.feet.sliding import step_where_sliding

SWINGS_FROM = 0.4  # m/s: a generated foot that swings drags more than a recorded one


def finished(motion: Motion, foot_lock: bool = True, *, walking: bool = False) -> Motion:
    """Starting above the origin, facing +Z, on the floor all the way; and standing feet stand still."""
    return locked(upright_ground(motion.canonical().grounded()), foot_lock, walking=walking)


def locked(motion: Motion, foot_lock: bool = True, *, walking: bool = False) -> Motion:
    """Where it is; standing feet stand still, and feet that slid take steps.

    With `walking` also where neither foot stands; not in loops and where poses are kept, whose feet have their places.
    """
    if not foot_lock:
        return motion
    return lock_feet(step_where_sliding(motion, walking=walking), swings_from=SWINGS_FROM)
