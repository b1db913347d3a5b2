"""The nodes of a GLB file as a checked tree of translations, rotations and scales."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from heapq import heappop, heappush
from pathlib import Path
from typing import Any

import numpy as np

from motionrt.errors import FormatError
from motionrt.formats.gltf.container import Json
from motionrt.formats.text import LARGEST_VALUE
from motionrt.motion.rotations import Array, project_to_so3, quaternion_to_matrix

NODE_LIMIT, DEPTH_LIMIT = 65_536, 512


@dataclass(frozen=True, eq=False)
class NodeTree:
    """``N`` nodes.

    Attributes:
        names: as in the file, ``node_<index>`` where there is none; not unique.
        parents: ``N`` indices, ``-1`` for roots; in any order.
        order: all nodes, parents before children.
        translations: ``(N, 3)``.
        rotations: ``(N, 3, 3)``.
        scales: ``(N, 3)``; the first is negative where a matrix mirrors.
    """

    names: list[str]
    parents: list[int]
    order: list[int]
    translations: Array
    rotations: Array
    scales: Array

    def above(self, node: int) -> list[int]:
        """``node`` and all above it, nearest first."""
        out = []
        while node >= 0:
            out.append(node)
            node = self.parents[node]
        return out

    def with_above(self, nodes: Iterable[int]) -> set[int]:
        """``nodes`` and all above any of them."""
        out: set[int] = set()
        for start in nodes:
            node = start
            while node >= 0 and node not in out:
                out.add(node)
                node = self.parents[node]
        return out


def read_nodes(document: Json, path: Path) -> NodeTree:
    """All nodes of a document.

    Raises:
        FormatError: none or too many nodes, a node with two parents or above itself, or numbers that are no transform.
    """
    nodes = document.get("nodes", [])
    if not nodes:
        raise FormatError(path, "holds no nodes, so no skeleton")
    if len(nodes) > NODE_LIMIT:
        raise FormatError(path, f"holds {len(nodes)} nodes; at most {NODE_LIMIT} are read")
    names = [str(node.get("name") or f"node_{i}") for i, node in enumerate(nodes)]
    parents = _parents(nodes, names, path)
    order = _parents_first(parents, names, path)
    parts = [_transform(node, names[i], path) for i, node in enumerate(nodes)]
    translations, rotations, scales = (np.stack(part) for part in zip(*parts, strict=True))
    return NodeTree(names, parents, order, translations, rotations, scales)


def _parents(nodes: list[Json], names: list[str], path: Path) -> list[int]:
    parents = [-1] * len(nodes)
    for i, node in enumerate(nodes):
        for child in node.get("children", []):
            if not (isinstance(child, int) and 0 <= child < len(nodes)):
                raise FormatError(path, f"node '{names[i]}' has a child {child}, which does not exist")
            if parents[child] >= 0:
                raise FormatError(path, f"node '{names[child]}' hangs on two nodes: the file is no tree")
            parents[child] = i
    return parents


def _parents_first(parents: list[int], names: list[str], path: Path) -> list[int]:
    children: dict[int, list[int]] = {}
    for node, parent in enumerate(parents):
        children.setdefault(parent, []).append(node)
    order, waiting = [], [(node, 1) for node in children.get(-1, [])]
    while waiting:  # a heap: in the order of the file as far as parents allow
        node, depth = heappop(waiting)
        order.append(node)
        if depth > DEPTH_LIMIT:
            raise FormatError(path, f"its nodes are nested more than {DEPTH_LIMIT} deep")
        for child in children.get(node, []):
            heappush(waiting, (child, depth + 1))
    if len(order) < len(parents):
        lost = min(set(range(len(parents))) - set(order))
        raise FormatError(path, f"node '{names[lost]}' is its own ancestor: the nodes form a circle")
    return order


def _transform(node: Json, name: str, path: Path) -> tuple[Array, Array, Array]:
    if "matrix" in node:
        return _from_matrix(_vector(node, "matrix", 16, [], name, path).reshape(4, 4).T, name, path)
    quaternion = _vector(node, "rotation", 4, [0.0, 0.0, 0.0, 1.0], name, path)
    if np.linalg.norm(quaternion) < 1e-6:
        raise FormatError(path, f"the rotation of node '{name}' is a quaternion without length")
    translation = _vector(node, "translation", 3, [0.0] * 3, name, path)
    return translation, quaternion_to_matrix(np.roll(quaternion, 1)), _vector(node, "scale", 3, [1.0] * 3, name, path)


def _from_matrix(matrix: Array, name: str, path: Path) -> tuple[Array, Array, Array]:
    scale = np.linalg.norm(matrix[:3, :3], axis=0)
    if (scale < 1e-12).any():
        return matrix[:3, 3], np.eye(3), scale
    if np.linalg.det(matrix[:3, :3]) < 0:
        scale[0] = -scale[0]
    rotation = matrix[:3, :3] / scale
    if np.abs(rotation.T @ rotation - np.eye(3)).max() > 1e-2:
        raise FormatError(path, f"the matrix of node '{name}' shears; apply the transform in the tool that made it")
    return matrix[:3, 3], project_to_so3(rotation), scale


def _vector(node: Json, key: str, size: int, default: list[float], name: str, path: Path) -> Array:
    values: Any = node.get(key, default)
    numbers = isinstance(values, list) and all(
        isinstance(value, int | float) and abs(value) <= LARGEST_VALUE for value in values
    )
    if not numbers or len(values) != size:
        raise FormatError(path, f"the {key} of node '{name}' is not {size} finite numbers of sane size")
    return np.array(values, dtype=np.float64)
