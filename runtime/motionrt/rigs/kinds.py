"""Which product or database a rig comes from, by marks in its joint names; for people, nothing depends on it."""

from __future__ import annotations

import re
from collections.abc import Sequence

_MARKS = (
    ("Mixamo", r"^mixamorig\d*[:_]"),
    ("VRoid / VRM", r"^J_Bip_"),
    ("Reallusion", r"^CC_Base_"),
    ("3ds Max Biped", r"^Bip0*1"),
    ("Rigify", r"^(DEF|ORG|MCH)-"),
    ("Auto-Rig Pro", r"^(thigh|c_thigh|arm)_stretch"),
    ("Unreal Mannequin", r"^(thigh|calf|upperarm|lowerarm)_[lr]$"),
    ("Daz", r"^[lr](Thigh|Shin|Shldr|Buttock)(Bend|Twist)?$"),
    ("MMD", r"[足腕]"),
    ("CMU (ASF)", r"^[lr](femur|tibia|humerus|radius)$"),
    ("MakeHuman", r"^(upperleg|lowerleg|upperarm|lowerarm)\d\d[._][LR]$"),
    ("SMPL", r"^(left|right)_(hip|knee|ankle|collar)$"),
    ("Xsens", r"^(Right|Left)(UpperLeg|LowerLeg|UpperArm)$|^(L5|T8)$"),
    ("KayKit", r"^(upperleg|lowerleg|upperarm|lowerarm)\.[lr]$"),
    ("LeftHip / LeftKnee names", r"^(Left|Right)(Hip|Knee|Ankle)$"),
    ("MotionBuilder / Rokoko names", r"(^|[:_])(Left|Right)(UpLeg|ForeArm)$"),
)


def rig_kind(names: Sequence[str]) -> str:
    """The kind of the first mark that two names or more have; ``unknown names`` otherwise."""
    for kind, mark in _MARKS:
        if sum(bool(re.search(mark, name)) for name in names) >= 2:
            return kind
    return "unknown names"
