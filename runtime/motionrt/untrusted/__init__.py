"""Reading what strangers wrote: files, YAML, JSON and npz, within :mod:`motionrt.limits`.

Every reader is given ``fail``, which makes the typed error of its caller out of a reason and, where there is one, a
line: what is refused here is refused in the caller's words.
"""

from __future__ import annotations

from collections.abc import Callable

from motionrt.errors import MotionRTError

Fail = Callable[[str, int | None], MotionRTError]
"""Makes the caller's error out of a reason and a 1-based line."""

__all__ = ["Fail"]
