"""Motions as pictures and animations: filmstrips, poses along a way, .gif and .mp4. Needs the extra ``render``."""

from __future__ import annotations

from motionrt.rendering.colours import THEMES, Colours
from motionrt.rendering.drawing import picture, render, render_as
from motionrt.rendering.files import FILMS, PICTURES
from motionrt.rendering.look import LAYOUTS, Layout, Look
from motionrt.rendering.takes import Mark, Take, TakeLike

__all__ = [
    "FILMS",
    "LAYOUTS",
    "PICTURES",
    "THEMES",
    "Colours",
    "Layout",
    "Look",
    "Mark",
    "Take",
    "TakeLike",
    "picture",
    "render",
    "render_as",
]
