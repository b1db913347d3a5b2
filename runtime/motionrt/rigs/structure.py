"""Find a humanoid in a joint tree without believing its names: by branching, symmetry and bone lengths.

Legs and arms are the two pairs of like chains; the pair at the root's end of the trunk is the legs. Which
side is left is not decided here (see ``rig_axes``): the pairs come in the order of the file.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

from motionrt.errors import RigError
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


def roles_from_structure(tree: RigTree) -> dict[str, int]:
    """``smpl24`` roles ``role -> joint`` of the required joints, from the tree alone; sides may be exchanged.

    Raises:
        RigError: the tree has no two pairs of limbs; the message says what was looked for.
    """
    legs, arms = _legs_and_arms(tree)
    roles: dict[str, int] = {}
    for pair, parts in ((legs, ("hip", "knee", "ankle")), (arms, ("shoulder", "elbow", "wrist"))):
        start = _limb_start(tree, pair)
        for side, chain in (("left", pair.first), ("right", pair.second)):
            roles |= {f"{side}_{part}": joint for part, joint in zip(parts, chain[start:], strict=False)}
    return roles


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
