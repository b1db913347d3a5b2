"""An animation for nodes of a GLB file: times, channels, quaternions that never flip."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from motionrt.formats.gltf.builder import GlbBuilder
from motionrt.formats.gltf.container import Json
from motionrt.motion.batches import by_batches
from motionrt.motion.rotations import Array, matrix_to_quaternion
from motionrt.motion.skeleton import FloatArray
from motionrt.rigs.clip import RigClip

_MOVES = 1e-6  # share of the rig's largest offset: a joint translated by less rests


def build_animation(
    builder: GlbBuilder, clip: RigClip, name: str, nodes: Sequence[int | None], units: Array, still: FloatArray
) -> Json:
    """All frames of ``clip`` as an animation, which the caller puts into the document.

    Args:
        builder: takes the keys.
        clip: rotations of all joints become channels, of a single key where they never change; translations those of
            roots, always with all keys, and of joints that move.
        name: of the animation.
        nodes: ``J`` node indices of the joints; ``None`` for a joint that no node stands for.
        units: ``(J,)`` what the translations of each joint are divided by: the scale of the nodes above.
        still: ``(J, 3)`` translations that the nodes have by themselves, in the clip's unit.
    """
    times = (np.arange(clip.frames, dtype=np.float64) / clip.fps).astype(np.float32)
    clock = builder.add(times, bounds=True)
    rests = [clip.frames > 1 and bool((turns == turns[0]).all()) for turns in np.swapaxes(clip.rotations, 0, 1)]
    start = builder.add(times[:1], bounds=True) if any(rests) else clock
    animation: Json = {"name": name, "samplers": [], "channels": []}
    moved = _moved(clip, still)
    for joint, node in enumerate(nodes):
        if node is None:
            continue
        turns = clip.rotations[:1, joint] if rests[joint] else clip.rotations[:, joint]
        _channel(builder, animation, start if rests[joint] else clock, node, "rotation", continuous_xyzw(turns))
        if moved[joint]:
            places = (clip.translations[:, joint] / units[joint]).astype(np.float32)
            _channel(builder, animation, clock, node, "translation", places)
    return animation


def continuous_xyzw(rotations: FloatArray) -> FloatArray:
    """Matrices ``(F, 3, 3)`` as unit quaternions ``(F, 4)``, xyzw, each on the same side as the one before it."""
    wxyz = by_batches(lambda part: matrix_to_quaternion(part.astype(np.float64)), rotations)
    flips = np.where((wxyz[1:] * wxyz[:-1]).sum(axis=-1) < 0, -1.0, 1.0)
    wxyz[1:] *= np.cumprod(flips)[:, None]
    return np.roll(wxyz, -1, axis=-1).astype(np.float32)


def _moved(clip: RigClip, still: FloatArray) -> list[bool]:
    size = float(np.abs(still).max(initial=1e-9))
    places = np.moveaxis(clip.translations, 1, 0)
    away = np.array([np.abs(place - here).max() for place, here in zip(places, still, strict=True)]) > _MOVES * size
    return [bool(moves) or parent < 0 for moves, parent in zip(away, clip.parents, strict=True)]


def _channel(builder: GlbBuilder, animation: Json, clock: int, node: int, path: str, keys: FloatArray) -> None:
    sampler = {"input": clock, "interpolation": "LINEAR", "output": builder.add(keys)}
    animation["samplers"].append(sampler)
    target = {"node": node, "path": path}
    animation["channels"].append({"sampler": len(animation["samplers"]) - 1, "target": target})
