"""Packages of the extra ``scene``, imported when they are needed."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

from motionrt.errors import MotionFileNotFoundError, SceneError
from motionrt.untrusted.files import check_file


def scene_package(name: str, purpose: str) -> Any:
    """The module ``name``, or a SceneError that says how to install it."""
    try:
        return import_module(name)
    except ImportError as error:
        package = {"PIL": "Pillow"}.get(name.split(".", maxsplit=1)[0], name)
        message = f'{purpose} needs the package {package}: pip install "motionrt[scene]"'
        raise SceneError(message) from error


def require_scene_file(path: Path) -> None:
    """Raise unless ``path`` is a plain file of a size that can be read."""
    try:
        check_file(path, lambda reason, _: SceneError(f"{path} {reason}"))
    except FileNotFoundError as error:
        raise MotionFileNotFoundError(f"no such scene file: {path}") from error
