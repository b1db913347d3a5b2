"""motionrt: search 3D human motion by text, make it, walk and act in scenes, on two CPU cores, offline, no torch.

The names below are loaded when they are first used, so that ``import motionrt`` costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from motionrt._lazy import lazily

if TYPE_CHECKING:
    from motionrt.errors import MotionRTError
    from motionrt.formats import load_character, load_motion, load_rig, load_target, save_motion
    from motionrt.locomotion import (
        Act,
        Do,
        Follow,
        Goal,
        Path,
        Performance,
        Scene,
        Script,
        Stand,
        Wait,
        Walk,
        WalkTo,
    )
    from motionrt.motion import SMPL24, Motion, Skeleton
    from motionrt.motion.body_parts import PARTS
    from motionrt.rendering import render
    from motionrt.retrieval import Gallery, Hit
    from motionrt.runtime import Runtime
    from motionrt.synthesis.composing import Layer

    __version__: str

__all__ = [
    "PARTS",
    "SMPL24",
    "Act",
    "Do",
    "Follow",
    "Gallery",
    "Goal",
    "Hit",
    "Layer",
    "Motion",
    "MotionRTError",
    "Path",
    "Performance",
    "Runtime",
    "Scene",
    "Script",
    "Skeleton",
    "Stand",
    "Wait",
    "Walk",
    "WalkTo",
    "__version__",
    "errors",
    "load_character",
    "load_motion",
    "load_rig",
    "load_target",
    "render",
    "save_motion",
]

_HOMES = {
    "errors": ("MotionRTError",),
    "formats": ("load_character", "load_motion", "load_rig", "load_target", "save_motion"),
    "locomotion": (
        "Act",
        "Do",
        "Follow",
        "Goal",
        "Path",
        "Performance",
        "Scene",
        "Script",
        "Stand",
        "Wait",
        "Walk",
        "WalkTo",
    ),
    "motion": ("SMPL24", "Motion", "Skeleton"),
    "motion.body_parts": ("PARTS",),
    "rendering": ("render",),
    "retrieval": ("Gallery", "Hit"),
    "runtime": ("Runtime",),
    "synthesis.composing": ("Layer",),
}
_load = lazily(__name__, _HOMES)


def __getattr__(name: str) -> Any:
    if name == "__version__":
        return _version()
    return import_module("motionrt.errors") if name == "errors" else _load(name)


def __dir__() -> list[str]:
    return sorted(__all__)


def _version() -> str:
    from importlib import metadata  # slow to import

    try:
        return metadata.version("motionrt")
    except metadata.PackageNotFoundError:
        return "0+unknown"
