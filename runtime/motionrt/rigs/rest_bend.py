"""Rest poses that bend knees and elbows although the file's rotations were made for straight ones.

Some conversions of the CMU database put rotations that are zero for straight limbs on a figure whose rest pose bends
knees by 8 and elbows by 17 degrees: every frame is bent too much by as much. Three signs together tell such a file: it
opens with a calibration pose, that is bent at all four hinges, and all four turn about one axis only, as the source's
hinges did. Any other file is taken at its word.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from motionrt.motion.rotations import Array, axis_angle_to_matrix, normalise
from motionrt.motion.skeleton import FloatArray
from motionrt.rigs.clip import RigClip
from motionrt.rigs.roles import RigRoles
from motionrt.rigs.tree import RigTree

_BENT = (np.deg2rad(3.0), np.deg2rad(30.0))
_OFF_AXIS = 0.06
"""Root mean square of the sine of the turn about other axes than the hinge's, up to which a joint is a hinge."""

_LIMBS = (("hip", "knee", "ankle"), ("shoulder", "elbow", "wrist"))
_SIDES = ("left", "right")


def without_rest_bend(clip: RigClip, roles: RigRoles, reference: FloatArray | None) -> RigClip:
    """``clip`` with straight limbs at rest where its rotations were made for those, else ``clip`` itself.

    Of the two bones of a limb the longer one keeps its direction and the shorter one is turned into its line. The bend
    is that of the straighter side: what only one side has is a pose.

    Args:
        clip: the motion, without its leading calibration pose.
        roles: which joint plays which role.
        reference: the calibration pose that led the file, local rotations ``(J, 3, 3)``, if there was one.
    """
    if reference is None or clip.rest is not None:
        return clip
    places = clip.rest_positions().astype(np.float64)
    lines = [[[roles.joints[f"{side}_{part}"] for part in limb] for side in _SIDES] for limb in _LIMBS]
    bends = [min(_bend(places, line) for line in pair) for pair in lines]
    hinged = all(_is_hinge(clip.rotations[:, line[1]]) for pair in lines for line in pair)
    if not hinged or not all(_BENT[0] < bend < _BENT[1] for bend in bends):
        return clip
    out = replace(clip, offsets=clip.offsets.copy(), translations=clip.translations.copy())
    tree = RigTree(clip)
    for pair, bend in zip(lines, bends, strict=True):
        for line in pair:
            _straighten(out, tree, places, line, bend)
    return out


def _bones(places: Array, line: Sequence[int]) -> tuple[Array, Array]:
    top, middle, end = places[list(line)]
    return middle - top, end - middle


def _bend(places: Array, line: Sequence[int]) -> float:
    """Angle in radians between the two bones of a limb."""
    upper, lower = _bones(places, line)
    return float(np.arccos(np.clip(normalise(upper) @ normalise(lower), -1, 1)))


def _is_hinge(rotations: FloatArray) -> bool:
    """Whether rotations ``(F, 3, 3)`` keep to one axis."""
    skew = 0.5 * (rotations - np.swapaxes(rotations, -1, -2)).astype(np.float64)
    axes = np.stack([skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0]], axis=-1)
    spread = np.linalg.eigvalsh(axes.T @ axes / len(axes))
    return bool(np.sqrt(max(spread[0] + spread[1], 0.0)) < _OFF_AXIS)


def _straighten(clip: RigClip, tree: RigTree, places: Array, line: Sequence[int], bend: float) -> None:
    """Turn the shorter bone of the limb by ``bend`` towards the line of the other, in place."""
    upper, lower = _bones(places, line)
    axis = normalise(np.cross(upper, lower))
    top, middle, end = line
    short_above = np.linalg.norm(upper) < np.linalg.norm(lower)
    turn = axis_angle_to_matrix(axis * (bend if short_above else -bend))
    for joint in tree.path(top, middle) if short_above else tree.path(middle, end):
        clip.offsets[joint] = turn @ clip.offsets[joint]
        clip.translations[:, joint] = clip.translations[:, joint] @ turn.T
