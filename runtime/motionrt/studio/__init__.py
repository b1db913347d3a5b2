"""Viewers in the browser: clips that play, and a studio to search, make and direct motion.

Everything that decides something (clock, layout, figure, picking, drafts of scripts) is plain Python and NumPy; viser
is imported only by the functions that open a page (``pip install "motionrt[studio]"``).
"""

from __future__ import annotations

from motionrt.studio.serving import open_studio, open_viewer

__all__ = ["open_studio", "open_viewer"]
