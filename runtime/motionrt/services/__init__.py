"""What :class:`motionrt.Runtime` is composed of, each usable alone: who embeds walking opens nothing of search.

from motionrt.services import Locomotion
walk = Locomotion(threads=1).walk(to=(2, 3))
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from motionrt._lazy import lazily

if TYPE_CHECKING:
    from motionrt.services.locomotion import Locomotion
    from motionrt.services.search import Search
    from motionrt.services.synthesis import Synthesis

_HOMES = {"locomotion": ("Locomotion",), "search": ("Search",), "synthesis": ("Synthesis",)}

__all__ = ["Locomotion", "Search", "Synthesis"]

__getattr__ = lazily(__name__, _HOMES)
