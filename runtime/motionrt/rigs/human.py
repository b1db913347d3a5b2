"""Whether a rig is a person: hands, birds and four-legged animals have two pairs of limbs, too."""

from __future__ import annotations

import numpy as np

from motionrt.errors import RigError
from motionrt.motion.rotations import Array, normalise
from motionrt.rigs.joint_names import words_of
from motionrt.rigs.pose import RigPose
from motionrt.rigs.tree import RigTree

_FINGERS = frozenset({"thumb", "index", "pinky", "pinkie", "finger", "fingers", "metacarpal", "phalanx", "phalanges"})
_WINGS = frozenset({"wing", "wings", "feather", "feathers"})
_ANIMAL = _WINGS | {
    "beak",
    "paw",
    "hoof",
    "hooves",
    "claw",
    "fin",
    "tail",
    "snout",
    "muzzle",
    "mane",
    "udder",
    "fetlock",
}

_LIMBS = frozenset({"leg", "arm", "limb", "tentacle", "foreleg", "hindleg"})

_SHARES = {"thighs to shanks": (0.25, 4.0), "arms to legs": (0.2, 3.0), "trunk to legs": (0.12, 4.0)}
"""Of lengths; game characters with short legs and long arms are people as well."""

_NO_BONE = 1000.0
_LIMB, _MORE = 0.6, 2
"""Share of a leg's length from which on a line of joints is a limb; as many of them are more than tail and hair."""
_ALWAYS = 0.95
_LYING = 0.6
"""Cosine between trunk and vertical below which the trunk does not stand."""

_REACH = 0.35
"""Distance in leg lengths from the floor within which hands carry weight."""


def require_person(tree: RigTree, motion: RigPose, up: Array, *, stands: bool, sided: bool) -> None:
    """Refuse what has limbs but is no person.

    Args:
        tree: the rig.
        motion: all frames.
        up: ``(3,)`` the vertical.
        stands: whether the file has a pose in which a person could stand.
        sided: whether the names tell left and right.

    Raises:
        RigError: names, proportions or posture are not those of a person; says which.
    """
    reason = _by_names(tree, motion, stands) or _by_proportions(motion)
    reason = reason or _by_limbs(tree, motion, sided)
    if reason is None and not stands and _on_all_fours(motion, up):
        reason = "it always goes on all fours and has no pose in which a person could stand"
    if reason is not None:
        raise RigError(f"the rig is not that of a person: {reason}; if it is, name its joints with mapping=")


def _by_names(tree: RigTree, motion: RigPose, stands: bool) -> str | None:
    joints = motion.roles.joints
    said = {role: set(words_of(tree.names[joint])) for role, joint in joints.items()}
    for role in ("left_hip", "right_hip", "left_knee", "right_knee", "left_shoulder", "right_shoulder"):
        if said[role] & _FINGERS:
            return f"'{tree.names[joints[role]]}' would be its {role}: it is a hand"
    for role in ("left_shoulder", "right_shoulder", "left_elbow", "right_elbow"):
        if said[role] & _WINGS:
            return f"'{tree.names[joints[role]]}' would be its {role}: it has wings"
    animal = next((name for name in tree.names if _ANIMAL.intersection(words_of(name))), None)
    if animal is not None and not stands:
        return f"it has '{animal}' and no pose in which a person could stand"
    return None


def _by_proportions(motion: RigPose) -> str | None:
    def length(side: str, upper: str, lower: str) -> float:
        return float(np.median(np.linalg.norm(motion.bone(f"{side}_{upper}", f"{side}_{lower}"), axis=-1)))

    sides = ("left", "right")
    thigh, shank = (sum(length(s, *ends) for s in sides) for ends in (("hip", "knee"), ("knee", "ankle")))
    upper, lower = (sum(length(s, *ends) for s in sides) for ends in (("shoulder", "elbow"), ("elbow", "wrist")))
    if min(thigh, shank) * _NO_BONE <= max(thigh, shank):
        return None  # said better by what needs the bone
    trunk = 2 * float(np.median(np.linalg.norm(motion.trunk(), axis=-1)))
    leg = max(thigh + shank, 1e-12)
    found = {"thighs to shanks": thigh / max(shank, 1e-12), "arms to legs": (upper + lower) / leg}
    found["trunk to legs"] = trunk / leg
    odd = next((name for name, share in found.items() if not _SHARES[name][0] < share < _SHARES[name][1]), None)
    return (
        None if odd is None else f"the length of its {odd.replace(' to ', ' is to that of its ')} as {found[odd]:.2g}"
    )


def _by_limbs(tree: RigTree, motion: RigPose, sided: bool) -> str | None:
    """More limbs as long as legs than a person has; where the names tell the sides, only those called so count."""
    joints = motion.roles.joints
    ours = {joints[f"{side}_{part}"] for side in ("left", "right") for part in ("hip", "shoulder")}
    trunk = {joints["pelvis"], *motion.roles.spine, *motion.roles.neck}
    inside = ours | trunk | {other for joint in ours for other in tree.ancestors(joint)}
    leg = np.mean([tree.lengths[joints[f"{side}_{part}"]] for side in ("left", "right") for part in ("knee", "ankle")])
    more = [
        joint
        for joint in range(len(tree.names))
        if joint not in inside and tree.parents[joint] in trunk and _reach(tree, joint) > _LIMB * 2 * leg
        if not sided or _LIMBS.intersection(words_of(tree.names[joint]))
    ]
    return f"it has {4 + len(more)} limbs" if len(more) >= _MORE else None


def _reach(tree: RigTree, joint: int) -> float:
    """Length of the longest line of joints below one."""
    return max((float(tree.lengths[child]) + _reach(tree, child) for child in tree.children[joint]), default=0.0)


def _on_all_fours(motion: RigPose, up: Array) -> bool:
    leg = float(np.median(np.linalg.norm(motion.legs(), axis=-1)))
    lying = np.abs(normalise(motion.trunk()) @ up) < _LYING
    feet = np.minimum(motion.at("left_ankle") @ up, motion.at("right_ankle") @ up)
    hands = np.maximum(motion.at("left_wrist") @ up, motion.at("right_wrist") @ up)
    return bool((lying & (hands - feet < _REACH * leg)).mean() > _ALWAYS)
