"""Acclaim ASF: the skeleton that an AMC file moves."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from motionrt.errors import FormatError
from motionrt.formats.acclaim.asf_lines import AsfLine, Vector, blocks, sections
from motionrt.formats.text import read_text, shorten, to_float
from motionrt.untrusted.files import as_path

_INCH = 0.0254
_ROOT_CHANNELS = ("tx", "ty", "tz", "rx", "ry", "rz")


@dataclass
class Bone:
    """One bone: starts at its parent's end and points along ``direction`` in the rest pose.

    ``axis`` holds the angles (radians, about X, Y, Z) of its own frame and ``axis_order`` the order in which
    they are applied about fixed axes; ``dof`` lists the AMC channels in file order: ``("rx", "ry", "rz")``.
    """

    name: str
    line: int
    direction: Vector = field(default_factory=lambda: np.zeros(3))
    length: float = 0.0
    axis: Vector = field(default_factory=lambda: np.zeros(3))
    axis_order: str = "XYZ"
    dof: tuple[str, ...] = ()
    parent: str = ""


@dataclass
class AsfSkeleton:
    """A whole ASF file: ``bones`` by name, root first, parents before children.

    ``root_position`` is in file units; ``length_unit`` is the file's ``length`` (0.45 at CMU).
    """

    path: Path
    bones: dict[str, Bone]
    root_position: Vector
    length_unit: float
    angles_in_degrees: bool

    @property
    def metres_per_unit(self) -> float | None:
        """Metres per file unit: scaled inches (CMU: 2.54 cm / 0.45); ``None`` where there is no scale."""
        return None if self.length_unit == 1 else _INCH / self.length_unit


def read_asf(path: str | Path) -> AsfSkeleton:
    """Read an ASF skeleton.

    Raises:
        MotionFileNotFoundError: there is no such file.
        FormatError: it is not a whole ASF file; names the line.
    """
    path = as_path(path)
    parts = sections(read_text(path), path)
    for name in ("root", "bonedata", "hierarchy"):
        if name not in parts:
            raise FormatError(path, f"not a whole ASF file: there is no :{name} section")
    length, degrees = _units(parts.get("units", []), path)
    root, position = _root(parts["root"], path, degrees)
    bones = {"root": root, **_bones(parts["bonedata"], path, degrees)}
    _hierarchy(parts["hierarchy"], bones, path)
    return AsfSkeleton(path, _sorted(bones, path), position, length, degrees)


def _units(lines: list[AsfLine], path: Path) -> tuple[float, bool]:
    """Length unit, and whether angles are in degrees."""
    length, degrees = 1.0, True
    for line in lines:
        if line.key == "length":
            length = line.number_at(1, path)
            if length <= 0:
                raise FormatError(path, "the length unit must be positive", line.number)
        elif line.key == "angle":
            degrees = not line.word_at(1, path).lower().startswith("rad")
    return length, degrees


def _root(lines: list[AsfLine], path: Path, degrees: bool) -> tuple[Bone, Vector]:
    bone = Bone("root", lines[0].number if lines else 1, dof=_ROOT_CHANNELS)
    position = np.zeros(3)
    for line in lines:
        if line.key == "order":
            bone.dof = line.channels(path)
        elif line.key == "axis":
            bone.axis_order = line.axis_order(1, path)
        elif line.key == "position":
            position = line.vector(path)
        elif line.key == "orientation":
            bone.axis = _radians(line.vector(path), degrees)
    return bone, position


def _bones(lines: list[AsfLine], path: Path, degrees: bool) -> dict[str, Bone]:
    bones: dict[str, Bone] = {}
    for block in blocks(lines, path):
        names = [line.word_at(1, path) for line in block if line.key == "name"]
        if len(names) != 1 or names[0] in bones or names[0] == "root":
            raise FormatError(path, "every bone needs one name of its own", block[0].number)
        bones[names[0]] = _bone(names[0], block, path, degrees)
    return bones


def _bone(name: str, block: list[AsfLine], path: Path, degrees: bool) -> Bone:
    bone = Bone(name, block[0].number)
    for line in block:
        if line.key == "direction":
            bone.direction = line.vector(path)
        elif line.key == "length":
            bone.length = to_float(line.word_at(1, path), path, line.number)
        elif line.key == "axis":
            bone.axis = _radians(line.vector(path), degrees)
            bone.axis_order = line.axis_order(4, path) if len(line.words) > 4 else "XYZ"
        elif line.key == "dof":
            bone.dof = line.channels(path)
    return bone


def _hierarchy(lines: list[AsfLine], bones: dict[str, Bone], path: Path) -> None:
    for block in blocks(lines, path):
        for line in block[1:]:
            unknown = [name for name in line.words if name not in bones]
            if unknown:
                raise FormatError(path, f"unknown bone '{shorten(unknown[0])}' in the hierarchy", line.number)
            for child in line.words[1:]:
                if child == "root" or bones[child].parent:
                    raise FormatError(path, f"bone '{child}' has two parents", line.number)
                bones[child].parent = line.words[0]


def _sorted(bones: dict[str, Bone], path: Path) -> dict[str, Bone]:
    """Parents before children; a bone that hangs on nothing is an error."""
    out = {"root": bones["root"]}
    waiting = [bone for name, bone in bones.items() if name != "root"]
    while waiting:
        ready = [bone for bone in waiting if bone.parent in out]
        if not ready:
            raise FormatError(path, f"bone '{waiting[0].name}' is not connected to the root", waiting[0].line)
        out.update((bone.name, bone) for bone in ready)
        waiting = [bone for bone in waiting if bone.name not in out]
    return out


def _radians(values: Vector, degrees: bool) -> Vector:
    return np.deg2rad(values) if degrees else values
