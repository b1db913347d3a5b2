"""Picking one of several things in a file of scenes, by name or index."""

from __future__ import annotations

from pathlib import Path

from motionrt.errors import FormatError
from motionrt.formats.gltf.container import Json


def names_of(entries: list[Json]) -> list[str]:
    """Names of skins or animations; those without a name are called by their index."""
    return [str(entry.get("name") or i) for i, entry in enumerate(entries)]


def called(names: list[str], index: int) -> str:
    """What :func:`chosen` finds the one at ``index`` by: its name, or its index where names repeat."""
    return names[index] if names.count(names[index]) == 1 else str(index)


def chosen(what: str, wanted: int | str, names: list[str], path: Path) -> int:
    """Index of the one of ``names`` that is called ``wanted``, or else stands at that index.

    Raises:
        FormatError: none is, or several are; lists what there is.
    """
    found = [i for i, name in enumerate(names) if name == wanted]
    if not found and str(wanted).isdecimal() and int(wanted) < len(names):
        found = [int(wanted)]
    if len(found) != 1:
        known = ", ".join(called(names, i) for i in range(len(names))) or "none"
        raise FormatError(path, f"has {'more than one' if found else 'no'} {what} '{wanted}'; it has: {known}")
    return found[0]
