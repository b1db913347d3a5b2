"""The pairs of a study: motions of two folders that have the same names."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from motionrt.errors import InvalidInputError, MotionFileNotFoundError
from motionrt.formats import load_motion
from motionrt.motion import Motion
from motionrt.untrusted.files import as_path

SUFFIXES = (".bvh", ".npz", ".glb", ".gltf", ".fbx", ".amc")
LONGEST_S = 30.0  # seconds of a clip that are shown: nobody compares longer ones


@dataclass(frozen=True, eq=False)
class Pair:
    """Two motions that are shown beside each other.

    Attributes:
        name: what they have in common, as in the name of their files.
        a, b: the motions, at one frame rate.
    """

    name: str
    a: Motion
    b: Motion


def find_pairs(a: str | Path, b: str | Path) -> tuple[Pair, ...]:
    """Read what two folders have in common: files of the same name, whatever their suffix; or two files.

    Args:
        a: a folder of motion files, or one file.
        b: another.

    Returns:
        Pairs in order of their names; each is brought to the higher frame rate of the two and cut to 30 s.

    Raises:
        MotionFileNotFoundError: a folder or file is missing.
        InvalidInputError: one is a folder and the other a file, or they have no name in common.
        FormatError: a file cannot be read.
    """
    first, second = as_path(a), as_path(b)
    for path in (first, second):
        if not path.exists():
            raise MotionFileNotFoundError(f"there is no {path}")
    if first.is_dir() != second.is_dir():
        raise InvalidInputError(f"give two folders or two files, not {first} with {second}")
    if not first.is_dir():
        return (_pair(first.stem, first, second),)
    left, right = dict(_files(first)), dict(_files(second))
    both = sorted(set(left) & set(right))
    if not both:
        raise InvalidInputError(
            f"{first} and {second} have no motion of one name; name files alike, as in {first / 'walk.bvh'} "
            f"and {second / 'walk.bvh'}"
        )
    return tuple(_pair(name, left[name], right[name]) for name in both)


def _files(folder: Path) -> Iterator[tuple[str, Path]]:
    for path in sorted(folder.iterdir()):
        if path.suffix.lower() in SUFFIXES:
            yield path.stem, path


def _pair(name: str, a: Path, b: Path) -> Pair:
    motions = [load_motion(path) for path in (a, b)]
    fps = max(motion.fps for motion in motions)
    shown = [motion if motion.fps == fps else motion.resample(fps) for motion in motions]
    return Pair(name, *(motion[: max(1, round(LONGEST_S * fps))] for motion in shown))
