"""The humanoid map of a VRM: the file itself says which node is which bone of the body."""

from __future__ import annotations

from typing import Any

from motionrt.formats.gltf.container import Json

_ROLES = {
    "hips": "pelvis",
    "neck": "neck",
    "head": "head",
    "UpperLeg": "hip",
    "LowerLeg": "knee",
    "Foot": "ankle",
    "Toes": "foot",
    "Shoulder": "collar",
    "UpperArm": "shoulder",
    "LowerArm": "elbow",
    "Hand": "wrist",
    "MiddleProximal": "hand",
}
_EXTENSIONS = ("VRMC_vrm", "VRMC_vrm_animation", "VRM")


def humanoid_nodes(document: Json) -> dict[str, int]:
    """``smpl24`` joint name -> node index as the VRM extensions (0.x, 1.0, animation) say; empty without one."""
    extensions = document.get("extensions", {})
    for name in _EXTENSIONS:
        humanoid = extensions.get(name, {}).get("humanoid", {}) if isinstance(extensions, dict) else {}
        bones = _bones(humanoid.get("humanBones") if isinstance(humanoid, dict) else None)
        if bones:
            return {role: node for bone, node in bones.items() if (role := _role(bone)) is not None}
    return {}


def add_humanoid(document: Json) -> None:
    """Say which bone of a VRM each node named as in ``smpl24`` is  [VRMC_vrm_animation 1.0]."""
    named = {str(node.get("name")): i for i, node in enumerate(document["nodes"])}
    words = {
        **{role: bone for bone, role in _ROLES.items()},
        "spine1": "spine",
        "spine2": "chest",
        "spine3": "upperChest",
    }
    del words["hand"]
    bones = {}
    for role, node in named.items():
        side, _, part = role.partition("_")
        if role in words:
            bones[words[role]] = {"node": node}
        elif side in {"left", "right"} and part in words:
            bones[side + words[part]] = {"node": node}
    extension = {"specVersion": "1.0", "humanoid": {"humanBones": bones}}
    document.setdefault("extensions", {})["VRMC_vrm_animation"] = extension
    document["extensionsUsed"] = [*document.get("extensionsUsed", []), "VRMC_vrm_animation"]


def _bones(entries: Any) -> dict[str, int]:
    """Bone name -> node, from the object of VRM 1.0 or the list of VRM 0.x."""
    if isinstance(entries, list):
        entries = {entry.get("bone"): entry for entry in entries if isinstance(entry, dict)}
    if not isinstance(entries, dict):
        return {}
    found = {str(bone): entry.get("node") for bone, entry in entries.items() if isinstance(entry, dict)}
    return {bone: node for bone, node in found.items() if isinstance(node, int) and not isinstance(node, bool)}


def _role(bone: str) -> str | None:
    for side in ("left", "right"):
        if bone.startswith(side):
            part = _ROLES.get(bone[len(side) :])
            return None if part is None else f"{side}_{part}"
    return _ROLES.get(bone)
