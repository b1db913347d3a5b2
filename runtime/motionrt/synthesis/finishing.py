"""The last touches of generated motions: where they begin, the floor, and feet that stand still."""

from __future__ import annotations

from motionrt.motion import Motion
from motionrt.motion.feet.lock import lock_feet


def finished(motion: Motion, foot_lock: bool = True) -> Motion:
    """Starting above the origin, facing +Z, on the floor; and standing feet stand still."""
    return locked(motion.canonical().grounded(), foot_lock)


def locked(motion: Motion, foot_lock: bool = True) -> Motion:
    """Where it is, and standing feet stand still."""
    return lock_feet(motion) if foot_lock else motion
