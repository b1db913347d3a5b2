"""Another animation in a user's GLB file: everything of his stays, byte for byte, the new keys stand behind it."""

from __future__ import annotations

import base64
import copy
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from motionrt.errors import FormatError, InvalidInputError
from motionrt.formats.atomic import write_bytes
from motionrt.formats.bvh.target import with_rest_frame
from motionrt.formats.bvh.write import UNITS, write_rig_bvh
from motionrt.formats.gltf.builder import GlbBuilder
from motionrt.formats.gltf.channels import build_animation
from motionrt.formats.gltf.container import Json, pack_container
from motionrt.formats.gltf.document import GlbDocument
from motionrt.rigs.clip import RigClip
from motionrt.rigs.target import RigMotion


@dataclass(frozen=True, eq=False)
class GlbFile:
    """The GLB file of a rig."""

    document: GlbDocument

    def save(self, motion: RigMotion, path: Path, *, units: str | None, t_pose: bool) -> Path:
        """See :meth:`motionrt.rigs.target.RigMotion.save`."""
        suffix = path.suffix.lower()
        if suffix == ".bvh":
            return self._as_bvh(motion, path, units or "cm", t_pose)
        if suffix != ".glb":
            raise InvalidInputError(f"{path}: a motion of a rig is written as .bvh or .glb")
        if units not in {None, "m"} or t_pose:
            raise InvalidInputError("units and t_pose are for .bvh; a .glb is in metres and knows its rest pose")
        content = self.with_animation(motion.clip, path.stem)
        return write_bytes(path, content)

    def with_animation(self, clip: RigClip, name: str) -> bytes:
        """The file with ``clip`` as its first animation, in place of one that has that name.

        Every joint has its rotation in it, so that the poses of other animations do not shine through.
        """
        source = self.document
        document: Json = copy.deepcopy(source.json)
        buffer = _own_buffer(document, source.path)
        builder = GlbBuilder(document, source.binary if buffer == 0 else b"", buffer)
        nodes, skeleton = source.skeleton.nodes, source.skeleton
        still = source.tree.translations[nodes] * skeleton.units[:, None]
        animation = build_animation(builder, clip, name, nodes, skeleton.units, still.astype(np.float32))
        others = [other for other in document.get("animations", []) if other.get("name") != name]
        document["animations"] = [animation, *others]
        binary = builder.finish()
        if buffer == 0:
            return pack_container(document, binary)
        uri = "data:application/octet-stream;base64," + base64.b64encode(binary).decode("ascii")
        document["buffers"][buffer]["uri"] = uri
        return pack_container(document, source.binary)

    def _as_bvh(self, motion: RigMotion, path: Path, units: str, t_pose: bool) -> Path:
        if units not in UNITS:
            raise InvalidInputError(f"units must be one of {', '.join(UNITS)}, not '{units}'")
        clip = with_rest_frame(motion.clip) if t_pose else motion.clip
        return write_rig_bvh(clip, path, scale=UNITS[units])


def _own_buffer(document: Json, path: Path) -> int:
    """Index of the buffer to append to: the binary chunk, or a new one where the file keeps its data elsewhere."""
    buffers = document.setdefault("buffers", [])
    if not buffers:
        buffers.append({"byteLength": 0})
        return 0
    if "uri" not in buffers[0]:
        return 0
    links = [str(entry.get("uri", "data:"))[:60] for entry in buffers]
    outside = [link for link in links if not link.startswith("data:")]
    if outside:
        raise FormatError(path, f"keeps data in another file ('{outside[0]}'); save everything in one .glb")
    buffers.append({"byteLength": 0})
    return len(buffers) - 1
