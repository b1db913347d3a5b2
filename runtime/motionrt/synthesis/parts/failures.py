"""What can go wrong with somebody else's labeller."""

from __future__ import annotations

from motionrt.errors import MotionRTError


class LabellingError(MotionRTError, RuntimeError):
    """A language model cannot be reached, or its answer names no body part; the message quotes what it said."""
