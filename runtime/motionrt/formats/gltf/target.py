"""Another animation in a GLB file that exists: everything in it stays, byte for byte; the new keys stand behind it."""

from __future__ import annotations

import base64
import copy
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from motionrt.errors import FormatError
from motionrt.formats.gltf.builder import GlbBuilder
from motionrt.formats.gltf.channels import build_animation
from motionrt.formats.gltf.container import Json, pack_container
from motionrt.formats.gltf.document import GlbDocument
from motionrt.rigs.clip import RigClip


@dataclass(frozen=True, eq=False)
class GlbTarget:
    """The GLB file of a rig."""

    document: GlbDocument

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
