"""Walking and acting: canonical frame, walks, transitions, anchor poses, scenes and paths, chained actions.

The names below are loaded when they are first used: a walk needs no scene, and searching motions none of them.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from motionrt.locomotion.actions import Act, Action, Do, Follow, Generate, Lie, Stand, Wait, WalkTo
    from motionrt.locomotion.avoidance import around_others
    from motionrt.locomotion.crowd import Crowd
    from motionrt.locomotion.goal_frame import Goal, canonicalise, uncanonicalise
    from motionrt.locomotion.path import Path, Waypoints
    from motionrt.locomotion.path_following import Pace
    from motionrt.locomotion.performance import Performance, PerformanceMeasures, Segment
    from motionrt.locomotion.posing import PoseSolution, solve_pose
    from motionrt.locomotion.scene import Agent, Scene
    from motionrt.locomotion.script import Script
    from motionrt.locomotion.streaming import Stream
    from motionrt.locomotion.walk import Walk
    from motionrt.locomotion.wishes import Wish
    from motionrt.locomotion.words import SemanticCloud, action_keypoints, load_cloud

_HOMES = {
    "actions": ("Act", "Action", "Do", "Follow", "Generate", "Lie", "Stand", "Wait", "WalkTo"),
    "avoidance": ("around_others",),
    "goal_frame": ("Goal", "canonicalise", "uncanonicalise"),
    "path_following": ("Pace",),
    "path": ("Path", "Waypoints"),
    "performance": ("Performance", "PerformanceMeasures", "Segment"),
    "posing": ("PoseSolution", "solve_pose"),
    "scene": ("Agent", "Scene"),
    "script": ("Script",),
    "crowd": ("Crowd",),
    "streaming": ("Stream",),
    "walk": ("Walk",),
    "wishes": ("Wish",),
    "words": ("SemanticCloud", "action_keypoints", "load_cloud"),
}
_HOME = {name: home for home, names in _HOMES.items() for name in names}

__all__ = [
    "Act",
    "Action",
    "Agent",
    "Crowd",
    "Do",
    "Follow",
    "Generate",
    "Goal",
    "Lie",
    "Pace",
    "Path",
    "Performance",
    "PerformanceMeasures",
    "PoseSolution",
    "Scene",
    "Script",
    "Segment",
    "SemanticCloud",
    "Stand",
    "Stream",
    "Wait",
    "Walk",
    "WalkTo",
    "Waypoints",
    "Wish",
    "action_keypoints",
    "around_others",
    "canonicalise",
    "load_cloud",
    "solve_pose",
    "uncanonicalise",
]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'motionrt.locomotion' has no attribute '{name}'")
    value = getattr(import_module(f"motionrt.locomotion.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
