"""The animations of an FBX file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from motionrt.formats.fbx.joints import pose_of
from motionrt.formats.fbx.scene import Scene, held, library


@dataclass(frozen=True, eq=False)
class Take:
    """What an animation stack animates, and from when to when, seconds."""

    name: str
    anim: Any
    time_begin: float
    time_end: float


def takes_of(scene: Scene) -> list[Take]:
    """All takes; one that states no time lasts from its first key to its last."""
    out = []
    for stack, anim in zip(scene.stacks, scene.anims, strict=True):
        begin, end = float(stack.time_begin), float(stack.time_end)
        if end <= begin:
            baked = held(library().bake_anim(scene.raw, anim))
            begin, end = float(baked.key_time_min), float(baked.key_time_max)
            baked.free()
        out.append(Take(str(stack.name), anim, begin, max(begin, end)))
    return out


def moves(stack: Take, nodes: Sequence[Any]) -> bool:
    """Whether a take moves any of the nodes."""
    times = np.linspace(stack.time_begin, stack.time_end, 7)
    poses = np.array([[pose_of(node.evaluate_transform(stack.anim, time)) for node in nodes] for time in times])
    return bool(np.abs(poses - poses[0]).max() > 1e-6)
