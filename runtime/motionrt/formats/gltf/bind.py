"""The bind pose of a skeleton: where its joints stood when the mesh was bound to them."""

from __future__ import annotations

import numpy as np

from motionrt.formats.gltf.accessors import GlbArrays
from motionrt.formats.gltf.container import Json
from motionrt.formats.gltf.nodes import NodeTree
from motionrt.formats.gltf.skeleton import LEAST_VOLUME, GlbSkeleton, inverse_binds
from motionrt.motion.rotations import Array, project_to_so3
from motionrt.motion.skeleton import FloatArray

_SAME = 1e-3


def bind_pose(
    document: Json, arrays: GlbArrays, tree: NodeTree, skeleton: GlbSkeleton
) -> tuple[FloatArray, FloatArray]:
    """Offsets ``(J, 3)``, metres, and local rotations ``(J, 3, 3)`` of the bind pose.

    The nodes themselves stand in it in most files. Where they are posed, the inverse bind matrices tell it, up to one
    transform for all joints: of those that are possible (none, that of a node above the joints) the one that leaves the
    joints nearest to where the nodes are.
    """
    nodes = global_nodes(tree, skeleton)
    inverse = inverse_binds(document, arrays, skeleton)
    if not inverse or _same_up_to_one_transform(nodes, inverse):
        return _local(nodes, skeleton.parents)
    posed = {joint: np.linalg.inv(matrix) for joint, matrix in inverse.items()}
    spaces = [np.eye(4), *(nodes[above] for above in _above_all(skeleton, posed))]
    space = min(spaces, key=lambda space: sum(_apart(space @ bind, nodes[joint]) for joint, bind in posed.items()))
    bound = nodes.copy()
    for joint, parent in enumerate(skeleton.parents):
        if joint in posed:
            bound[joint] = space @ posed[joint]
        elif parent >= 0:
            bound[joint] = bound[parent] @ _inverse(nodes[parent]) @ nodes[joint]
    return _local(bound, skeleton.parents)


def global_nodes(tree: NodeTree, skeleton: GlbSkeleton) -> Array:
    """``(J, 4, 4)`` global transforms of the joints as the nodes have them, scales and all."""
    out = np.tile(np.eye(4), (len(skeleton.nodes), 1, 1))
    for joint, (node, parent) in enumerate(zip(skeleton.nodes, skeleton.parents, strict=True)):
        out[joint, :3, :3] = tree.rotations[node] * tree.scales[node]
        out[joint, :3, 3] = tree.translations[node]
        if parent >= 0:
            out[joint] = out[parent] @ out[joint]
    return out


def _inverse(transform: Array) -> Array:
    """The inverse; of a node without extent, as scales of zero make it, the nearest to one."""
    flat = abs(np.linalg.det(transform[:3, :3])) <= LEAST_VOLUME
    return np.linalg.pinv(transform) if flat else np.linalg.inv(transform)


def _same_up_to_one_transform(nodes: Array, inverse: dict[int, Array]) -> bool:
    common = np.stack([nodes[joint] @ matrix for joint, matrix in inverse.items()])
    size = max(float(np.abs(nodes[:, :3, 3]).max()), 1e-9)
    spread = np.abs(common - common[0]).max(axis=0)
    turned = spread[:3, :3].max() / max(float(np.abs(common[0, :3, :3]).max()), 1e-12)
    return bool(turned < _SAME and spread[:3, 3].max() < _SAME * size)


def _above_all(skeleton: GlbSkeleton, posed: dict[int, Array]) -> list[int]:
    """Joints above the highest joint that has a bind matrix."""
    joint, out = skeleton.parents[min(posed)], []
    while joint >= 0:
        out.append(joint)
        joint = skeleton.parents[joint]
    return out


def _apart(a: Array, b: Array) -> float:
    return float(np.linalg.norm(a[:3, 3] - b[:3, 3]))


def _local(transforms: Array, parents: list[int]) -> tuple[FloatArray, FloatArray]:
    """Offsets and rotations without scale, such that the joints stand where ``(J, 4, 4)`` put them."""
    turned = project_to_so3(transforms[:, :3, :3])
    offsets, rest = transforms[:, :3, 3].copy(), turned.copy()
    for joint, parent in enumerate(parents):
        if parent >= 0:
            offsets[joint] = turned[parent].T @ (transforms[joint, :3, 3] - transforms[parent, :3, 3])
            rest[joint] = turned[parent].T @ turned[joint]
    return offsets.astype(np.float32), rest.astype(np.float32)
