"""Pieces of files and values of callers, fit to be quoted in a message."""

from __future__ import annotations


def shorten(text: str, limit: int = 60) -> str:
    """A piece of a text without control characters and halves of characters, at most ``limit`` characters long."""
    clean = "".join(c if c.isprintable() else "?" for c in text[: limit + 1])
    return clean if len(clean) <= limit else clean[: limit - 3] + "..."


def shown(value: object, limit: int = 60) -> str:
    """A value as Python writes it, shortened; one that cannot be written is named by its type."""
    if isinstance(value, list | tuple | dict | set) and len(value) > 20:
        return f"a {type(value).__name__} of {len(value)}"
    try:
        return shorten(repr(value), limit)
    except Exception:  # noqa: BLE001  # somebody else's __repr__; or a number of thousands of digits
        return f"a {type(value).__name__}"
