"""Which joint of a rig plays which role of ``smpl24``: the user's word, then names, then structure."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from itertools import pairwise

import numpy as np

from motionrt.errors import RigError
from motionrt.motion.skeleton import SMPL24
from motionrt.rigs.names import roles_from_names
from motionrt.rigs.structure import roles_from_structure
from motionrt.rigs.tree import RigTree

LEGS = ("hip", "knee", "ankle")
ARMS = ("shoulder", "elbow", "wrist")
REQUIRED = tuple(f"{side}_{part}" for part in LEGS + ARMS for side in ("left", "right"))

_ALIKE = 1.5
"""How many times as long the one of two like bones may be."""

_ALONG = 0.9
"""Cosine of the angle to the shank from which on a nameless end is no toe."""


@dataclass(frozen=True)
class RigRoles:
    """Which joint of a rig has which role.

    Attributes:
        joints: ``smpl24`` role -> joint index; ``REQUIRED`` and ``pelvis`` are always there.
        spine: joints above the pelvis up to the chest, lowest first; may be empty.
        neck: joints above the chest up to the head; may be empty only if the rig has neither neck nor head.
        sided: whether left and right are settled (by names or the user) or only a guess (structure).
    """

    joints: Mapping[str, int]
    spine: tuple[int, ...]
    neck: tuple[int, ...]
    sided: bool

    def swapped(self) -> RigRoles:
        """The same roles with left and right exchanged."""
        return RigRoles(_swapped(self.joints), self.spine, self.neck, True)

    def swapped_arms(self) -> RigRoles:
        """The same joints with the left and the right arm exchanged."""
        arms = {role: joint for role, joint in self.joints.items() if role.endswith(("collar", "hand", *ARMS))}
        return RigRoles({**self.joints, **_swapped(arms)}, self.spine, self.neck, self.sided)


def _swapped(roles: Mapping[str, int]) -> dict[str, int]:
    names = SMPL24.names
    return {names[SMPL24.mirrored_joints[names.index(role)]]: joint for role, joint in roles.items()}


def assign_roles(tree: RigTree, mapping: Mapping[str, str] | None) -> RigRoles:
    """Decide the roles of ``tree``.

    Args:
        tree: the rig.
        mapping: ``smpl24`` joint name -> rig joint name, complete or partial; it is believed.

    Raises:
        RigError: unknown names in ``mapping``, or required joints that neither names nor structure reveal.
    """
    given = _given_roles(tree, mapping or {})
    named = _completed(tree, roles_from_names(tree, given))
    sided = True
    if _missing(named) or _misplaced(tree, named):
        named, sided = _from_structure(tree, given, named)
    if "pelvis" not in given:
        _settle_pelvis(tree, named)
    spine, neck = _trunk(tree, named)
    _complete_collars(tree, named)
    if "neck" not in given:
        named.pop("neck", None)  # a neck of several joints is resampled as a whole, see RigRoles.neck
    return RigRoles(named, spine, neck, sided)


def _given_roles(tree: RigTree, mapping: Mapping[str, str]) -> dict[str, int]:
    roles = {}
    for role, name in mapping.items():
        if role not in SMPL24.names:
            near = get_close_matches(role, SMPL24.names, n=1)
            meant = f" (did you mean {near[0]}?)" if near else ""
            known = ", ".join(SMPL24.names)
            raise RigError(f"the mapping names '{role}', no joint of smpl24{meant}; there are: {known}")
        found = [joint for joint, other in enumerate(tree.names) if other == name]
        if len(found) != 1:
            near = get_close_matches(name, tree.names, n=5, cutoff=0.3) or list(tree.names)
            problem = "has no joint" if not found else f"has {len(found)} joints called"
            raise RigError(f"the mapping of {role}: the rig {problem} '{name}'; it has {', '.join(near)}")
        roles[role] = found[0]
    return roles


def _completed(tree: RigTree, roles: dict[str, int]) -> dict[str, int]:
    """Fill in what needs no name: limb ends that are just the next joint (or end site) of the chain.

    Hands and toes only where both sides have one, about as long: what hangs on one side alone is something else, and an
    end that goes on along the shank is no toe.
    """
    for role, above in (("wrist", "elbow"), ("hand", "wrist"), ("foot", "ankle")):
        found = {}
        for side in ("left", "right"):
            if f"{side}_{role}" not in roles and f"{side}_{above}" in roles:
                below = tree.next_away(roles[f"{side}_{above}"])
                if below is not None and not (role == "foot" and _straight_on(tree, roles, side, below)):
                    found[f"{side}_{role}"] = below
        if role == "wrist" or _alike(tree, {**roles, **found}, role, above):
            roles |= found
    return roles


def _straight_on(tree: RigTree, roles: Mapping[str, int], side: str, end: int) -> bool:
    """Whether a joint mostly stands where the shank would end if it were longer."""
    knee, ankle = roles.get(f"{side}_knee"), roles[f"{side}_ankle"]
    if knee is None:
        return False
    shank, foot = tree.places[:, ankle] - tree.places[:, knee], tree.places[:, end] - tree.places[:, ankle]
    sizes = np.linalg.norm(shank, axis=-1) * np.linalg.norm(foot, axis=-1)
    return bool(np.median((shank * foot).sum(axis=-1) / np.maximum(sizes, 1e-12)) > _ALONG)


def _alike(tree: RigTree, roles: Mapping[str, int], role: str, above: str) -> bool:
    """Whether both sides have the joint, about as far from the one above it."""
    ends = [(roles.get(f"{side}_{above}"), roles.get(f"{side}_{role}")) for side in ("left", "right")]
    spans = [tree.span(upper, lower) for upper, lower in ends if upper is not None and lower is not None]
    return len(spans) == 2 and max(spans) <= _ALIKE * min(spans)


def _missing(roles: Mapping[str, int]) -> list[str]:
    return [role for role in REQUIRED if role not in roles]


def _misplaced(tree: RigTree, roles: Mapping[str, int]) -> list[str]:
    """Roles that are not below the joint they should hang on, or that share a joint."""
    bad = []
    for side in ("left", "right"):
        for line in (LEGS, ARMS):
            for upper, lower in pairwise(line):
                above, below = roles[f"{side}_{upper}"], roles[f"{side}_{lower}"]
                if not tree.is_above(above, below) and not (lower == "ankle" and tree.rides(above, below)):
                    bad.append(f"{side}_{lower}")
    return bad + [f"right_{part}" for part in LEGS + ARMS if roles[f"left_{part}"] == roles[f"right_{part}"]]


def _from_structure(tree: RigTree, given: Mapping[str, int], named: Mapping[str, int]) -> tuple[dict[str, int], bool]:
    """Roles, and whether their sides are settled: by the user, by what names there are, or not."""
    try:
        found, sided = roles_from_structure(tree)
    except RigError as error:
        missing = _missing(named)
        if len(missing) == len(REQUIRED):
            raise
        raise RigError(_lacking(tree, missing or _misplaced(tree, named))) from error
    if _contradicts(found, named):
        raise RigError(_lacking(tree, _missing(named) or _misplaced(tree, named)))
    if any(_swapped(found).get(role) == joint for role, joint in given.items()):
        found = _swapped(found)
    sided = sided or any("_" in role for role in given)
    roles = _completed(tree, {**found, **given})
    bad = _misplaced(tree, roles)
    if bad:
        raise RigError(_lacking(tree, bad))
    return roles, sided


def _contradicts(found: Mapping[str, int], named: Mapping[str, int]) -> bool:
    """Whether the structure takes a joint of a leg for one whose name says that it is of an arm, or the other way."""
    limbs = {joint: _limb(role) for role, joint in named.items()}
    return any(limbs.get(joint, limb) != limb for limb, joint in ((_limb(role), j) for role, j in found.items()))


def _limb(role: str) -> str:
    """``leg``, ``arm`` or the role itself."""
    part = role.rsplit("_", maxsplit=1)[-1]
    return "leg" if part in (*LEGS, "foot") else "arm" if part in (*ARMS, "hand") else role


def _lacking(tree: RigTree, roles: list[str]) -> str:
    return (
        f"the rig has no usable joint for {', '.join(roles)};"
        f" name them with mapping={{'{roles[0]}': '<joint name>', ...}}"
        f" (its joints are {', '.join(tree.names)})"
    )


def _meeting(tree: RigTree, joints: list[int], what: str) -> int:
    meeting = tree.meeting(joints)
    if meeting is None or meeting in joints:
        raise RigError(f"the {what} of the rig do not hang on one common joint; is it one figure?")
    return meeting


def _settle_pelvis(tree: RigTree, roles: dict[str, int]) -> None:
    """A named pelvis counts if both legs hang on it, otherwise the joint on which they do."""
    hips = [roles["left_hip"], roles["right_hip"]]
    pelvis = roles.get("pelvis")
    if pelvis is None or not all(tree.is_above(pelvis, hip) for hip in hips):
        roles["pelvis"] = _meeting(tree, hips, "hips")


def _complete_collars(tree: RigTree, roles: dict[str, int]) -> None:
    """A joint between chest and shoulder is the collar even if its name does not say so."""
    chest = _meeting(tree, [roles["left_shoulder"], roles["right_shoulder"]], "shoulders")
    for side in ("left", "right"):
        between = tree.path(chest, roles[f"{side}_shoulder"])[:-1]
        if between:
            roles.setdefault(f"{side}_collar", between[-1])


def _trunk(tree: RigTree, roles: dict[str, int]) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """The joints of spine and neck: from the pelvis to the chest and on to the head, or what there is."""
    chest = _meeting(tree, [roles["left_shoulder"], roles["right_shoulder"]], "shoulders")
    base = tree.meeting([roles["pelvis"], chest])
    spine = tree.path(base, chest) if base is not None else []
    top = roles.get("head", roles.get("neck"))
    if top is None:
        top = _unnamed_head(tree, chest, roles)
    neck = tree.path(chest, top) if top is not None else []
    if not neck:
        raise RigError("the rig has neither head nor neck above its shoulders; name one with mapping={'head': ...}")
    return tuple(spine), tuple(neck)


def _unnamed_head(tree: RigTree, chest: int, roles: Mapping[str, int]) -> int | None:
    arms = {joint for side in ("left", "right") for joint in tree.ancestors(roles[f"{side}_shoulder"])}
    free = [child for child in tree.children[chest] if child not in arms]
    if not free:
        return None
    chain = max((tree.longest_chain(child) for child in free), key=lambda line: tree.span(chest, line[-1]))
    return chain[-2] if len(chain) > 1 and tree.names[chain[-1]].endswith("_end") else chain[-1]
