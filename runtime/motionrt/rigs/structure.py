"""Find a humanoid in a joint tree without believing its names: by branching, symmetry and bone lengths.

Legs and arms are the two pairs of like chains; the pair at the root's end of the trunk is the legs. Sides that the
names state bind both pairs; without any, legs and arms are on the same side where they stand on the same side, and
which one that is, the body says (see ``axes``).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from motionrt.errors import RigError
from motionrt.motion.rotations import Array
from motionrt.rigs.joint_names import side_of
from motionrt.rigs.tree import RigTree

_LIKENESS = 0.15
_PAIR_LIMIT = 1000


@dataclass(frozen=True)
class _Pair:
    """Two like chains that hang on one joint."""

    anchor: int
    first: tuple[int, ...]
    second: tuple[int, ...]
    length: float

    def swapped(self) -> _Pair:
        """The same pair with its chains exchanged."""
        return _Pair(self.anchor, self.second, self.first, self.length)


def roles_from_structure(tree: RigTree) -> tuple[dict[str, int], bool]:
    """``smpl24`` roles ``role -> joint`` of the required joints, and whether their sides are stated by names.

    Where they are not, left and right may be exchanged, but for legs and arms together.

    Raises:
        RigError: the tree has no two pairs of limbs; the message says what was looked for.
    """
    legs, arms = _legs_and_arms(tree)
    legs, arms, stated = _on_one_side(tree, legs, arms)
    roles: dict[str, int] = {}
    for pair, parts in ((legs, ("hip", "knee", "ankle")), (arms, ("shoulder", "elbow", "wrist"))):
        start = _limb_start(tree, pair)
        for side, chain in (("left", pair.first), ("right", pair.second)):
            roles |= {f"{side}_{part}": joint for part, joint in zip(parts, chain[start:], strict=False)}
    return roles, stated


def _on_one_side(tree: RigTree, legs: _Pair, arms: _Pair) -> tuple[_Pair, _Pair, bool]:
    """Both pairs with the same side first: left, if the names of either state sides."""
    said = [_stated_side(tree, pair) for pair in (legs, arms)]
    same = float((_across(tree, legs) * _across(tree, arms)).sum()) >= 0
    first = [side or (other if same else -other) for side, other in zip(said, reversed(said), strict=True)]
    if not any(said):
        first = [1, 1 if same else -1]
    pairs = [pair if side >= 0 else pair.swapped() for pair, side in zip((legs, arms), first, strict=True)]
    return pairs[0], pairs[1], any(said)


def _stated_side(tree: RigTree, pair: _Pair) -> int:
    """1 if the names call the first chain left or the second right, -1 the other way, 0 if they state nothing."""
    vote = {"left": 1, "right": -1, "": 0}
    votes = [vote[side_of(tree.names[joint])] for joint in pair.first]
    votes += [-vote[side_of(tree.names[joint])] for joint in pair.second]
    return int(np.sign(sum(votes)))


def _across(tree: RigTree, pair: _Pair) -> Array:
    """Vectors ``(S, 3)`` from the start of the second chain to that of the first, at a few frames."""
    start = _limb_start(tree, pair)
    return np.asarray(tree.places[:, pair.first[start]] - tree.places[:, pair.second[start]])


def _legs_and_arms(tree: RigTree) -> tuple[_Pair, _Pair]:
    pairs = _outer_pairs(tree)
    if len(pairs) < 2:
        found = "no pair" if not pairs else "only one pair"
        raise RigError(
            "the rig is not recognised as a humanoid: its joint names are not known,"
            f" and it has {found} of like limbs (legs and arms of three or more joints each);"
            " give the joints yourself with mapping={'left_hip': '<joint name>', ...}"
        )
    one, two = sorted(pairs, key=lambda pair: pair.length, reverse=True)[:2]
    if tree.is_above(one.anchor, two.anchor):
        return one, two
    if tree.is_above(two.anchor, one.anchor):
        return two, one
    return one, two  # both hang on one joint, or on branches of their own: legs are the longer pair


def _outer_pairs(tree: RigTree) -> list[_Pair]:
    """Pairs of like chains of at least three bones' joints that do not lie inside a limb of another pair."""
    found = [pair for anchor in range(len(tree)) for pair in _pairs_at(tree, anchor)]
    if len(found) > _PAIR_LIMIT:
        raise RigError("the rig is not recognised as a humanoid: it has hundreds of like limbs")
    outer: list[_Pair] = []
    for pair in found:
        inside = any(
            pair.anchor in (*other.first, *other.second) or tree.is_above(root, pair.anchor)
            for other in found
            for root in (other.first[0], other.second[0])
            if other is not pair
        )
        if not inside:
            outer.append(pair)
    longest = max((pair.length for pair in outer), default=0.0)
    return [pair for pair in outer if pair.length > 0.35 * longest]


def _pairs_at(tree: RigTree, anchor: int) -> list[_Pair]:
    chains = [tuple(tree.longest_chain(child)) for child in tree.children[anchor]]
    pairs = []
    for first, second in combinations(chains, 2):
        if _alike(tree, first, second):
            pairs.append(_Pair(anchor, first, second, tree.span(anchor, first[-1])))
    return pairs


def _alike(tree: RigTree, first: tuple[int, ...], second: tuple[int, ...]) -> bool:
    if min(len(first), len(second)) < 3:
        return False
    total = max(tree.span(first[0], first[-1]), tree.span(second[0], second[-1]))
    gaps = [abs(tree.lengths[a] - tree.lengths[b]) for a, b in zip(first, second, strict=False)]
    return total > 0 and max(gaps) < _LIKENESS * total


def _limb_start(tree: RigTree, pair: _Pair) -> int:
    """Where in the chains hip or shoulder stands: before two long bones with little beyond them."""
    both = zip(pair.first, pair.second, strict=False)
    bones = [float(tree.lengths[a] + tree.lengths[b]) for a, b in both]
    return max(range(len(bones) - 2), key=lambda i: bones[i + 1] + bones[i + 2] - 0.3 * sum(bones[i + 3 :]))
