"""Which nodes of a GLB file are the skeleton, how they are scaled, and where its bind pose is."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from motionrt.errors import FormatError
from motionrt.formats.gltf.accessors import GlbArrays
from motionrt.formats.gltf.choice import chosen, names_of
from motionrt.formats.gltf.container import Json
from motionrt.formats.gltf.nodes import NodeTree
from motionrt.limits import how_to_raise, limits
from motionrt.motion.rotations import Array

SKIN_LIMIT = 256
_UNEVEN = 0.01
_CLEARLY_LARGER = 2.0
LEAST_VOLUME = 1e-18
"""A transform that makes volumes smaller than this, or larger than one over it, is none that can be turned back."""


@dataclass(frozen=True, eq=False)
class GlbSkeleton:
    """``J`` joints: those of a skin, all nodes between them and all above them.

    Attributes:
        nodes: ``J`` node indices, parents before children.
        parents: ``J`` indices into ``nodes``, ``-1`` for the root.
        names: ``J`` names, made unique: a second ``Hand`` is ``Hand_2``.
        units: ``(J,)`` scale of all nodes above each joint: what its translation is multiplied by.
    """

    nodes: list[int]
    parents: list[int]
    names: tuple[str, ...]
    units: Array


def find_skeleton(document: Json, tree: NodeTree, path: Path, skin: int | str | None) -> GlbSkeleton:
    """The skeleton of a document: that of its skin, or what its animations move where there is no skin.

    Raises:
        FormatError: several skeletons to choose from, none at all, several roots, or scales that no rig can have.
    """
    skinned = _skin_joints(document, tree, path, skin)
    moving = _moving(document, tree)
    joints = skinned or _below(moving, document, tree)
    if not joints:
        raise FormatError(path, "holds no skeleton: neither a skin nor an animated node")
    joints = _one_tree(joints, tree, path)
    members = _completed(tree.with_above(joints), moving, document, tree)
    if len(members) > limits().joints:
        raise FormatError(path, f"has a skeleton of {len(members)} joints: {how_to_raise('joints')}")
    nodes = [node for node in tree.order if node in members]
    parents = [nodes.index(tree.parents[node]) if tree.parents[node] >= 0 else -1 for node in nodes]
    units = _units(nodes, parents, tree, path)
    return GlbSkeleton(nodes, parents, _unique([tree.names[node] for node in nodes]), units)


def _skin_joints(document: Json, tree: NodeTree, path: Path, skin: int | str | None) -> set[int]:
    skins = [set(entry.get("joints", [])) for entry in document.get("skins", [])]
    names = names_of(document.get("skins", []))
    if len(skins) > SKIN_LIMIT:
        raise FormatError(path, f"holds {len(skins)} skins; at most {SKIN_LIMIT} are read")
    if any(not (isinstance(joint, int) and 0 <= joint < len(tree.names)) for joints in skins for joint in joints):
        raise FormatError(path, "a skin names joints that do not exist")
    if skin is not None:
        return skins[chosen("skin", skin, names, path)]
    figures = sorted(_connected(skins, tree), key=len, reverse=True)
    if len(figures) > 1 and len(figures[0]) < _CLEARLY_LARGER * len(figures[1]):
        raise FormatError(path, f"holds {len(figures)} skeletons; say which with skin=, one of: {', '.join(names)}")
    return figures[0] if figures else set()


def _connected(skins: list[set[int]], tree: NodeTree) -> list[set[int]]:
    """Skins of one figure (body, clothes, hair) put together: they share joints, or one hangs on the other's."""
    figures: list[set[int]] = []
    for joints in skins:
        reach, mine, others = tree.with_above(joints), set(joints), []
        for figure in figures:
            if figure & reach or joints & tree.with_above(figure):
                mine |= figure
            else:
                others.append(figure)
        figures = [*others, mine]
    return [figure for figure in figures if figure]


def _moving(document: Json, tree: NodeTree) -> set[int]:
    """Nodes that any animation turns or moves."""
    targets = {
        channel.get("target", {}).get("node")
        for animation in document.get("animations", [])
        for channel in animation.get("channels", [])
        if channel.get("target", {}).get("path") in {"rotation", "translation"}
    }
    return {node for node in targets if isinstance(node, int) and 0 <= node < len(tree.names)}


def _bare(document: Json) -> set[int]:
    return {i for i, node in enumerate(document.get("nodes", [])) if not {"mesh", "camera"} & set(node)}


def _below(moving: set[int], document: Json, tree: NodeTree) -> set[int]:
    """Without a skin: all nodes below the animated ones that carry neither mesh nor camera."""
    return {node for node in _bare(document) if moving.intersection(tree.above(node))}


def _completed(members: set[int], moving: set[int], document: Json, tree: NodeTree) -> set[int]:
    """``members`` and, where they are a part of a figure, the nodes of their tree that are the rest of it.

    A skin may cover the upper body alone, an animation move the arms alone: nodes that hang on a joint of the figure,
    carry neither mesh nor camera and are animated, or have two more generations below them, are joints as well.
    """
    skins = [set(skin.get("joints", [])) for skin in document.get("skins", [])]
    others = set().union(*(skin for skin in skins if not skin & members)) if skins else set()
    out, bare = set(members), _bare(document) - others
    anchors = {node for node in members if tree.parents[node] >= 0 or node in moving}
    for node in bare:
        line = tree.above(node)
        limb = any(above in bare and tree.parents[above] in anchors for above in line)
        if limb and not others.intersection(line) and (node in moving or _deep(line, members)):
            out.update(tree.with_above([node]) & (bare | members))
    return out


def _deep(line: list[int], members: set[int]) -> bool:
    """Whether a node stands at least two generations below the joint that it hangs on."""
    away = next((steps for steps, node in enumerate(line) if node in members), 0)
    return away > 2


def _one_tree(joints: set[int], tree: NodeTree, path: Path) -> set[int]:
    trees: dict[int, set[int]] = {}
    for joint in joints:
        trees.setdefault(tree.above(joint)[-1], set()).add(joint)
    largest = max(trees.values(), key=len)
    if len(largest) < 0.75 * len(joints):
        roots = ", ".join(f"'{tree.names[root]}'" for root in sorted(trees))
        raise FormatError(path, f"its skeleton has {len(trees)} roots ({roots}); put them under one node")
    return largest


def _units(nodes: list[int], parents: list[int], tree: NodeTree, path: Path) -> Array:
    units = np.ones(len(nodes))
    inner = set(parents)
    own = np.ones(len(nodes))
    for joint, node in enumerate(nodes):
        if parents[joint] >= 0:
            units[joint] = units[parents[joint]] * own[parents[joint]]
        if joint in inner:
            own[joint] = _even_scale(tree.scales[node], tree.names[node], path)
    return units


def _even_scale(scale: Array, name: str, path: Path) -> float:
    if (scale <= 0).any():
        what = "has no size (scale 0)" if not scale.all() else "is mirrored (negative scale)"
        raise FormatError(path, f"node '{name}' {what}; apply the scale in the tool that made the file")
    if scale.max() > (1 + _UNEVEN) * scale.min():
        sizes = ", ".join(f"{size:g}" for size in scale)
        raise FormatError(path, f"node '{name}' is scaled unevenly ({sizes}) above other joints; apply the scale")
    return float(scale.mean())


def _unique(names: list[str]) -> tuple[str, ...]:
    taken: set[str] = set()
    for i, name in enumerate(names):
        candidate, count = name, 1
        while candidate in taken:
            count += 1
            candidate = f"{name}_{count}"
        taken.add(candidate)
        names[i] = candidate
    return tuple(names)


def inverse_binds(document: Json, arrays: GlbArrays, skeleton: GlbSkeleton) -> dict[int, Array]:
    """Inverse bind matrices ``(4, 4)`` by joint of ``skeleton``; the first skin that has one for a joint says it."""
    place = {node: joint for joint, node in enumerate(skeleton.nodes)}
    out: dict[int, Array] = {}
    for skin in document.get("skins", []):
        if "inverseBindMatrices" not in skin or not set(skin.get("joints", [])) & set(place):
            continue
        matrices = arrays.matrices(skin["inverseBindMatrices"], "the bind pose")
        for node, matrix in zip(skin["joints"], matrices, strict=False):
            if node in place and LEAST_VOLUME < abs(np.linalg.det(matrix[:3, :3])) < 1 / LEAST_VOLUME:
                out.setdefault(place[node], np.vstack([matrix[:3], (0, 0, 0, 1)]))
    return out
