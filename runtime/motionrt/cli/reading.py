"""Options of every command that reads motion files, and what they mean to the readers."""

from __future__ import annotations

import argparse
import re
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionrt.cli.console import say, working
from motionrt.cli.options import add_mapping, read_mapping

if TYPE_CHECKING:
    from motionrt.motion import Motion

INPUTS = ".bvh, .amc, .fbx, .glb, .gltf, .vrm, .vrma, .npz, .npy"

_OPTIONS = {
    "fps": "--source-fps",
    "mapping": "--mapping",
    "rig_mapping": "--rig-mapping",
    "animation": "--animation",
    "skin": "--skin",
    "asf": "--asf",
    "up": "--up",
    "units": "--units",
    "t_pose": "--t-pose",
    "joint": "--joint",
}
"""Arguments of the readers -> the options of the command line that set them."""

_ARGUMENT = re.compile(rf"\b({'|'.join(_OPTIONS)})=(?:True|\{{('[^']*'): ('[^']*'), \.\.\.\}})?")
_VALUE = re.compile(r"(\w+)(?= must )")


def add_reading(parser: argparse.ArgumentParser) -> None:
    """Options that say what a motion file does not say, or says wrongly."""
    group = parser.add_argument_group("reading")
    add_mapping(group)
    group.add_argument("--source-fps", type=float, metavar="N", help="frame rate of the file, instead of what it says")
    group.add_argument("--up", choices=("y", "z"), help="vertical axis of the file, instead of what the body says")
    group.add_argument("--animation", metavar="NAME", help="of a file that holds several (.glb, .gltf, .vrm, .fbx)")
    group.add_argument("--asf", type=Path, metavar="FILE", help="skeleton of an .amc (default: looked for beside it)")


def reading(arguments: argparse.Namespace) -> dict[str, Any]:
    """What :func:`motionrt.load_motion` is to be called with beside the path."""
    return {
        "mapping": read_mapping(arguments.mapping),
        "fps": arguments.source_fps,
        "up": arguments.up,
        "animation": arguments.animation,
        "asf": arguments.asf,
    }


def spare_inputs(output: Path, *inputs: Path) -> None:
    """InvalidInputError where a command would write over a file that it reads."""
    from motionrt.errors import InvalidInputError

    for path in inputs:
        if output.exists() and path.exists() and output.samefile(path):
            raise InvalidInputError(f"{output} is a file that is read; write to another one")


def read_motion(arguments: argparse.Namespace, path: str | Path) -> Motion:
    """The motion in a file, as the options say."""
    from motionrt.formats import load_motion

    with working(f"reading {Path(path).name}"):
        return load_motion(path, **reading(arguments))


def in_options(message: str, options: Mapping[str, str] | None = None) -> str:
    """An error message that names options of the command line where it named arguments of Python.

    Args:
        message: of a typed error.
        options: of the command, by argument: ``seconds must be ...`` becomes ``--seconds must be ...``.
    """
    value = _VALUE.match(message)
    if value and options:
        names = {**{name: option for name, option in _OPTIONS.items() if option in options.values()}, **options}
        message = names.get(value[1], value[1]) + message[value.end() :]
    return _ARGUMENT.sub(_option, message)


def _option(match: re.Match[str]) -> str:
    option = _OPTIONS[match.group(1)]
    return option if match.group(2) is None else f"{option} FILE, a file that says {match.group(2)}: {match.group(3)}"


@contextmanager
def shown_warnings() -> Iterator[None]:
    """Warnings about motion files as one line each on stderr."""
    from motionrt.errors import MotionFileWarning

    with warnings.catch_warnings():
        usual = warnings.showwarning

        def show(message: Warning | str, category: type[Warning], *rest: Any, **more: Any) -> None:
            if issubclass(category, MotionFileWarning):
                say(f"motionrt: warning: {in_options(str(message))}")
            else:
                usual(message, category, *rest, **more)

        warnings.simplefilter("always", MotionFileWarning)
        warnings.showwarning = show
        yield
