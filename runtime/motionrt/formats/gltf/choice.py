"""Picking one of several things in a GLB file, by name or index."""

from __future__ import annotations

from pathlib import Path

from motionrt.errors import FormatError
from motionrt.formats.gltf.container import Json


def names_of(entries: list[Json]) -> list[str]:
    """Names of skins or animations; those without a name are called by their index."""
    return [str(entry.get("name") or i) for i, entry in enumerate(entries)]


def chosen(what: str, wanted: int | str, names: list[str], path: Path) -> int:
    """Index of the one of ``names`` that is called ``wanted``, or stands at that index.

    Raises:
        FormatError: none or several are; lists what there is.
    """
    found = [i for i, name in enumerate(names) if wanted in {name, i}]
    if len(found) != 1:
        raise FormatError(path, f"has no one {what} '{wanted}'; it has: {', '.join(names) or 'none'}")
    return found[0]
