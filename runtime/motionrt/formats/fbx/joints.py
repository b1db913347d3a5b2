"""Which nodes of an FBX file are the skeleton, how they are scaled, and how it stands at rest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from motionrt.errors import FormatError
from motionrt.formats.fbx.scene import Scene, held
from motionrt.motion.rotations import Array, normalise, quaternion_to_matrix

JOINT_LIMIT = 2048
_FEWEST_BONES = 8
_FIGURE = 0.75
"""Share of the bones that one tree must have for the others to be props."""


@dataclass(frozen=True, eq=False)
class Joints:
    """``J`` nodes, parents before children; ``units`` is the scale of all nodes above each."""

    nodes: Sequence[Any]
    parents: list[int]
    names: tuple[str, ...]
    units: Array


def find_joints(scene: Scene, path: Path) -> Joints:
    """The skeleton of a scene: its bones and all nodes above them, or nodes without mesh where there are no bones.

    Raises:
        FormatError: no skeleton, several, or too many joints.
    """
    every = [node for node in scene.nodes if not node.is_root]
    kinds = {node.typed_id: kinds for node, kinds in zip(scene.nodes, scene.attributes, strict=True)}
    bones = [node for node in every if kinds[node.typed_id][0] is not None]
    if len(bones) < _FEWEST_BONES:
        bones = [node for node in every if kinds[node.typed_id][1:] == (None, None, None)]
    if not bones:
        raise FormatError(path, "holds no skeleton: no bones and no empty nodes")
    members = _one_figure(bones, path)
    nodes = sorted((node for node in every if node.typed_id in members), key=lambda node: node.node_depth)
    if len(nodes) > JOINT_LIMIT:
        raise FormatError(path, f"has a skeleton of {len(nodes)} joints; at most {JOINT_LIMIT} are read")
    place = {node.typed_id: joint for joint, node in enumerate(nodes)}
    parents = [place.get(held(node.parent).typed_id, -1) for node in nodes]
    units = np.ones(len(nodes))
    for joint, parent in enumerate(parents):
        if parent >= 0:
            units[joint] = units[parent] * abs(float(np.mean(nodes[parent].local_transform.scale)))
    return Joints(nodes, parents, _unique([node.name for node in nodes]), units)


def _one_figure(bones: list[Any], path: Path) -> set[int]:
    """Ids of the bones of the largest tree and of all nodes above them."""
    trees: dict[int, list[Any]] = {}
    for bone in bones:
        trees.setdefault(_line(bone)[-1].typed_id, []).append(bone)
    largest = max(trees.values(), key=len)
    if len(largest) < _FIGURE * len(bones):
        tops = ", ".join(f"'{_line(tree[0])[-1].name}'" for tree in trees.values())
        raise FormatError(path, f"its bones hang on {len(trees)} nodes ({tops}); put one figure into a file")
    return {node.typed_id for bone in largest for node in _line(bone)}


def _line(node: Any) -> list[Any]:
    """``node`` and all above it but the scene's root, nearest first."""
    out = []
    while node is not None and not node.is_root:
        out.append(node)
        node = held(node.parent)
    return out


def _unique(names: list[str]) -> tuple[str, ...]:
    taken: dict[str, int] = {}
    out = []
    for name in names:
        taken[name] = taken.get(name, 0) + 1
        out.append(name if taken[name] == 1 else f"{name}_{taken[name]}")
    return tuple(out)


def pose_of(transform: Any) -> tuple[float, ...]:
    """Translation and quaternion ``x, y, z, w`` of a transform of ``ufbx``."""
    return (*transform.translation, *transform.rotation)


def turned(quaternions: Array) -> Array:
    """Rotations ``(N, 3, 3)`` of quaternions ``(N, 4)`` in the order of ``ufbx``."""
    return quaternion_to_matrix(normalise(np.roll(quaternions, 1, axis=-1)))


def standing(joints: Joints) -> tuple[Array, Array]:
    """Translations ``(J, 3)`` and local rotations ``(J, 3, 3)`` as the nodes stand without any animation."""
    poses = np.array([pose_of(node.local_transform) for node in joints.nodes])
    return poses[:, :3] * joints.units[:, None], turned(poses[:, 3:])


def rest_of(scene: Scene, joints: Joints) -> tuple[Array, Array]:
    """Offsets ``(J, 3)`` and local rotations ``(J, 3, 3)`` of the bind pose, or of the nodes where there is no skin."""
    offsets, rest = standing(joints)
    bound = _bind_matrices(scene, joints)
    if not bound:
        return offsets.astype(np.float32), rest
    places, turned = np.zeros((len(rest), 3)), np.zeros((len(rest), 3, 3))
    for joint, parent in enumerate(joints.parents):
        above, at = (turned[parent], places[parent]) if parent >= 0 else (np.eye(3), np.zeros(3))
        places[joint], turned[joint] = at + above @ offsets[joint], above @ rest[joint]
        if joint in bound:
            places[joint], turned[joint] = bound[joint][:, 3], _turn(bound[joint])
            offsets[joint], rest[joint] = above.T @ (places[joint] - at), above.T @ turned[joint]
    return offsets.astype(np.float32), rest


def _bind_matrices(scene: Scene, joints: Joints) -> dict[int, Array]:
    """Global transforms ``(3, 4)`` at binding by joint, from all skins."""
    place = {node.typed_id: joint for joint, node in enumerate(joints.nodes)}
    out: dict[int, Array] = {}
    for cluster in scene.clusters:
        node = held(cluster.bone_node)
        if node is not None and node.typed_id in place:
            matrix = _matrix(cluster.bind_to_world)
            if abs(np.linalg.det(matrix[:, :3])) > 1e-18:
                out.setdefault(place[node.typed_id], matrix)
    return out


def _matrix(matrix: Any) -> Array:
    """``(3, 4)`` of a matrix of ``ufbx``, whose columns are the axes and the place."""
    return np.array([matrix.c0, matrix.c1, matrix.c2, matrix.c3], dtype=np.float64).T


def _turn(matrix: Array) -> Array:
    """The rotation in ``(3, 4)`` without its scale."""
    u, _, v = np.linalg.svd(matrix[:, :3])
    return np.asarray(u @ np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ v))]) @ v)
