"""Probe motions for the certification of a rig: each exercises one thing that retargeting can get wrong."""

from __future__ import annotations

import numpy as np

from motionrt.motion.motion import Motion
from motionrt.motion.rotations import Array, axis_angle_to_matrix
from motionrt.motion.skeleton import SMPL24

_FRAMES, _FPS = 90, 30.0


def probe_motions() -> dict[str, Motion]:
    """Name -> motion of ``smpl24``, three seconds each."""
    wave = np.sin(np.linspace(0, 4 * np.pi, _FRAMES))
    rise = np.sin(np.linspace(0, np.pi, _FRAMES)) ** 2
    arms_down = {f"{side}_shoulder": np.outer(np.ones(_FRAMES), [0, 0, -sign * 1.2]) for side, sign in _SIDED}
    return {
        "stand": _posed(arms_down),
        "left arm alone": _posed({**arms_down, "left_shoulder": np.outer(1.2 - 2.4 * rise, [0, 0, -1.0])}),
        "arms forward": _posed({f"{s}_shoulder": np.outer(-k * 1.4 * rise, [0, 1, 0]) for s, k in _SIDED}),
        "bent elbows": _posed({**arms_down, **{f"{s}_elbow": np.outer(-k * 2.2 * rise, [0, 1, 0]) for s, k in _SIDED}}),
        "turning forearms": _posed({f"{s}_wrist": np.outer(wave, [1, 0, 0]) for s, _ in _SIDED}),
        "walk on the spot": _stepping(wave, arms_down),
        "squat": _squat(rise, arms_down),
        "bow and turn": _posed(
            {
                **arms_down,
                **{f"spine{k}": np.outer(rise, [0.35, 0, 0]) + np.outer(wave, [0, 0.2, 0]) for k in (1, 2, 3)},
            }
        ),
        "whole turn": _posed({**arms_down, "pelvis": np.outer(np.linspace(0, 2 * np.pi, _FRAMES), [0, 1, 0])}),
        "head": _posed({**arms_down, "neck": np.outer(wave, [0.2, 0.4, 0]), "head": np.outer(wave, [0.1, 0.3, 0])}),
    }


_SIDED = (("left", 1), ("right", -1))


def _posed(vectors: dict[str, Array]) -> Motion:
    """A motion of rotation vectors ``(F, 3)`` by joint, the lower toe on the floor in every frame."""
    rotations = np.tile(np.eye(3), (_FRAMES, len(SMPL24), 1, 1))
    for name, vector in vectors.items():
        rotations[:, SMPL24.index(name)] = axis_angle_to_matrix(vector)
    flying = Motion(rotations.astype(np.float32), np.zeros((_FRAMES, 3), np.float32), _FPS)
    toes = flying.positions()[:, [SMPL24.index("left_foot"), SMPL24.index("right_foot")], 1]
    root = np.zeros((_FRAMES, 3), np.float32)
    root[:, 1] = -toes.min(axis=1)
    return Motion(rotations.astype(np.float32), root, _FPS)


def _stepping(wave: Array, arms: dict[str, Array]) -> Motion:
    vectors = dict(arms)
    for side, sign in _SIDED:
        lift = np.maximum(sign * wave, 0)
        vectors[f"{side}_hip"], vectors[f"{side}_knee"] = (
            np.outer(-0.8 * lift, [1, 0, 0]),
            np.outer(1.1 * lift, [1, 0, 0]),
        )
        vectors[f"{side}_ankle"] = np.outer(-0.3 * lift, [1, 0, 0])
    return _posed(vectors)


def _squat(depth: Array, arms: dict[str, Array]) -> Motion:
    vectors = dict(arms)
    for side, _ in _SIDED:
        for part, angle in (("hip", -1.5), ("knee", 2.0), ("ankle", -0.5)):
            vectors[f"{side}_{part}"] = np.outer(angle * depth, [1, 0, 0])
    return _posed(vectors)
