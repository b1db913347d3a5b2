"""motionrt: search 3D human motion by text, make it, walk and act in scenes, on two CPU cores, offline, no torch.

The names below are loaded when they are first used, so that ``import motionrt`` costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from motionrt.errors import MotionRTError
    from motionrt.formats import load_motion, load_rig, save_motion
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
    "load_motion",
    "load_rig",
    "save_motion",
]

_HOMES = {
    "PARTS": "motion.body_parts",
    "SMPL24": "motion",
    "Act": "locomotion",
    "Do": "locomotion",
    "Follow": "locomotion",
    "Gallery": "retrieval",
    "Goal": "locomotion",
    "Hit": "retrieval",
    "Layer": "synthesis.composing",
    "Motion": "motion",
    "MotionRTError": "errors",
    "Path": "locomotion",
    "Performance": "locomotion",
    "Runtime": "runtime",
    "Scene": "locomotion",
    "Script": "locomotion",
    "Skeleton": "motion",
    "Stand": "locomotion",
    "Wait": "locomotion",
    "Walk": "locomotion",
    "WalkTo": "locomotion",
    "load_motion": "formats",
    "load_rig": "formats",
    "save_motion": "formats",
}


def __getattr__(name: str) -> Any:
    if name == "__version__":
        return _version()
    if name == "errors":
        return import_module("motionrt.errors")
    if name not in _HOMES:
        raise AttributeError(f"module 'motionrt' has no attribute '{name}'")
    value = getattr(import_module(f"motionrt.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)


def _version() -> str:
    from importlib import metadata  # slow to import

    try:
        return metadata.version("motionrt")
    except metadata.PackageNotFoundError:
        return "0+unknown"
