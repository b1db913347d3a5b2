"""GLB files that tests make and play for themselves, with ``json``, ``struct`` and SciPy: no code under test in it."""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from characters import Array, Character
from scipy.spatial.transform import Rotation


def local_frames(person: Character, kind: str, seed: int = 0) -> Array:
    """``(J, 3, 3)`` global rest orientations: ``"world"`` (none), ``"bone"`` (Y along the bone) or ``"random"``."""
    frames = np.tile(np.eye(3), (len(person.names), 1, 1))
    if kind == "random":
        return Rotation.random(len(person.names), random_state=seed).as_matrix()
    if kind == "bone":
        for joint in range(len(person.names)):
            child = next((j for j, p in enumerate(person.parents) if p == joint), None)
            if child is not None and np.linalg.norm(person.places[child] - person.places[joint]) > 1e-6:
                frames[joint] = Rotation.align_vectors([person.places[child] - person.places[joint]], [[0, 1, 0]])[
                    0
                ].as_matrix()
    return frames


@dataclass
class Glb:
    """A GLB file in the making: change ``document`` at will, then :meth:`save` it."""

    document: dict[str, Any]
    binary: bytearray

    def array(self, array: npt.NDArray[Any], kind: str) -> int:
        """Index of a new accessor."""
        self.binary += b"\0" * (-len(self.binary) % 4)
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": array.nbytes}
        self.binary += np.ascontiguousarray(array).tobytes()
        self.document["bufferViews"].append(view)
        component = {"float32": 5126, "uint16": 5123, "uint8": 5121, "int16": 5122}[array.dtype.name]
        accessor = {
            "bufferView": len(self.document["bufferViews"]) - 1,
            "componentType": component,
            "count": len(array),
            "type": kind,
        }
        if kind in {"SCALAR", "VEC3"}:
            accessor["min"] = np.atleast_1d(array.min(axis=0)).tolist()
            accessor["max"] = np.atleast_1d(array.max(axis=0)).tolist()
        self.document["accessors"].append(accessor)
        return len(self.document["accessors"]) - 1

    def animate(self, name: str, channels: list[tuple[int, str, Array, Array]], interpolation: str = "LINEAR") -> None:
        """Add an animation of ``(node, path, times, values)``."""
        animation: dict[str, Any] = {"name": name, "samplers": [], "channels": []}
        for node, path, times, values in channels:
            key = self.array(np.asarray(times, np.float32), "SCALAR")
            out = self.array(np.asarray(values, np.float32), "VEC4" if path == "rotation" else "VEC3")
            animation["samplers"].append({"input": key, "output": out, "interpolation": interpolation})
            animation["channels"].append(
                {"sampler": len(animation["samplers"]) - 1, "target": {"node": node, "path": path}}
            )
        self.document.setdefault("animations", []).append(animation)

    def to_bytes(self) -> bytes:
        self.document["buffers"] = [{"byteLength": len(self.binary)}]
        return container(self.document, bytes(self.binary))

    def save(self, path: Path) -> Path:
        path.write_bytes(self.to_bytes())
        return path


def container(document: dict[str, Any], binary: bytes) -> bytes:
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def glb(
    person: Character,
    *,
    frames: str = "bone",
    armature: tuple[Array, float] | None = None,
    unit: float = 1.0,
    posed: dict[int, Array] | None = None,
    seed: int = 0,
) -> Glb:
    """A skinned character: node ``0`` .. ``J - 1`` are its joints, then the armature (if any) and the mesh.

    Args:
        person: in the space of the scene.
        frames: orientations of the joints, see :func:`local_frames`.
        armature: rotation and scale of a node above the joints, which cancel out.
        unit: the file is this many times smaller than it should be: 0.01 gives a figure in centimetres, 180 units tall.
        posed: joint -> extra rotation ``(3, 3)`` that the node has, but the bind pose has not.
        seed: of random orientations.
    """
    turn, scale = armature if armature is not None else (np.eye(3), 1.0)
    places = person.places / unit
    axes = local_frames(person, frames, seed)
    nodes: list[dict[str, Any]] = []
    for joint, parent in enumerate(person.parents):
        above, origin = (axes[parent], places[parent]) if parent >= 0 else (turn, np.zeros(3))
        rotation = above.T @ axes[joint] @ (posed or {}).get(joint, np.eye(3))
        nodes.append({
            "name": person.names[joint],
            "translation": (above.T @ (places[joint] - origin) / scale).tolist(),
            "rotation": Rotation.from_matrix(rotation).as_quat().tolist(),
        })  # fmt: skip
        children = [j for j, p in enumerate(person.parents) if p == joint]
        if children:
            nodes[-1]["children"] = children
    top = person.parents.index(-1)
    if armature is not None:
        rotation = Rotation.from_matrix(turn).as_quat().tolist()
        nodes.append({"name": "Armature", "rotation": rotation, "scale": [scale] * 3, "children": [top]})
        top = len(nodes) - 1
    nodes.append({"name": "Body", "mesh": 0, "skin": 0})
    out = Glb(
        {
            "asset": {"version": "2.0", "generator": "somebody's tool"},
            "scene": 0, "scenes": [{"nodes": [top, len(nodes) - 1]}],
            "nodes": nodes, "accessors": [], "bufferViews": [], "extras": {"owner": "somebody"},
            "materials": [{"name": "Skin"}],
        },
        bytearray(),
    )  # fmt: skip
    _add_mesh(out, person, places, axes, scale)
    return out


def _add_mesh(out: Glb, person: Character, places: Array, axes: Array, scale: float) -> None:
    """One small triangle a joint."""
    count = len(person.names)
    corners = (places[:, None] + np.array([[0, 0, 0], [0.01, 0, 0], [0, 0.01, 0]])).reshape(-1, 3)
    joints = np.zeros((3 * count, 4), np.uint16)
    joints[:, 0] = np.repeat(np.arange(count), 3)
    bind = np.tile(np.eye(4), (count, 1, 1))
    bind[:, :3, :3] = axes * scale
    bind[:, :3, 3] = places
    inverse = np.swapaxes(np.linalg.inv(bind), -1, -2).astype(np.float32)
    attributes = {
        "POSITION": out.array(corners.astype(np.float32), "VEC3"),
        "JOINTS_0": out.array(joints, "VEC4"),
        "WEIGHTS_0": out.array(np.tile(np.array([1, 0, 0, 0], np.float32), (3 * count, 1)), "VEC4"),
    }
    out.document["meshes"] = [{"name": "Body", "primitives": [{"attributes": attributes, "material": 0}]}]
    skin = {"name": "Body", "joints": list(range(count)), "inverseBindMatrices": out.array(inverse, "MAT4")}
    out.document["skins"] = [skin]


def unpack(content: bytes) -> tuple[dict[str, Any], bytes]:
    """JSON and binary chunk of a GLB file."""
    (length,) = struct.unpack_from("<I", content, 12)
    document = json.loads(content[20 : 20 + length])
    return document, content[28 + length :]


class Player:
    """Plays the first animation of a GLB file at its own keys, with 4x4 matrices and SciPy."""

    def __init__(self, path: Path) -> None:
        self.document, self.binary = unpack(path.read_bytes())
        self.nodes = self.document["nodes"]
        self.parents = {child: i for i, node in enumerate(self.nodes) for child in node.get("children", [])}
        self.tracks: dict[tuple[int, str], Array] = {}
        self.times: Array = np.zeros(0)
        animation = self.document["animations"][0]
        for channel in animation["channels"]:
            sampler, target = animation["samplers"][channel["sampler"]], channel["target"]
            times = self.numbers(sampler["input"])
            self.times = times if len(times) > len(self.times) else self.times
            self.tracks[target["node"], target["path"]] = self.numbers(sampler["output"])

    def numbers(self, accessor: int) -> Array:
        entry = self.document["accessors"][accessor]
        view = self.document["bufferViews"][entry["bufferView"]]
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}[entry["type"]]
        start = view.get("byteOffset", 0) + entry.get("byteOffset", 0)
        values = np.frombuffer(self.binary, "<f4", entry["count"] * width, start).astype(np.float64)
        return values if width == 1 else values.reshape(-1, width)

    def matrices(self, frame: int) -> dict[str, Array]:
        """Global transform ``(4, 4)`` of every node, by name."""
        out: dict[int, Array] = {}

        def world(node: int) -> Array:
            if node not in out:
                above = world(self.parents[node]) if node in self.parents else np.eye(4)
                out[node] = above @ self._local(node, frame)
            return out[node]

        return {self.nodes[node]["name"]: world(node) for node in range(len(self.nodes))}

    def places(self, names: list[str]) -> Array:
        """``(F, N, 3)`` positions of the nodes called ``names``."""
        return np.array([[m[name][:3, 3] for name in names] for m in map(self.matrices, range(len(self.times)))])

    def _local(self, node: int, frame: int) -> Array:
        entry, out = self.nodes[node], np.eye(4)

        def value(path: str, default: list[float]) -> Array:
            track = self.tracks.get((node, path))
            return np.asarray(entry.get(path, default)) if track is None else track[min(frame, len(track) - 1)]

        rotation = Rotation.from_quat(value("rotation", [0, 0, 0, 1])).as_matrix()
        out[:3, :3] = rotation * value("scale", [1, 1, 1])
        out[:3, 3] = value("translation", [0, 0, 0])
        return out
