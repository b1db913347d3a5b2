"""From the names of a rig's joints to ``smpl24`` roles: every name is read, then the readings settle each
other.

The same word means different joints in different conventions: ``LeftShoulder`` is the clavicle where there is
a ``LeftArm`` and the upper arm where there is a ``LeftCollar``; ``left_foot`` is the ankle unless there is a
``left_ankle``.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping

from motionrt.errors import RigError
from motionrt.rigs.joint_names import read_joint_name
from motionrt.rigs.tree import RigTree

Readings = Mapping[tuple[str, str], list[tuple[int, int]]]
"""``(side, part)`` -> the joints read so, as ``(doubt, joint)``."""


def roles_from_names(tree: RigTree, settled: Mapping[str, int]) -> dict[str, int]:
    """The ``smpl24`` roles that the joint names of ``tree`` state, ``role -> joint``.

    Args:
        tree: the rig.
        settled: roles that the caller has already decided; they are neither looked for nor contradicted.

    Raises:
        RigError: two joints in different branches claim the same role equally.
    """
    readings = _read_all(tree)
    roles = dict(settled)
    for side in ("left", "right"):
        for role, sources in _sided_sources(side, readings).items():
            _settle(roles, f"{side}_{role}", sources, tree)
        _settle_hand(roles, side, readings, tree)
    _settle(roles, "pelvis", _first(readings, "", "pelvis", "hip"), tree)
    _settle(roles, "neck", _first(readings, "", "neck"), tree)
    _settle(roles, "head", _first(readings, "", "head"), tree)
    return roles


_LEG, _ARM = ("thigh", "hip", "leg", "hipjoint"), ("upperarm", "shoulder", "clavicle")
_ALIKE = {
    **dict.fromkeys(_LEG, _LEG),
    **dict.fromkeys(_ARM, _ARM),
    "shin": ("shin", "leg"),
    "forearm": ("forearm",),
    "pelvis": ("pelvis", "hip"),
}
"""Parts that have others below them -> the parts that may stand for the same joint."""


def _read_all(tree: RigTree) -> Readings:
    """All readings, but not those of joints without any below (markers, helpers) where a joint with a limb says so."""
    readings: dict[tuple[str, str], list[tuple[int, int]]] = defaultdict(list)
    for joint, name in enumerate(tree.names):
        reading = read_joint_name(name)
        if reading is not None:
            readings[reading.side, reading.part].append((reading.doubt, joint))
    limbs = {at: [one for one in found if not tree.is_last(one[1])] for at, found in readings.items()}
    out = {}
    for (side, part), found in readings.items():
        alike = any(limbs.get((side, other)) for other in _ALIKE.get(part, (part,)))
        out[side, part] = limbs[side, part] if alike else found
    return {at: found for at, found in out.items() if found}


def _first(readings: Readings, side: str, *parts: str) -> list[tuple[int, int]]:
    """The joints of the first of ``parts`` that the rig has."""
    return next((readings[side, part] for part in parts if (side, part) in readings), [])


def _sided_sources(side: str, readings: Readings) -> dict[str, list[tuple[int, int]]]:
    """For each sided role (without its side) the joints that may fill it, conventions settled."""

    def has(part: str) -> bool:
        return (side, part) in readings

    leg_is_thigh = has("shin") and not has("thigh") and not has("hip")
    thigh = ("thigh", "hip", "leg", "hipjoint") if leg_is_thigh else ("thigh", "hip", "hipjoint")
    sources = {
        "hip": thigh,
        "knee": ("shin",) if leg_is_thigh else ("shin", "leg"),
        "ankle": ("ankle", "foot"),
        "foot": ("toe", "foot") if has("ankle") else ("toe",),
        "collar": ("clavicle", "shoulder") if has("upperarm") else ("clavicle",),
        "shoulder": ("upperarm", "shoulder"),
        "elbow": ("forearm",),
        "wrist": ("wrist", "hand"),
    }
    return {role: _first(readings, side, *parts) for role, parts in sources.items()}


def _settle(roles: dict[str, int], role: str, sources: list[tuple[int, int]], tree: RigTree) -> None:
    """Give ``role`` to the least doubtful source; among equals to the one above the others."""
    if role in roles or not sources:
        return
    if role.endswith("foot") and len({tree.parents[joint] for _, joint in sources}) == 1 and len(sources) > 2:
        sources = [min(sources, key=lambda one: tree.from_middle(one[1], [joint for _, joint in sources]))]
    least = min(doubt for doubt, _ in sources)
    best = [joint for doubt, joint in sources if doubt == least]
    top = [joint for joint in best if all(other == joint or tree.is_above(joint, other) for other in best)]
    if not top:
        claims = ", ".join(f"'{tree.names[joint]}'" for joint in best)
        raise RigError(f"several joints could be {role}: {claims}; say which with mapping={{'{role}': '<joint name>'}}")
    roles[role] = top[0]


def _settle_hand(roles: dict[str, int], side: str, readings: Readings, tree: RigTree) -> None:
    """The hand (middle knuckle) is the first named finger joint that stands away from the wrist."""
    wrist = roles.get(f"{side}_wrist")
    if f"{side}_hand" in roles or wrist is None:
        return
    for part in ("middle", "hand", "fingers", "index"):
        for _, joint in sorted(readings.get((side, part), [])):
            if tree.is_above(wrist, joint) and tree.span(wrist, joint) > tree.negligible:
                roles[f"{side}_hand"] = joint
                return
