"""One door for all formats: the suffix of the file decides."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

from motionrt.errors import InvalidInputError, MotionFileWarning
from motionrt.formats.acclaim import read_amc
from motionrt.formats.bvh import read_bvh, write_bvh
from motionrt.formats.fbx import read_fbx, write_fbx
from motionrt.formats.gltf import read_glb, write_glb
from motionrt.formats.gltf.container import GLTF_SUFFIXES
from motionrt.formats.leading_pose import drop_leading_tpose
from motionrt.formats.numbers import read_npy
from motionrt.formats.smpl import read_npz, write_npz
from motionrt.formats.text import require_file
from motionrt.formats.units import units_per_metre
from motionrt.motion.checks import checked_fps
from motionrt.motion.motion import Motion
from motionrt.rigs.clip import RigClip
from motionrt.rigs.retarget_in import to_smpl24
from motionrt.untrusted.arguments import check_flags, check_kind, checked_choice, checked_mapping, checked_up
from motionrt.untrusted.files import as_path
from motionrt.untrusted.outputs import checked_output

MOTION_SUFFIXES = (".bvh", ".amc", ".npz", ".npy", ".fbx", *GLTF_SUFFIXES)
"""What :func:`load_motion` reads, in any mixture of upper and lower case."""

WRITABLE_SUFFIXES = (".bvh", ".glb", ".gltf", ".vrma", ".npz", ".fbx")
"""What :func:`save_motion` writes; ``.fbx`` where Blender is installed."""


def load_rig(
    path: str | Path,
    *,
    asf: str | Path | None = None,
    fps: float | None = None,
    animation: int | str | None = None,
    skin: int | str | None = None,
    up: str | None = None,
) -> RigClip:
    """Read a motion file as it is: its own joints, units and axes, every frame.

    Args:
        path: a ``.bvh``, ``.amc``, ``.fbx``, ``.glb``, ``.gltf``, ``.vrm``, ``.vrma``, ``.npz`` (SMPL) or ``.npy``
            (HumanML3D) file.
        asf: the skeleton of an ``.amc``; looked for beside it if ``None``.
        fps: frames per second to use instead of what the file says; of glTF and FBX, whose keys have times, the rate at
            which they are sampled.
        animation: name or index of the animation in a file that holds several.
        skin: name or index of the figure in a ``.glb`` that holds several.
        up: ``"y"`` or ``"z"``, the vertical axis of the file, where the file and the body do not tell it rightly.

    Warns:
        MotionFileWarning: the file was read, but not all of it could be taken at its word.

    Raises:
        MotionFileNotFoundError: the file, or the skeleton that it needs, does not exist.
        FormatError: the file cannot be read; names file, line (where there are lines) and reason.
        InvalidInputError: the suffix is unknown, or ``fps`` is not positive.
    """
    path = as_path(path)
    require_file(path)
    if fps is not None:
        fps = checked_fps(fps)
    checked_up(up)
    checked_choice(animation, "animation")
    checked_choice(skin, "skin")
    suffix = _readable_suffix(path)
    readers: dict[str, Callable[[], RigClip]] = {
        ".bvh": lambda: read_bvh(path, fps=fps),
        ".amc": lambda: read_amc(path, asf, fps=fps),
        ".npz": lambda: read_npz(path, fps=fps, up=up),
        ".npy": lambda: read_npy(path, fps=fps, up=up),
        ".fbx": lambda: read_fbx(path, fps=fps, animation=animation),
    }
    clip = readers.get(suffix, lambda: read_glb(path, fps=fps, animation=animation, skin=skin))()
    for note in clip.notes:
        warnings.warn(f"{path}: {note}", MotionFileWarning, stacklevel=3)
    return clip if up is None or suffix in {".npz", ".npy"} else replace(clip, up=up)


def load_motion(
    path: str | Path,
    *,
    mapping: Mapping[str, str] | None = None,
    asf: str | Path | None = None,
    keep_first_frame: bool = False,
    fps: float | None = None,
    animation: int | str | None = None,
    skin: int | str | None = None,
    up: str | None = None,
) -> Motion:
    """Read a motion file onto the ``smpl24`` skeleton: metres, Y up, the file's frame rate.

    Args:
        path: as for :func:`load_rig`.
        mapping: ``smpl24`` joint name -> joint name in the file, for rigs that are not recognised.
        asf: the skeleton of an ``.amc``; looked for beside it if ``None``.
        keep_first_frame: keep a leading calibration pose; otherwise it is dropped. It orients the rig anyway.
        fps: as for :func:`load_rig`.
        animation: as for :func:`load_rig`.
        skin: as for :func:`load_rig`.
        up: as for :func:`load_rig`.

    Raises:
        MotionFileNotFoundError, FormatError, InvalidInputError: as :func:`load_rig`.
        RigError: the rig cannot be mapped to ``smpl24``; the message names what is missing.
    """
    mapping = checked_mapping(mapping, "mapping")
    check_flags(keep_first_frame=keep_first_frame)
    clip = load_rig(path, asf=asf, fps=fps, animation=animation, skin=skin, up=up)
    motion_part, reference = drop_leading_tpose(clip)
    return to_smpl24(clip if keep_first_frame else motion_part, mapping=mapping, reference=reference)


def save_motion(motion: Motion, path: str | Path, *, units: str | None = None, t_pose: bool = False) -> Path:
    """Write a motion whole or not at all, as one of :data:`WRITABLE_SUFFIXES`; returns the path.

    Args:
        motion: what to write.
        path: the file; its suffix is the format.
        units: of a ``.bvh``: ``"cm"`` (unless said otherwise), ``"m"``, ``"mm"`` or ``"in"``; the others are metres.
        t_pose: begin a ``.bvh`` with a frame of the T-pose.

    Raises:
        InvalidInputError: another suffix, options that the format does not have, or the file cannot be written.
        MissingDependencyError: a ``.fbx``, and there is no Blender.
    """
    path = as_path(path)
    check_kind(motion, Motion, "motion", "a Motion")
    check_flags(t_pose=t_pose)
    check_kind(units, str | None, "units", "the name of a unit")
    suffix = checked_output(path, WRITABLE_SUFFIXES).suffix.lower()
    if suffix == ".bvh":
        return write_bvh(motion, path, scale=units_per_metre("cm" if units is None else units), t_pose=t_pose)
    if t_pose or units not in {None, "m"}:
        raise InvalidInputError(f"units= and t_pose= are for a .bvh; a '{suffix}' is in metres and knows its rest pose")
    return {".npz": write_npz, ".fbx": write_fbx}.get(suffix, write_glb)(motion, path)


def _readable_suffix(path: Path) -> str:
    suffix = path.suffix.lower()
    if suffix in MOTION_SUFFIXES:
        return suffix
    what = f"a file '{suffix}'" if suffix else "a file without a suffix"
    hint = " (an .asf is only a skeleton: load the .amc that it belongs to)" if suffix == ".asf" else ""
    raise InvalidInputError(f"{path}: {what} cannot be read; can be: {', '.join(MOTION_SUFFIXES)}{hint}")
