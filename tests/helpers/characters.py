"""Characters that tests make for themselves: skeletons under the names of the usual tools, laid out by hand."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
LEFT_RIGHT = (("left", 1.0), ("right", -1.0))
PARTS = ("collar", "shoulder", "elbow", "wrist", "hip", "knee", "ankle", "toe")
Z_UP = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])

_LABELS = ("sides", "prefix", "pelvis", "spine", "neck", "head", *PARTS)
NAMES: dict[str, dict[str, str]] = {
    "mixamo": dict(zip(_LABELS, (
        "Left Right", "mixamorig:", "Hips", "Spine Spine1 Spine2", "Neck", "Head",
        "{}Shoulder", "{}Arm", "{}ForeArm", "{}Hand",
        "{}UpLeg", "{}Leg", "{}Foot", "{}ToeBase",
    ), strict=True)),
    "unreal": dict(zip(_LABELS, (
        "l r", "", "pelvis", "spine_01 spine_02 spine_03 spine_04 spine_05", "neck_01", "head",
        "clavicle_{}", "upperarm_{}", "lowerarm_{}", "hand_{}",
        "thigh_{}", "calf_{}", "foot_{}", "ball_{}",
    ), strict=True)),
    "unity": dict(zip(_LABELS, (
        "Left Right", "", "Hips", "Spine Chest UpperChest", "Neck", "Head",
        "{}Shoulder", "{}UpperArm", "{}LowerArm", "{}Hand",
        "{}UpperLeg", "{}LowerLeg", "{}Foot", "{}Toes",
    ), strict=True)),
    "cmu": dict(zip(_LABELS, (
        "l r", "", "root", "lowerback upperback thorax", "lowerneck", "head",
        "{}clavicle", "{}humerus", "{}radius", "{}wrist",
        "{}femur", "{}tibia", "{}foot", "{}toes",
    ), strict=True)),
    "xsens": dict(zip(_LABELS, (
        "Left Right", "", "Pelvis", "L5 L3 T12 T8", "Neck", "Head",
        "{}Shoulder", "{}UpperArm", "{}ForeArm", "{}Hand",
        "{}UpperLeg", "{}LowerLeg", "{}Foot", "{}Toe",
    ), strict=True)),
    "rokoko": dict(zip(_LABELS, (
        "Left Right", "", "Hips", "Spine1 Spine2 Spine3 Spine4", "Neck", "Head",
        "{}Shoulder", "{}Arm", "{}ForeArm", "{}Hand",
        "{}Thigh", "{}Shin", "{}Foot", "{}Toe",
    ), strict=True)),
}  # fmt: skip


@dataclass(frozen=True)
class Character:
    """Joints in metres, Y up, facing +Z, soles at y = 0 (the toe joints stand ``sole`` above)."""

    names: list[str]
    parents: list[int]
    places: Array  # (J, 3)
    roles: dict[str, int]

    def turned(self, turn: Array) -> Character:
        return replace(self, places=self.places @ turn.T)


def character(
    scheme: str = "mixamo",
    *,
    pose: str = "t",
    spine: int | None = None,
    thigh: float = 0.46,
    shank: float = 0.44,
    foot: float = 0.17,
    ankle: float = 0.09,
    sole: float = 0.02,
    arm: float = 0.28,
    toes: bool = True,
    root: str | None = None,
    extras: bool = True,
) -> Character:
    """A person of the given build in a T-pose (``pose="t"``) or an A-pose (``"a"``)."""
    names = NAMES[scheme]
    out = _Growing(names["prefix"])
    height = ankle + thigh + shank + 0.08
    base = out.add(root, -1, [0, 0, 0]) if root else -1
    last = out.add(names["pelvis"], base, [0, height, 0], "pelvis")
    count = len(names["spine"].split()) if spine is None else spine
    labels = (names["spine"].split() + [f"Spine{k}" for k in range(10, 20)])[:count]
    for k, label in enumerate(labels):
        last = out.add(label, last, [0, height + 0.10 + 0.36 * k / max(count - 1, 1), -0.01], f"spine{k}")
    neck = out.add(names["neck"], last, [0, height + 0.56, 0], "neck")
    head = out.add(names["head"], neck, [0, height + 0.66, 0.02], "head")
    if extras:
        out.add("HeadTop_End", head, [0, height + 0.85, 0.02])
    down = np.deg2rad(48.0 if pose == "a" else 0.0)
    for (side, sign), word in zip(LEFT_RIGHT, names["sides"].split(), strict=True):
        label = {part: names[part].format(word) for part in PARTS}
        _add_arm(out, label, side, sign, last, height, down, arm, extras)
        spread = np.deg2rad(6.0 if pose == "a" else 0.0)
        leg = np.array([sign * np.sin(spread), -np.cos(spread), 0])
        hip = np.array([sign * 0.09, height - 0.08 + (thigh + shank) * (np.cos(spread) - 1), 0.0])
        joint = out.add(label["hip"], out.roles["pelvis"], hip, f"{side}_hip")
        if extras:
            out.add(f"{label['hip']}_twist_01", joint, hip + 0.5 * thigh * leg)
        joint = out.add(label["knee"], joint, hip + thigh * leg, f"{side}_knee")
        end = hip + (thigh + shank) * leg
        joint = out.add(label["ankle"], joint, end, f"{side}_ankle")
        if toes:
            joint = out.add(label["toe"], joint, [end[0], sole, end[2] + foot], f"{side}_foot")
            if extras:
                out.add(f"{label['toe']}_End", joint, [end[0], sole, end[2] + foot + 0.07])
    return Character(out.names, out.parents, np.array(out.places, dtype=np.float64), out.roles)


def _add_arm(
    out: _Growing, label: dict[str, str], side: str, sign: float, chest: int, height: float, down: float, arm: float,
    extras: bool,
) -> None:  # fmt: skip
    along = np.array([sign * np.cos(down), -np.sin(down), 0])
    joint = out.add(label["collar"], chest, [sign * 0.05, height + 0.45, 0], f"{side}_collar")
    start = np.array([sign * 0.18, height + 0.48, 0])
    joint = out.add(label["shoulder"], joint, start, f"{side}_shoulder")
    joint = out.add(label["elbow"], joint, start + arm * along, f"{side}_elbow")
    wrist = start + 1.92 * arm * along
    joint = out.add(label["wrist"], joint, wrist, f"{side}_wrist")
    if extras:
        for finger, ahead in (("Thumb", 0.03), ("Index", 0.02), ("Middle", 0.0)):
            knuckle = out.add(f"{label['wrist']}{finger}1", joint, wrist + 0.09 * along + [0, 0, ahead])
            out.add(f"{label['wrist']}{finger}2", knuckle, wrist + 0.12 * along + [0, 0, ahead])
        out.add(f"weapon_{side}", joint, wrist + 0.05 * along + [0, 0.0, 0.1])


class _Growing:
    def __init__(self, prefix: str) -> None:
        self.prefix, self.names, self.parents, self.places = prefix, list[str](), list[int](), list[Any]()
        self.roles: dict[str, int] = {}

    def add(self, name: str | None, parent: int, place: Any, role: str | None = None) -> int:
        self.names.append(f"{self.prefix}{name}")
        self.parents.append(parent)
        self.places.append(np.asarray(place, dtype=np.float64))
        if role:
            self.roles[role] = len(self.names) - 1
        return len(self.names) - 1


def bvh_text(person: Character, *, unit: float = 0.01, channels: int = 3, root_offset: bool = True) -> str:
    """A BVH file with one frame of the rest pose; ``unit`` metres per unit."""
    places, lines, columns = person.places / unit, ["HIERARCHY"], list[float]()

    def block(joint: int, indent: str) -> None:
        parent = person.parents[joint]
        offset = places[joint] - places[parent] if parent >= 0 else places[joint] * root_offset
        lines.append(f"{indent}{'JOINT' if parent >= 0 else 'ROOT'} {person.names[joint]}")
        lines.append(f"{indent}{{")
        lines.append(f"{indent}  OFFSET {offset[0]:.6f} {offset[1]:.6f} {offset[2]:.6f}")
        moved = parent < 0 or channels == 6
        lines.append(
            f"{indent}  CHANNELS {'6 Xposition Yposition Zposition' if moved else '3'} Yrotation Xrotation Zrotation"
        )
        columns.extend([*(places[joint] if parent < 0 else offset), 0, 0, 0] if moved else [0, 0, 0])
        children = [j for j, p in enumerate(person.parents) if p == joint]
        for child in children:
            block(child, indent + "  ")
        if not children:
            lines.extend(
                [f"{indent}  End Site", f"{indent}  {{", f"{indent}    OFFSET 0 {3 * 0.01 / unit:g} 0", f"{indent}  }}"]
            )
        lines.append(f"{indent}}}")

    block(person.parents.index(-1), "")
    lines += ["MOTION", "Frames: 1", "Frame Time: 0.0333333", " ".join(f"{value:.6f}" for value in columns), ""]
    return "\n".join(lines)
