"""Mapping files: which joint of a rig is which joint of ``smpl24``, to be saved, reused and shared."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import yaml

from motionrt.errors import InvalidInputError
from motionrt.motion.skeleton import SMPL24
from motionrt.rigs.clip import RigClip
from motionrt.rigs.stance import read_stance
from motionrt.untrusted import yaml_text
from motionrt.untrusted.files import as_path, read_utf8
from motionrt.untrusted.outputs import checked_output


def load_mapping(path: str | Path) -> dict[str, str]:
    """The mapping in a YAML or JSON file: ``smpl24`` joint name -> joint name of the rig; of ``rig map``, too.

    Raises:
        InvalidInputError: the file cannot be read, or does not map names to names.
    """
    path = as_path(path)

    def fail(reason: str, line: int | None) -> InvalidInputError:
        return InvalidInputError(f"cannot read the mapping {path}{f':{line}' if line else ''}: {reason}")

    try:
        text = read_utf8(path, fail, "yaml_bytes")
    except FileNotFoundError as error:
        raise fail("there is no such file", None) from error
    mapping = yaml_text.parse(text, getattr(yaml, "CSafeLoader", yaml.SafeLoader), fail)  # JSON is YAML, too
    if isinstance(mapping, dict) and isinstance(mapping.get("mapping"), dict):  # of `motionrt rig map --json`
        mapping = mapping["mapping"]
    if not isinstance(mapping, dict) or not all(isinstance(name, str) for pair in mapping.items() for name in pair):
        raise InvalidInputError(f'{path} must map joint names to joint names, such as {{"left_hip": "L_Thigh"}}')
    return mapping


def mapping_text(mapping: Mapping[str, str]) -> str:
    """A mapping as YAML, in the order of ``smpl24``."""
    lines = [f"{role}: {_quoted(mapping[role])}" for role in SMPL24.names if role in mapping]
    return "\n".join(["# smpl24 joint: joint of the rig", *lines, ""])


def save_mapping(mapping: Mapping[str, str], path: str | Path) -> Path:
    """Write a mapping as YAML; returns ``path``.

    Raises:
        InvalidInputError: the file cannot be written.
    """
    path = checked_output(path, ())
    try:
        path.write_text(mapping_text(mapping), encoding="utf-8")
    except OSError as error:
        raise InvalidInputError(f"cannot write {path}: {error.strerror or error}") from error
    return path


def _quoted(name: str) -> str:
    return '"' + name.replace("\\", "\\\\").replace('"', '\\"') + '"'


def draft_mapping(clip: RigClip, mapping: Mapping[str, str] | None = None) -> dict[str, str]:
    """What motionrt takes the joints of a rig for, ``smpl24`` joint name -> joint name; what is given stays.

    Raises:
        RigError: the rig is no person, or joints are missing; the message names them.
    """
    given = {**clip.known, **(mapping or {})} or None
    roles = read_stance(clip, given, [clip.rest_rotations(), clip.rotations[0]]).roles
    return {role: clip.names[joint] for role, joint in roles.joints.items()}
