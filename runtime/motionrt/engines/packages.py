"""The packages that engines, object stores and clusters are spoken to with, imported where they are used."""

from __future__ import annotations

import importlib
from typing import Any

from motionrt.errors import MissingDependencyError


def package(name: str, what: str, extra: str) -> Any:
    """The module of that name.

    Raises:
        MissingDependencyError: it is not installed; the message says what needs it, and which extra brings it.
    """
    try:
        return importlib.import_module(name)
    except ImportError as error:
        top = name.partition(".")[0]
        raise MissingDependencyError(f'{what} needs the package {top}: pip install "motionrt[{extra}]"') from error
