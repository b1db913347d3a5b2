"""Options that several commands share."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from motionrt.runtime import Runtime


def command(commands: Any, name: str, run: Callable[[argparse.Namespace], int], text: str) -> argparse.ArgumentParser:
    """A new command; ``text`` is its help, whose first line stands in the list of commands."""
    parser: argparse.ArgumentParser = commands.add_parser(
        name,
        help=text.splitlines()[0],
        description=text,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.set_defaults(run=run)
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


def add_mapping(parser: argparse.ArgumentParser) -> None:
    """``--mapping``."""
    parser.add_argument(
        "--mapping",
        type=Path,
        metavar="FILE",
        help="JSON object for a rig that is not recognised: smpl24 joint name to joint name in the file",
    )


def runtime(arguments: argparse.Namespace) -> Runtime:
    """The runtime that the arguments ask for."""
    from motionrt.runtime import Runtime

    return Runtime(arguments.models, threads=arguments.threads, text_tower=arguments.text_tower)


def read_mapping(path: Path | None) -> dict[str, str] | None:
    """The joint mapping in a JSON file; InvalidInputError when it is not an object of strings."""
    from motionrt.errors import InvalidInputError

    if path is None:
        return None
    try:
        mapping = json.loads(path.read_text(encoding="utf-8-sig"))
    except (OSError, ValueError) as error:
        raise InvalidInputError(f"cannot read the mapping {path}: {error}") from error
    if not isinstance(mapping, dict) or not all(isinstance(name, str) for name in mapping.values()):
        raise InvalidInputError(f'{path} must hold a JSON object such as {{"left_hip": "L_Thigh"}}')
    return mapping
