"""Strict reading of a mapping from a YAML file: every key is asked for, no key may be left over."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from motionrt.errors import ManifestError

T = TypeVar("T")
Scalar = str | int | float | bool


class Fields:
    """One mapping of the manifest; `place` says where it stands, for messages."""

    def __init__(self, content: object, place: str) -> None:
        self._left = _mapping(content, place)
        self.place = place

    def text(self, key: str) -> str:
        """A string."""
        return self._take(key, str)

    def integer(self, key: str) -> int:
        """An integer (a boolean is none)."""
        return self._take(key, int)

    def flag(self, key: str) -> bool:
        """True or false."""
        return self._take(key, bool)

    def sha256(self, key: str) -> str:
        """64 lower-case hexadecimal digits."""
        value = self.text(key)
        if len(value) != 64 or not set(value) <= set("0123456789abcdef"):
            raise ManifestError(f"{self.place}.{key}: expected 64 lower-case hexadecimal digits, found {value!r}")
        return value

    def items(self, key: str, read: Callable[[Any, str], T]) -> tuple[T, ...]:
        """A list, every element read by `read(content, place)`."""
        place = f"{self.place}.{key}"
        return tuple(read(content, f"{place}[{i}]") for i, content in enumerate(self._take(key, list)))

    def named(self, key: str, read: Callable[[Any, str], T]) -> dict[str, T]:
        """A mapping, every value read by `read(content, place)`."""
        return table(read)(self._take(key, dict), f"{self.place}.{key}")

    def optional(self, key: str, read: Callable[[Any, str], T]) -> T | None:
        """`read(content, place)`, or None where the key is missing or null."""
        content = self._left.pop(key, None)
        return None if content is None else read(content, f"{self.place}.{key}")

    def done(self) -> None:
        """Raise ManifestError when a key was not asked for."""
        if self._left:
            names = ", ".join(sorted(self._left))
            raise ManifestError(
                f"{self.place}: unknown key {names}; if the manifest is of a newer motionrt, "
                "update (pip install --upgrade motionrt), otherwise remove the key"
            )

    def _take(self, key: str, kind: type[T]) -> T:
        if key not in self._left:
            raise ManifestError(f"{self.place}: '{key}' is missing")
        value = self._left.pop(key)
        if not isinstance(value, kind) or (kind is int and isinstance(value, bool)):
            raise ManifestError(f"{self.place}.{key}: expected {kind.__name__}, found {value!r}")
        return value


def scalar(content: object, place: str) -> Scalar:
    """A string, number or boolean."""
    if not isinstance(content, str | int | float | bool):
        raise ManifestError(f"{place}: expected a string, a number or true/false, found {content!r}")
    return content


def number(content: object, place: str) -> float:
    """A number."""
    if isinstance(content, bool) or not isinstance(content, int | float):
        raise ManifestError(f"{place}: expected a number, found {content!r}")
    return float(content)


def table(read: Callable[[Any, str], T]) -> Callable[[Any, str], dict[str, T]]:
    """Reader of a mapping whose values are read by `read`."""

    def read_table(content: object, place: str) -> dict[str, T]:
        return {name: read(value, f"{place}.{name}") for name, value in _mapping(content, place).items()}

    return read_table


def _mapping(content: object, place: str) -> dict[str, Any]:
    if not isinstance(content, dict) or not all(isinstance(key, str) for key in content):
        raise ManifestError(f"{place}: expected a mapping with names as keys")
    return dict(content)
