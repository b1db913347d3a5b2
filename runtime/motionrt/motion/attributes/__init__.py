"""What a clip does, measured from its joints: turn, path, speed, limbs, posture, jumps."""

from __future__ import annotations

from motionrt.motion.attributes.measuring import ATTRIBUTES, Attributes, measure
from motionrt.motion.attributes.postures import POSTURES

__all__ = ["ATTRIBUTES", "POSTURES", "Attributes", "measure"]
