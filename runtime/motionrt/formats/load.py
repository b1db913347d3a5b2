"""One door for all formats: the suffix of the file decides."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

from motionrt.errors import FormatError, InvalidInputError, MotionRTError
from motionrt.formats.amass import read_npz, write_npz
from motionrt.formats.amc import read_amc
from motionrt.formats.bvh import read_bvh
from motionrt.formats.bvh_write import write_bvh
from motionrt.formats.leading_pose import drop_leading_tpose
from motionrt.formats.text import require_file
from motionrt.motion.motion import Motion
from motionrt.motion.retarget import to_smpl24
from motionrt.motion.rig import RigClip

MOTION_SUFFIXES = (".bvh", ".amc", ".npz")
"""What :func:`load_motion` reads, in any mixture of upper and lower case."""

WRITABLE_SUFFIXES = (".bvh", ".npz")
"""What :func:`save_motion` writes."""


def load_rig(path: str | Path, *, asf: str | Path | None = None, fps: float | None = None) -> RigClip:
    """Read a motion file as it is: its own joints, units and axes, every frame.

    Args:
        path: a ``.bvh``, ``.amc`` or ``.npz`` (AMASS) file.
        asf: the skeleton of an ``.amc``; looked for beside it if ``None``.
        fps: frames per second to use instead of what the file says.

    Raises:
        MotionFileNotFoundError: the file, or the skeleton that it needs, does not exist.
        FormatError: the file cannot be read; names file, line (where there are lines) and reason.
        InvalidInputError: the suffix is unknown, or ``fps`` is not positive.
    """
    path = Path(path)
    require_file(path)
    if fps is not None and not (math.isfinite(fps) and fps > 0):
        raise InvalidInputError(f"fps must be a positive number, not {fps}")
    suffix = _suffix(path, MOTION_SUFFIXES, "read")
    try:
        if suffix == ".bvh":
            return read_bvh(path, fps=fps)
        return read_amc(path, asf, fps=fps) if suffix == ".amc" else read_npz(path, fps=fps)
    except MotionRTError:
        raise
    except Exception as error:  # whatever the bytes are, nothing else may come out of a reader
        raise FormatError(path, f"cannot be read ({type(error).__name__}: {error})") from error


def load_motion(
    path: str | Path,
    *,
    mapping: Mapping[str, str] | None = None,
    asf: str | Path | None = None,
    keep_first_frame: bool = False,
    fps: float | None = None,
) -> Motion:
    """Read a motion file onto the ``smpl24`` skeleton: metres, Y up, the file's frame rate.

    Args:
        path: a ``.bvh``, ``.amc`` or ``.npz`` (AMASS) file.
        mapping: ``smpl24`` joint name -> joint name in the file, for rigs that are not recognised.
        asf: the skeleton of an ``.amc``; looked for beside it if ``None``.
        keep_first_frame: keep a leading calibration pose; otherwise it is dropped. It orients the rig anyway.
        fps: frames per second to use instead of what the file says.

    Raises:
        MotionFileNotFoundError, FormatError, InvalidInputError: as :func:`load_rig`.
        RigError: the rig cannot be mapped to ``smpl24``; the message names what is missing.
    """
    clip = load_rig(path, asf=asf, fps=fps)
    motion_part, reference = drop_leading_tpose(clip)
    return to_smpl24(clip if keep_first_frame else motion_part, mapping=mapping, reference=reference)


def save_motion(motion: Motion, path: str | Path) -> Path:
    """Write a motion as ``.bvh`` (centimetres) or ``.npz`` (AMASS), whole or not at all; returns the path.

    Raises:
        InvalidInputError: another suffix, or the file cannot be written.
    """
    path = Path(path)
    suffix = _suffix(path, WRITABLE_SUFFIXES, "written")
    return write_bvh(motion, path) if suffix == ".bvh" else write_npz(motion, path)


def _suffix(path: Path, known: tuple[str, ...], verb: str) -> str:
    suffix = path.suffix.lower()
    if suffix in known:
        return suffix
    hint = " (an .asf is only a skeleton: load the .amc that it belongs to)" if suffix == ".asf" else ""
    raise InvalidInputError(f"{path}: a file '{suffix}' cannot be {verb}; can be: {', '.join(known)}{hint}")
