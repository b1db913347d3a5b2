"""Options that several commands share."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from motionrt.runtime import Runtime

MOTION_KINDS = (".bvh", ".glb", ".gltf", ".vrma", ".npz", ".fbx")
MOTION_FILE = "file to write (.bvh, .glb, .gltf, .vrma, .npz; .fbx where Blender is installed)"


def command(commands: Any, name: str, run: Callable[[argparse.Namespace], int], text: str) -> argparse.ArgumentParser:
    """A new command; ``text`` is its help, whose first line stands in the list of commands."""
    parser: argparse.ArgumentParser = commands.add_parser(
        name,
        help=text.splitlines()[0],
        description=text,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.set_defaults(run=run)
    loudness = parser.add_mutually_exclusive_group()
    loudness.add_argument("-q", "--quiet", action="store_true", help="no notes, warnings or progress; errors stay")
    loudness.add_argument("-v", "--verbose", action="store_true", help="say how long it took, and where errors are")
    return parser


def add_json(parser: argparse.ArgumentParser) -> None:
    """``--json``."""
    parser.add_argument("--json", action="store_true", help="print JSON for programs instead of a table")


def add_models(parser: argparse.ArgumentParser, *, threads: bool = True) -> None:
    """``--models`` and, where the user may choose, ``--threads``."""
    parser.add_argument("--models", type=Path, metavar="PATH", help="models manifest or folder (default: shipped)")
    parser.set_defaults(threads=None, text_tower=None)
    if threads:
        parser.add_argument("--threads", type=int, metavar="N", help="threads of the models (default: at most 2)")


def add_text_tower(parser: argparse.ArgumentParser) -> None:
    """``--text-tower``."""
    parser.add_argument(
        "--text-tower",
        choices=("small", "full"),
        help="what embeds the text: small is fast, full is what it was distilled from (default: small if there is one)",
    )


def add_output(parser: argparse.ArgumentParser, text: str = MOTION_FILE, kinds: Sequence[str] = MOTION_KINDS) -> None:
    """``-o``, where there is a file of one of ``kinds`` to write; it is looked at before the command runs."""
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="OUT", help=text)
    parser.set_defaults(writes=tuple(kinds))


def check_output(arguments: argparse.Namespace) -> None:
    """InvalidInputError where the file of ``-o`` cannot be written: before minutes of work for it."""
    if (kinds := getattr(arguments, "writes", None)) is not None:
        from motionrt.untrusted.outputs import checked_output

        checked_output(arguments.output, kinds)


def add_mapping(parser: argparse._ActionsContainer) -> None:
    """``--mapping``."""
    parser.add_argument(
        "--mapping",
        type=Path,
        metavar="FILE",
        help="YAML or JSON, smpl24 joint name to joint name in the file; 'motionrt rig map' drafts it",
    )


def runtime(arguments: argparse.Namespace) -> Runtime:
    """The runtime that the arguments ask for."""
    from motionrt.runtime import Runtime

    return Runtime(arguments.models, threads=arguments.threads, text_tower=arguments.text_tower)


def read_mapping(path: Path | None) -> dict[str, str] | None:
    """The joint mapping in a YAML or JSON file; InvalidInputError when it does not map names to names."""
    from motionrt.rigs.mapping import load_mapping

    return None if path is None else load_mapping(path)
