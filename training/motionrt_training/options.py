"""A dataclass of settings as a command line: every field is an option, every default is shown."""

from __future__ import annotations

import argparse
import dataclasses
import types
import typing
from pathlib import Path
from typing import Any, TypeVar

T = TypeVar("T")


def add_options(parser: argparse.ArgumentParser, settings: type) -> None:
    """One `--option` per field; booleans also get `--no-option`, optional values accept `none`."""
    hints = typing.get_type_hints(settings)
    for field in dataclasses.fields(settings):
        flag = "--" + field.name.replace("_", "-")
        required = field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING
        help_text = str(field.metadata.get("help", "")) + ("" if required else f" (default: {field.default})")
        if hints[field.name] is bool:
            parser.add_argument(flag, action=argparse.BooleanOptionalAction, default=field.default, help=help_text)
        else:
            parser.add_argument(
                flag,
                type=_reader(hints[field.name]),
                default=None if required else field.default,
                required=required,
                choices=field.metadata.get("choices"),
                help=help_text,
            )


def recipe_parser(description: str, *settings: type) -> argparse.ArgumentParser:
    """The command line of a recipe: its corpus, the folder of its run, and every field of its settings."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--corpus", type=Path, required=True, help="what was packed for it (.npz)")
    parser.add_argument("--out", type=Path, required=True, help="folder of the run; the same command goes on")
    parser.add_argument("--init", type=Path, help="trained weights to begin from: best.pt or .safetensors")
    for part in settings:
        add_options(parser, part)
    return parser


def from_namespace(settings: type[T], values: argparse.Namespace) -> T:
    """The dataclass filled from parsed options."""
    names = [field.name for field in dataclasses.fields(typing.cast("Any", settings))]
    return settings(**{name: getattr(values, name) for name in names})


def option(default: Any, help_text: str, choices: tuple[str, ...] | None = None) -> Any:
    """A dataclass field with a help text."""
    return dataclasses.field(default=default, metadata={"help": help_text, "choices": choices})


def _reader(hint: Any) -> Any:
    if typing.get_origin(hint) in (types.UnionType, typing.Union):
        (inner,) = (part for part in typing.get_args(hint) if part is not type(None))

        def read(text: str) -> Any:
            return None if text.lower() == "none" else _boolean(text) if inner is bool else inner(text)

        read.__name__ = f"{inner.__name__} or none"
        return read
    return hint


def _boolean(text: str) -> bool:
    if text.lower() not in ("true", "false"):
        raise argparse.ArgumentTypeError(f"{text!r} is neither true nor false")
    return text.lower() == "true"
