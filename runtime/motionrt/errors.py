"""The typed errors of motionrt: one small tree, each class also the standard exception a caller would expect."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

LONGEST_MESSAGE = 2000
"""Characters of a message; what is longer, because a file put it there, is cut in its middle."""


class MotionRTError(Exception):
    """Base of everything that motionrt raises on purpose; ``except MotionRTError`` catches it all."""

    def __str__(self) -> str:
        text = super().__str__()
        if len(text) <= LONGEST_MESSAGE:
            return text
        half = LONGEST_MESSAGE // 2 - 10
        return f"{text[:half]} [...] {text[-half:]}"


class InvalidInputError(MotionRTError, ValueError):
    """An argument has the wrong value, shape or type; the message says what is expected."""


class FormatError(MotionRTError, ValueError):
    """A motion file cannot be read.

    Attributes:
        path: the file.
        line: 1-based line number, or ``None`` where lines mean nothing (binary files).
        reason: what is wrong, in words.
    """

    def __init__(self, path: str | Path, reason: str, line: int | None = None) -> None:
        self.path = Path(path)
        self.line = line
        self.reason = reason
        place = f"{path}:{line}" if line is not None else str(path)
        super().__init__(f"{place}: {reason}")


class MotionFileNotFoundError(MotionRTError, FileNotFoundError):
    """A motion file, or a file it depends on (an ``.asf`` skeleton), does not exist."""


class MotionFileWarning(UserWarning):
    """A motion file was read, but not all of it could be taken at its word; the message says what was done."""


class RigError(MotionRTError, ValueError):
    """A rig cannot be mapped to the ``smpl24`` skeleton; the message names the missing joints and the remedy."""


class ManifestError(MotionRTError, ValueError):
    """``models_manifest.yaml`` is malformed, of an unknown version, or has an unknown key."""


class ModelNotFoundError(MotionRTError, LookupError):
    """The manifest has no model or variant of that name; the message lists those it has."""


class ModelFileError(MotionRTError, FileNotFoundError):
    """A file that the manifest names is missing; the message says where it was looked for."""


class ChecksumError(MotionRTError, ValueError):
    """A file's sha256 is not the one expected; the message gives file, expected and found."""


class LabellingError(MotionRTError, RuntimeError):
    """A language model or labeller fails, or its answer names no body part; the message quotes what it said."""


class GalleryError(MotionRTError, ValueError):
    """A gallery cannot be used as it is: damaged, of another version, or made by another model."""


class GalleryNotFoundError(MotionRTError, FileNotFoundError):
    """There is no gallery in that folder; the message gives the command that builds one."""


class EngineError(MotionRTError, RuntimeError):
    """A database of motion cannot be reached, or refuses; the message says what it said."""


class SceneError(MotionRTError, ValueError):
    """A scene cannot be built: an unreadable mesh or map, nothing walkable in it; the message says which and why."""


class PathError(MotionRTError, ValueError):
    """There is no way through a scene; the message says what blocks it."""


class ReachError(MotionRTError, ValueError):
    """No human pose meets the keypoints.

    Attributes:
        miss_cm: by how many centimetres each keypoint is missed, by joint name.
    """

    def __init__(self, message: str, miss_cm: Mapping[str, float]) -> None:
        self.miss_cm = dict(miss_cm)
        super().__init__(message)


class ScriptError(MotionRTError, ValueError):
    """A script of actions is malformed; the message names the file, the step and the remedy."""


class WalkError(MotionRTError, RuntimeError):
    """A character did not get to its goal in any reasonable time; the message says where it stayed, and what to try."""


class MissingDependencyError(MotionRTError, ImportError):
    """An optional package or program is not installed; the message gives the command that installs it."""
