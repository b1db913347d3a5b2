"""Packages whose names are imported when they are first asked for: each use then waits for its own modules alone."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from typing import Any


def lazily(package: str, homes: Mapping[str, Sequence[str]]) -> Callable[[str], Any]:
    """The ``__getattr__`` of a package: ``homes`` tells which public names each module below it holds."""
    home_of = {name: home for home, names in homes.items() for name in names}

    def load(name: str) -> Any:
        if name not in home_of:
            raise AttributeError(f"module '{package}' has no attribute '{name}'")
        value = getattr(import_module(f"{package}.{home_of[name]}"), name)
        setattr(sys.modules[package], name, value)
        return value

    return load


def moved(package: str, new_homes: Mapping[str, str]) -> Callable[[str], Any]:
    """The ``__getattr__`` of a package that names have left: they still work, with a ``DeprecationWarning``."""

    def load(name: str) -> Any:
        if name not in new_homes:
            raise AttributeError(f"module '{package}' has no attribute '{name}'")
        home = new_homes[name]
        warnings.warn(f"{package}.{name} is now {home}.{name}", DeprecationWarning, stacklevel=2)
        return getattr(import_module(home), name)

    return load
