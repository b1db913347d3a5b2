"""Strict reading of a mapping from a YAML file: every key is asked for, no key may be left over."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Any, TypeVar

from motionrt.errors import ManifestError
from motionrt.untrusted.words import shorten, shown

T = TypeVar("T")
_HUGE = 1e300
Scalar = str | int | float | bool

NAME = re.compile(r"[a-z][a-z0-9_]*")
SHA256 = re.compile(r"[0-9a-f]{64}")
FILE = re.compile(r"(?!\.{1,2}(?:/|$))[^/\\:\x00-\x1f]+(?:/(?!\.{1,2}(?:/|$))[^/\\:\x00-\x1f]+)*")
"""A relative path with forward slashes that stays beneath its folder."""


class Fields:
    """One mapping of the manifest; `place` says where it stands, for messages."""

    def __init__(self, content: object, place: str) -> None:
        self._left = _mapping(content, place)
        self.place = place

    def text(self, key: str) -> str:
        """A string with something in it."""
        value = self._take(key, str)
        if not value.strip():
            raise ManifestError(f"{self.place}.{key}: expected a text, found {shown(value)}")
        return value

    def integer(self, key: str, least: int = 1) -> int:
        """A whole number from ``least`` (a boolean is none, 3.0 is one)."""
        return whole(self._take(key, object), f"{self.place}.{key}", least)

    def file(self, key: str) -> str:
        """A relative path with forward slashes, which does not leave the folder."""
        value = self._take(key, str)
        if not FILE.fullmatch(value):
            raise ManifestError(
                f"{self.place}.{key}: expected a relative path with forward slashes that stays beneath the manifest's "
                f"folder, found {shown(value)}"
            )
        return value

    def flag(self, key: str) -> bool:
        """True or false."""
        return self._take(key, bool)

    def sha256(self, key: str) -> str:
        """64 lower-case hexadecimal digits."""
        value = self._take(key, str)
        if not SHA256.fullmatch(value):
            raise ManifestError(f"{self.place}.{key}: expected 64 lower-case hexadecimal digits, found {shown(value)}")
        return value

    def items(self, key: str, read: Callable[[Any, str], T]) -> tuple[T, ...]:
        """A list, every element read by `read(content, place)`."""
        return listed(read)(self._take(key, list), f"{self.place}.{key}")

    def table(self, key: str, read: Callable[[Any, str], T]) -> dict[str, T]:
        """A mapping, every value read by `read(content, place)`."""
        return table(read)(self._take(key, dict), f"{self.place}.{key}")

    def named(self, key: str, read: Callable[[Any, str], T]) -> dict[str, T]:
        """The same with at least one entry, whose keys are names: lower-case letters, digits and underscores."""
        place, content = f"{self.place}.{key}", self._take(key, dict)
        for name in content:
            if not isinstance(name, str) or not NAME.fullmatch(name):
                rule = "a name has lower-case letters, digits and underscores"
                raise ManifestError(f"{place}: {rule}, found {shown(name)}")
        if not content:
            raise ManifestError(f"{place}: expected at least one entry")
        return table(read)(content, place)

    def optional(self, key: str, read: Callable[[Any, str], T]) -> T | None:
        """`read(content, place)`, or None where the key is missing or null."""
        content = self._left.pop(key, None)
        return None if content is None else read(content, f"{self.place}.{key}")

    def done(self) -> None:
        """Raise ManifestError when a key was not asked for."""
        if self._left:
            names = shorten(", ".join(sorted(self._left)), 200)
            raise ManifestError(
                f"{self.place}: unknown key {names}; if the manifest is of a newer motionrt, "
                "update (pip install --upgrade motionrt), otherwise remove the key"
            )

    def _take(self, key: str, kind: type[T]) -> T:
        if key not in self._left:
            raise ManifestError(f"{self.place}: '{key}' is missing")
        value = self._left.pop(key)
        if not isinstance(value, kind):
            raise ManifestError(f"{self.place}.{key}: expected {kind.__name__}, found {shown(value)}")
        return value


def scalar(content: object, place: str) -> Scalar:
    """A string, a finite number or a boolean."""
    if not isinstance(content, str | int | float | bool) or (isinstance(content, float) and not math.isfinite(content)):
        raise ManifestError(f"{place}: expected a string, a finite number or true/false, found {shown(content)}")
    return content


def number(content: object, place: str) -> float:
    """A finite number."""
    if isinstance(content, bool) or not isinstance(content, int | float) or not abs(content) < _HUGE:
        raise ManifestError(f"{place}: expected a number, and a finite one, found {shown(content)}")
    return float(content)


def whole(content: object, place: str, least: int = 1) -> int:
    """A whole number from ``least``."""
    integral = isinstance(content, int) or (isinstance(content, float) and content.is_integer())
    if isinstance(content, bool) or not integral or not least <= int(content) < 2**63:  # type: ignore[call-overload]
        raise ManifestError(f"{place}: expected a whole number from {least}, found {shown(content)}")
    return int(content)  # type: ignore[call-overload,no-any-return]


def listed(read: Callable[[Any, str], T]) -> Callable[[Any, str], tuple[T, ...]]:
    """Reader of a list whose elements are read by `read`."""

    def read_list(content: object, place: str) -> tuple[T, ...]:
        if not isinstance(content, list):
            raise ManifestError(f"{place}: expected a list, found {shown(content)}")
        return tuple(read(value, f"{place}[{i}]") for i, value in enumerate(content))

    return read_list


def table(read: Callable[[Any, str], T]) -> Callable[[Any, str], dict[str, T]]:
    """Reader of a mapping whose values are read by `read`."""

    def read_table(content: object, place: str) -> dict[str, T]:
        return {name: read(value, f"{place}.{name}") for name, value in _mapping(content, place).items()}

    return read_table


def _mapping(content: object, place: str) -> dict[str, Any]:
    if not isinstance(content, dict) or not all(isinstance(key, str) for key in content):
        raise ManifestError(f"{place}: expected a mapping with names as keys")
    return dict(content)
