"""The meshes of a GLB file that hang on its skeleton, as one skin.

A skinned vertex stands at the weighted sum of ``G_j B_j v``, with the global transform of joint ``j`` and its inverse
bind matrix [glTF 2.0, 3.7.3.3]. Seen from a joint without its scale that is one point a joint, which does not depend on
the pose: what :class:`~motionrt.rigs.skin.Skin` keeps. Meshes without a skin that hang on a joint move with it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from motionrt.errors import FormatError
from motionrt.formats.gltf.bind import global_nodes
from motionrt.formats.gltf.container import Json
from motionrt.formats.gltf.document import GlbDocument
from motionrt.formats.gltf.paint import Paint
from motionrt.formats.text import LARGEST_VALUE
from motionrt.motion.kinematics import fk
from motionrt.motion.rotations import Array
from motionrt.rigs.skin import INFLUENCES, Skin, joined

VERTEX_LIMIT, FACE_LIMIT = 1_000_000, 1_000_000
_TRIANGLES, _STRIP, _FAN = 4, 5, 6


def read_skin(document: GlbDocument) -> Skin:
    """All meshes on the skeleton of a document.

    Raises:
        FormatError: there is none, they are compressed or damaged, or there are too many vertices; says what to do.
    """
    reader = _Reader(document)
    meshes = [mesh for node, entry in enumerate(document.json["nodes"]) for mesh in reader.meshes(node, entry)]
    if not meshes:
        raise FormatError(document.path, "has no mesh on its skeleton: export the character with its mesh and skin")
    return joined(meshes)


class _Reader:
    def __init__(self, document: GlbDocument) -> None:
        self.document, self.json = document, document.json
        skeleton, tree = document.skeleton, document.tree
        self.place = {node: joint for joint, node in enumerate(skeleton.nodes)}
        self.nodes = global_nodes(tree, skeleton)
        moves = tree.translations[skeleton.nodes] * skeleton.units[:, None]
        places, turns = fk(tree.rotations[skeleton.nodes][None], moves[None, 0], moves[None], skeleton.parents)
        self.places, self.turns = np.asarray(places[0]), np.asarray(turns[0])
        self.paint = Paint(document)
        self.vertices = self.faces = 0

    def meshes(self, node: int, entry: Json) -> list[Skin]:
        """The primitives of a node."""
        if not isinstance(entry.get("mesh"), int) or isinstance(entry["mesh"], bool):
            return []
        matrices = self._matrices(node, entry)
        if matrices is None:
            return []
        mesh = self._entry("meshes", entry["mesh"])
        found = [self._primitive(part, matrices) for part in mesh.get("primitives", [])]
        return [part for part in found if part is not None]

    def _matrices(self, node: int, entry: Json) -> tuple[list[int], Array] | None:
        """Joints, and the ``(N, 4, 4)`` transforms from the mesh to where each joint puts it at rest."""
        if "skin" in entry:
            skin = self._entry("skins", entry["skin"])
            nodes = skin.get("joints", [])
            if not nodes or any(joint not in self.place for joint in nodes):
                return None
            joints = [self.place[joint] for joint in nodes]
            if "inverseBindMatrices" not in skin:
                return joints, self.nodes[joints]
            binds = self.document.arrays.matrices(skin["inverseBindMatrices"], "the bind pose")
            if len(binds) < len(joints):
                raise FormatError(self.document.path, "has fewer bind matrices than joints: the file is damaged")
            return joints, self.nodes[joints] @ binds[: len(joints)]
        line = self.document.tree.above(node)
        above = next((step for step, other in enumerate(line) if other in self.place), None)
        if above is None or self.document.tree.parents[line[above]] < 0:
            return None  # scenery that stands beside the figure
        matrix = self.nodes[self.place[line[above]]]
        for other in reversed(line[:above]):
            matrix = matrix @ _local(self.document.tree, other)
        return [self.place[line[above]]], matrix[None]

    def _primitive(self, part: Json, matrices: tuple[list[int], Array]) -> Skin | None:
        if any("draco" in name for name in part.get("extensions", {})):
            raise FormatError(self.document.path, "has its mesh compressed with Draco; export without compression")
        attributes, mode = part.get("attributes", {}), part.get("mode", _TRIANGLES)
        if "POSITION" not in attributes or mode not in {_TRIANGLES, _STRIP, _FAN}:
            return None  # points and lines
        points = self._numbers(attributes["POSITION"], 3)
        faces = _triangles(self._corners(part, len(points)), mode)
        self.vertices, self.faces = self.vertices + len(points), self.faces + len(faces)
        if self.vertices > VERTEX_LIMIT or self.faces > FACE_LIMIT:
            raise FormatError(self.document.path, f"has a mesh of more than {VERTEX_LIMIT:,} vertices; simplify it")
        if len(faces) and faces.max() >= len(points):
            raise FormatError(self.document.path, "has triangles of vertices that do not exist: the file is damaged")
        joints, weights = self._influences(attributes, len(points), len(matrices[0]))
        seen = np.einsum("vkij,vj->vki", matrices[1][joints][..., :3, :3], points) + matrices[1][joints][..., :3, 3]
        mine = np.array(matrices[0])[joints]
        local = np.einsum("vkji,vkj->vki", self.turns[mine], seen - self.places[mine])
        if not (np.abs(local) <= LARGEST_VALUE).all() or not np.isfinite(weights).all():
            raise FormatError(
                self.document.path, "has a mesh of numbers that are not finite or too large: it is damaged"
            )
        colours, shown = self.paint.of(part, faces, len(points))
        return Skin(faces[shown], colours[shown], mine, weights.astype(np.float32), local.astype(np.float32))

    def _corners(self, part: Json, count: int) -> Any:
        if "indices" not in part:
            return np.arange(count)
        return self.document.arrays.whole(part["indices"], "a mesh").reshape(-1)

    def _influences(self, attributes: Json, count: int, joints: int) -> tuple[Any, Array]:
        """Joints of the skin ``(V, 4)`` and their weights ``(V, 4)``, the strongest ones."""
        sets = [n for n in range(4) if f"JOINTS_{n}" in attributes and f"WEIGHTS_{n}" in attributes]
        if joints == 1 or not sets:
            weights = np.zeros((count, INFLUENCES))
            weights[:, 0] = 1
            return np.zeros((count, INFLUENCES), np.int64), weights
        arrays = self.document.arrays
        who = np.hstack([arrays.whole(attributes[f"JOINTS_{n}"], "a mesh").reshape(-1, 4) for n in sets])
        much = np.hstack([self._numbers(attributes[f"WEIGHTS_{n}"], 4) for n in sets])
        if who.shape != much.shape or len(who) != count or who.max() >= joints:
            raise FormatError(self.document.path, "has joints and weights that do not fit its mesh: it is damaged")
        strongest = np.argsort(-much, axis=1, kind="stable")[:, :INFLUENCES]
        who, much = np.take_along_axis(who, strongest, 1), np.maximum(np.take_along_axis(much, strongest, 1), 0)
        total = much.sum(axis=1, keepdims=True)
        much[total[:, 0] <= 0, 0] = 1
        return who, much / much.sum(axis=1, keepdims=True)

    def _numbers(self, accessor: int, width: int) -> Array:
        values = self.document.arrays.plain(accessor, "a mesh")
        if values.ndim != 2 or values.shape[1] != width:
            raise FormatError(self.document.path, "has a mesh of numbers that are no mesh: the file is damaged")
        return values

    def _entry(self, key: str, index: object) -> Json:
        entries = self.json.get(key, [])
        if not isinstance(index, int) or isinstance(index, bool) or not 0 <= index < len(entries):
            raise FormatError(self.document.path, f"refers to {key}[{index}], which does not exist")
        entry: Json = entries[index]
        return entry


def _triangles(corners: Any, mode: int) -> Any:
    if mode == _TRIANGLES:
        return corners[: len(corners) // 3 * 3].reshape(-1, 3)
    steps = np.arange(max(len(corners) - 2, 0))
    if mode == _FAN:
        return np.stack([np.full_like(corners[: len(steps)], corners[0]) if len(steps) else steps,
                         corners[steps + 1], corners[steps + 2]], axis=1)  # fmt: skip
    odd = steps % 2
    return np.stack([corners[steps], corners[steps + 1 + odd], corners[steps + 2 - odd]], axis=1)


def _local(tree: Any, node: int) -> Array:
    out = np.eye(4)
    out[:3, :3] = tree.rotations[node] * tree.scales[node]
    out[:3, 3] = tree.translations[node]
    return out
