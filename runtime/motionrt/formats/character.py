"""A character of the user's own with its mesh, and how it looks in a motion: for pictures and for the studio."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.formats.gltf.container import GLTF_SUFFIXES
from motionrt.formats.gltf.document import open_glb
from motionrt.formats.gltf.skin import read_skin
from motionrt.formats.target import load_target
from motionrt.motion.motion import Motion
from motionrt.motion.skeleton import FloatArray
from motionrt.rigs.retarget_out import to_rig
from motionrt.rigs.skin import Skin
from motionrt.rigs.target import Rig, RigMotion
from motionrt.untrusted.files import as_path

_WHOLE = (".glb", ".vrm")


@dataclass(frozen=True, eq=False)
class Character:
    """Somebody to see a motion on; :func:`load_character` reads one.

    Attributes:
        name: of its file, without the suffix.
        rig: its joints.
        skin: its mesh, in the unit and axes of the file.
        file: where it came from.
        content: of the file, where that is all there is of it (``.glb``, ``.vrm``).
    """

    name: str
    rig: Rig
    skin: Skin
    file: Path
    content: bytes = b""

    def __repr__(self) -> str:
        return f"Character('{self.name}', {len(self.rig.clip.names)} joints, {len(self.skin.faces)} triangles)"

    def retargeted(self, motion: Motion) -> RigMotion:
        """The motion on its rig, to be saved; errors as :func:`motionrt.rigs.retarget_out.to_rig`."""
        return to_rig(motion, self.rig)

    def dressed(self, motion: Motion) -> Dressed:
        """The character in a motion, as tall as the motion's own figure, where that stands.

        Raises:
            RigError: the rig is no humanoid, or has no known standing pose; says what to do.
        """
        moved = self.retargeted(motion)
        size, to_world = 1 / moved.units_per_metre, moved.to_world.astype(np.float32)
        places, turns = moved.clip.global_pose()
        still, rest = self.rig.clip.rest_pose()
        skin = replace(self.skin, local=(size * self.skin.local).astype(np.float32))
        to_metres = np.float32(size) * to_world.T
        return Dressed(skin, places @ to_metres, to_world @ turns, still @ to_metres, to_world @ rest, motion.fps)


@dataclass(frozen=True, eq=False)
class Dressed:
    """A character in a motion; metres, Y up.

    Attributes:
        skin: the mesh.
        places: ``(F, J, 3)`` where the joints are.
        turns: ``(F, J, 3, 3)`` how they are turned, globally.
        rest_places: ``(J, 3)`` the same in the pose that the mesh was bound in.
        rest_turns: ``(J, 3, 3)``.
        fps: frames per second.
    """

    skin: Skin
    places: FloatArray
    turns: FloatArray
    rest_places: FloatArray
    rest_turns: FloatArray
    fps: float

    def vertices(self, frame: int) -> FloatArray:
        """``(V, 3)`` metres, in a frame."""
        return self.skin.at(self.places[frame], self.turns[frame])

    @cached_property
    def rest_vertices(self) -> FloatArray:
        """``(V, 3)`` metres, in the pose that the mesh was bound in."""
        return self.skin.at(self.rest_places, self.rest_turns)


def load_character(path: str | Path) -> Character:
    """Read a character with its mesh.

    Args:
        path: a ``.glb``, ``.gltf`` or ``.vrm`` with a mesh on a humanoid skeleton.

    Raises:
        MotionFileNotFoundError: there is no such file.
        FormatError: it cannot be read, or has no mesh on its skeleton; the message says why.
        InvalidInputError: a file of another kind.
    """
    file = as_path(path)
    if file.suffix.lower() not in GLTF_SUFFIXES:
        raise InvalidInputError(
            f"{file}: a character to look at is one of {', '.join(GLTF_SUFFIXES)}; Blender exports one: "
            "File > Export > glTF 2.0"
        )
    rig = load_target(file)
    document = open_glb(file)
    whole = file.read_bytes() if file.suffix.lower() in _WHOLE else b""
    return Character(file.stem, rig, read_skin(document), file, whole)
