"""One GLB file as a rig: its skeleton, its bind pose and the frames of one animation."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from motionrt.errors import FormatError
from motionrt.formats.gltf.accessors import GlbArrays
from motionrt.formats.gltf.bind import bind_pose
from motionrt.formats.gltf.choice import called, chosen, names_of
from motionrt.formats.gltf.clock import USUAL_FPS, frame_times
from motionrt.formats.gltf.container import Json, read_container
from motionrt.formats.gltf.humanoid import humanoid_nodes
from motionrt.formats.gltf.nodes import NodeTree, read_nodes
from motionrt.formats.gltf.skeleton import GlbSkeleton, find_skeleton
from motionrt.formats.gltf.tracks import Track, count_keys, read_tracks
from motionrt.limits import how_to_raise, limits
from motionrt.motion.batches import by_batches, fill
from motionrt.motion.rotations import Array, quaternion_to_matrix
from motionrt.motion.skeleton import FloatArray
from motionrt.rigs.clip import RigClip
from motionrt.untrusted.files import as_path

Tracks = dict[tuple[int, str], Track]


@dataclass(frozen=True, eq=False)
class GlbDocument:
    """An open GLB file.

    Attributes:
        path: where it came from.
        json: the glTF document.
        binary: its binary chunk.
        tree: all nodes.
        skeleton: the joints.
    """

    path: Path
    json: Json
    binary: bytes
    tree: NodeTree
    skeleton: GlbSkeleton

    @cached_property
    def arrays(self) -> GlbArrays:
        """Reader of the accessors."""
        return GlbArrays(self.json, self.binary, self.path)

    def tracks(self, animation: int | str | None) -> Tracks | None:
        """Tracks of one animation that moves the skeleton; ``None`` if none does.

        Raises:
            FormatError: there are several and none is chosen; lists their names.
        """
        entries = self.json.get("animations", [])
        names = names_of(entries)
        if animation is not None:
            return self._tracks(entries[chosen("animation", animation, names, self.path)]) or None
        found = self._moving
        if len(found) > 1:
            known = ", ".join(called(names, i) for i in found)
            raise FormatError(self.path, f"holds {len(found)} animations; choose with animation=, one of: {known}")
        return self._tracks(entries[found[0]]) if found else None

    @property
    def _moving(self) -> list[int]:
        """Indices of the animations of more than one key that move the skeleton, or of those that hold a pose of it."""
        entries = self.json.get("animations", [])
        keys = [count_keys(entry, self.arrays, self._joints) for entry in entries]
        return [i for i, count in enumerate(keys) if count > 1] or [i for i, count in enumerate(keys) if count]

    @property
    def animations(self) -> list[str]:
        """What the animations to choose from are called."""
        names = names_of(self.json.get("animations", []))
        return [called(names, i) for i in self._moving]

    @property
    def _joints(self) -> dict[int, int]:
        """Node index -> joint."""
        return {node: joint for joint, node in enumerate(self.skeleton.nodes)}

    def _tracks(self, animation: Json) -> Tracks:
        return read_tracks(animation, self.arrays, self._joints, self.path)

    def clip(self, tracks: Tracks | None, fps: float | None = None) -> RigClip:
        """All frames of ``tracks``; without any, the pose in which the nodes stand, as one frame."""
        frames, rate, times = 1, USUAL_FPS if fps is None else float(fps), np.zeros(1)
        if tracks:
            start, rate, frames = frame_times((track.times for track in tracks.values()), fps)
            keys = max(len(track.times) for track in tracks.values())
            if frames > min(max(limits().stretched_frames, 50 * keys), limits().frames):
                raise FormatError(
                    self.path,
                    f"its animation of {keys} keys has {frames:,} frames at {rate:g} fps; cut it, give a lower fps=, "
                    f"or: {how_to_raise('stretched_frames')}",
                )
            limit = "values" if frames <= 2 * keys else "stretched_values"
            if frames * len(self.skeleton.nodes) > getattr(limits(), limit):
                many = f"its animation has {frames:,} frames of {len(self.skeleton.nodes)} joints at {rate:g} fps"
                raise FormatError(self.path, f"{many}; cut it, or: {how_to_raise(limit)}")
            times = start + np.arange(frames) / rate
        offsets, rest = bind_pose(self.json, self.arrays, self.tree, self.skeleton)
        rotations, translations = self._sampled(tracks or {}, times)
        names, parents = self.skeleton.names, tuple(self.skeleton.parents)
        return RigClip(names, parents, offsets, rotations, translations, rate, "y", 1.0, rest, self._known())

    def _known(self) -> dict[str, str]:
        """The humanoid map of the file, if it has one, in names of the joints."""
        place, names = self._joints, self.skeleton.names
        nodes = humanoid_nodes(self.json)
        return {role: names[place[node]] for role, node in nodes.items() if node in place}

    def _sampled(self, tracks: Tracks, times: Array) -> tuple[FloatArray, FloatArray]:
        joints = len(self.skeleton.nodes)
        rotations = np.empty((len(times), joints, 3, 3), dtype=np.float32)
        translations = np.empty((len(times), joints, 3), dtype=np.float32)
        for joint, node in enumerate(self.skeleton.nodes):
            turn, move = tracks.get((joint, "rotation")), tracks.get((joint, "translation"))
            fill(rotations[:, joint], self.tree.rotations[node] if turn is None else _matrices(turn.at(times)))
            places = self.tree.translations[node] if move is None else move.at(times)
            fill(translations[:, joint], places * self.skeleton.units[joint])
        return rotations, translations


def open_glb(path: str | Path, skin: int | str | None = None) -> GlbDocument:
    """Read a GLB file and find its skeleton; errors as :func:`motionrt.formats.gltf.read.read_glb`."""
    path = as_path(path)
    document, binary = read_container(path)
    tree = read_nodes(document, path)
    return GlbDocument(path, document, binary, tree, find_skeleton(document, tree, path, skin))


def _matrices(xyzw: Array) -> Array:
    return by_batches(lambda part: quaternion_to_matrix(np.roll(part, 1, axis=-1)), xyzw)
