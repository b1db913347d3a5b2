"""Which layer moves which joint, and how that changes from one joint to the next at a seam."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.motion.body_parts import PART_JOINTS
from motionrt.motion.skeleton import SMPL24
from motionrt.synthesis.composing.combination import clash, with_support
from motionrt.synthesis.composing.layers import Derive, Layer, first_fills, given_parts, mask_joints

Weights = npt.NDArray[np.float64]

SEAM_JOINTS = ("spine1", "spine2", "spine3", "left_collar", "right_collar")
_SEAM = frozenset(SMPL24.index(name) for name in SEAM_JOINTS)


def ownership(layers: Sequence[Layer], *, derive: Derive | None = None, override: bool = True) -> Weights:
    """``(L, 24)``: the share of every layer in every joint; a column adds up to 1, and is 0s and one 1 without weights.

    Layers with parts come first, the one with the most parts lowest, in a tie the earlier one: this is SINC's order
    (B, with fewer parts, over A), for two layers exactly :func:`combination`. Masks lie over them in the order
    given, so a later mask wins. What nothing covers comes from the lowest layer.

    Raises:
        InvalidInputError: as :func:`given_parts`; or parts that clash or masks that overlap, and no ``override``.
    """
    parts = given_parts(layers, derive)
    masks = {number: mask_joints(layer.mask) for number, layer in enumerate(layers) if layer.mask is not None}
    if not override:
        _refuse_clashes(
            {n: of for n, of in enumerate(parts) if of is not None and not (n == 0 and first_fills(layers))}
        )
        _refuse_overlaps(masks)
    order = sorted((n for n, of in enumerate(parts) if of is not None), key=lambda n: -len(parts[n] or ()))
    weights = np.zeros((len(layers), len(SMPL24)))
    weights[order[0] if order else 0] = 1
    for number in order[1:]:
        _paint(weights, number, _part_joints(parts[number] or frozenset()), layers[number].weight)
    for number, joints in masks.items():
        _paint(weights, number, joints, layers[number].weight)
    return weights


def softened(weights: Weights, seam: int) -> Weights:
    """``(L, 24)`` shares that change gradually where one layer meets another.

    Below every joint whose child belongs to another layer, the first ``seam`` of the spine joints and collars that
    follow take 1/(seam + 1), 2/(seam + 1) ... from the child's layer and the rest from the parent's; a chain that has
    fewer such joints uses those it has. All other joints keep their shares.
    """
    out = weights.copy()
    for joint, parent in enumerate(SMPL24.parents):
        if parent >= 0 and joint in _SEAM and not np.array_equal(weights[:, joint], weights[:, parent]):
            chain = _chain(weights, joint)[:seam]
            for step, member in enumerate(chain, start=1):
                share = step / (len(chain) + 1)
                out[:, member] = (1 - share) * weights[:, parent] + share * weights[:, joint]
    return out


def _chain(weights: Weights, joint: int) -> list[int]:
    """``joint`` and the seam joints up the spine from it that have its shares."""
    chain = [joint]
    for above in sorted(_SEAM):
        follows = SMPL24.parents[above] == chain[-1] and SMPL24.names[above].startswith("spine")
        if follows and np.array_equal(weights[:, above], weights[:, joint]):
            chain.append(above)
    return chain


def _paint(weights: Weights, number: int, joints: Sequence[int], weight: float) -> None:
    covered = list(joints)
    weights[:, covered] *= 1 - weight
    weights[number, covered] += weight


def _part_joints(parts: frozenset[str]) -> list[int]:
    return [joint for part in with_support(parts) for joint in PART_JOINTS[part]]


def _refuse_clashes(parts: Mapping[int, frozenset[str]]) -> None:
    for i, j in combinations(parts, 2):
        if found := clash(parts[i], parts[j]):
            raise InvalidInputError(f"layers {i} and {j} both need {', '.join(sorted(found))}; override=True allows it")


def _refuse_overlaps(masks: Mapping[int, tuple[int, ...]]) -> None:
    for i, j in combinations(masks, 2):
        if both := set(masks[i]) & set(masks[j]):
            names = ", ".join(SMPL24.names[joint] for joint in sorted(both))
            raise InvalidInputError(f"the masks of layers {i} and {j} both have {names}; override=True allows it")
