"""Pillow and ffmpeg, looked for when a picture is made."""

from __future__ import annotations

import shutil
from importlib import import_module
from typing import Any

from motionrt.errors import MissingDependencyError


def pillow(module: str) -> Any:
    """The module ``PIL.<module>``.

    Raises:
        MissingDependencyError: Pillow is not installed; the message says how to install it.
    """
    try:
        return import_module(f"PIL.{module}")
    except ImportError as error:
        raise MissingDependencyError('pictures need the package Pillow: pip install "motionrt[render]"') from error


def ffmpeg() -> str:
    """Where the program ffmpeg is.

    Raises:
        MissingDependencyError: nowhere on the PATH; the message says what to do.
    """
    found = shutil.which("ffmpeg")
    if found is None:
        raise MissingDependencyError(
            "an .mp4 needs the program ffmpeg on the PATH (apt install ffmpeg, brew install ffmpeg, "
            "winget install ffmpeg); a .gif needs nothing"
        )
    return found
