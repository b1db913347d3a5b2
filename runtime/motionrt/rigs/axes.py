"""Which way is up in a rig's file, and which of its sides is left: from the body, where names and format are
silent.
"""

from __future__ import annotations

import numpy as np

from motionrt.errors import RigError
from motionrt.motion.rotations import Array, normalise, rotation_between
from motionrt.rigs.pose import RigPose

_AXES = {"x": np.array([1.0, 0.0, 0.0]), "y": np.array([0.0, 1.0, 0.0]), "z": np.array([0.0, 0.0, 1.0])}
_FLOOR = 0.35
"""How far (in leg lengths) the lowest ankle of an upright clip may be from zero for its floor to count as
seen.
"""


def to_y_up(up: str | None, motion: RigPose, standing: Array | None) -> Array:
    """The rotation ``(3, 3)`` that takes a file's world axes to Y up.

    Args:
        up: ``"y"``, ``"z"`` or ``None`` where the format does not say.
        motion: all frames.
        standing: body axes of the rig's known standing pose, if there is one.
    """
    axis = _AXES[up] if up is not None else _vertical(motion, None if standing is None else standing[:, 1])
    return np.asarray(rotation_between(axis, _AXES["y"]))


def _vertical(motion: RigPose, standing: Array | None) -> Array:
    """The standing pose's up, unless the animation stands along another axis and never along that one."""
    shares = {name: _upright_share(motion, axis) for name, axis in _AXES.items() if name != "x"}
    best = max(shares, key=lambda name: shares[name])
    if standing is None:
        return _AXES[best] if shares[best] > 0 else _AXES["y"]
    other = shares[best] > 0.5 and _AXES[best] @ standing < 0.9 and _upright_share(motion, standing) < 0.02
    return _AXES[best] if other and _on_floor(motion, _AXES[best]) else standing


def _upright_share(motion: RigPose, axis: Array) -> float:
    """Share of the frames in which trunk and legs stand along ``axis``."""
    return float(((normalise(motion.trunk()) @ axis > 0.8) & (normalise(motion.legs()) @ axis > 0.7)).mean())


def _on_floor(motion: RigPose, axis: Array) -> bool:
    ankles = np.minimum(motion.at("left_ankle") @ axis, motion.at("right_ankle") @ axis)
    leg = np.median(np.linalg.norm(motion.legs(), axis=-1))
    return bool(abs(np.percentile(ankles, 5)) < _FLOOR * leg)


def sides_agree(motion: RigPose) -> bool:
    """Whether the joints in the roles of left ones are on the anatomical left: toes point forward, knees bend backward.

    Raises:
        RigError: the sides are only guessed and the body gives no sign (no toes, and the knees never bend).
    """
    sign = _toe_sign(motion)
    if abs(sign) < 0.25:
        sign = _knee_sign(motion)
    if not motion.roles.sided and abs(sign) < 0.05:
        raise RigError(
            "left and right of the rig cannot be told apart: no toes and no bent knee;"
            " name one side with mapping={'left_hip': '<joint name>', ...}"
        )
    return sign > (-0.25 if motion.roles.sided else 0)


def _toe_sign(motion: RigPose) -> float:
    """Mean cosine between the toes and what would be forward for the shanks; 0 without toes."""
    signs = [0.0]
    for side in ("left", "right"):
        if f"{side}_foot" in motion.roles.joints:
            shank = motion.bone(f"{side}_ankle", f"{side}_knee")
            forward = normalise(np.cross(motion.across(), shank))
            signs.append(2 * float((normalise(motion.bone(f"{side}_ankle", f"{side}_foot")) * forward).sum(-1).mean()))
    return sum(signs) / max(len(signs) - 1, 1) / 2


def _knee_sign(motion: RigPose) -> float:
    """Mean signed sine of the knee bend, positive if the knees bend as those of a person do."""
    left = normalise(motion.across())
    total = 0.0
    for side in ("left", "right"):
        thigh = normalise(motion.bone(f"{side}_hip", f"{side}_knee"))
        shank = normalise(motion.bone(f"{side}_knee", f"{side}_ankle"))
        total += float((np.cross(thigh, shank) * left).sum(-1).mean())
    return total / 2
