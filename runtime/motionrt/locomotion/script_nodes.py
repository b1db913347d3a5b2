"""YAML as nodes that know their line, and checks whose errors name file, line and place."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any, TypeVar

from motionrt.errors import MotionRTError, ScriptError
from motionrt.limits import how_to_raise, limits
from motionrt.untrusted import Fail, yaml_text
from motionrt.untrusted.files import read_utf8
from motionrt.untrusted.words import shorten

T = TypeVar("T")
_LARGEST = 1e15
"""No number of a script is larger."""


@dataclass(frozen=True, eq=False)
class Node:
    """A value of a script.

    Attributes:
        value: a mapping of nodes, a list of nodes, or a text, number, boolean or None.
        file: the script.
        line: 1-based.
        name: what it is called in messages, as in ``step 3: heading``.
    """

    value: Any
    file: Path
    line: int
    name: str

    def error(self, reason: str) -> ScriptError:
        """The error that says where and why."""
        place = f"{self.name}: " if self.name else ""
        return ScriptError(f"{self.file}:{self.line}: {place}{reason}")

    def named(self, name: str) -> Node:
        """The same under another name."""
        return Node(self.value, self.file, self.line, name)

    def fields(self, known: Sequence[str], required: Sequence[str] = ()) -> Mapping[str, Node]:
        """The nodes of a mapping, all of which must be known."""
        if not isinstance(self.value, dict):
            raise self.error(f"expected {_listed(known)}, found {_shown(self.value)}")
        for key, node in self.value.items():
            if key not in known:
                raise Node(None, self.file, node.line, self.name).error(f"unknown key {unknown(key, known)}")
        for key in required:
            if key not in self.value:
                raise self.error(f"'{key}' is missing")
        below = f"{self.name}: " if self.name else ""
        return {key: node.named(below + key) for key, node in self.value.items()}

    def items(self, what: str, example: str) -> list[Node]:
        """The nodes of a list."""
        if not isinstance(self.value, list):
            raise self.error(f"expected {what}, as in {example}; found {_shown(self.value)}")
        return list(self.value)

    def number(self, unit: str = "") -> float:
        """A number that a float holds."""
        if isinstance(self.value, bool) or not isinstance(self.value, int | float) or not abs(self.value) < _LARGEST:
            raise self.error(f"expected a number{unit and f' ({unit})'}, found {_shown(self.value)}")
        return float(self.value)

    def positive(self, unit: str) -> float:
        """A number above 0."""
        if self.number(unit) <= 0:
            raise self.error(f"expected a number above 0 ({unit}), found {_shown(self.value)}")
        return float(self.value)

    def seconds(self) -> float:
        """A duration, 0 or more."""
        if self.number("seconds") < 0:
            raise self.error(f"expected 0 or more seconds, found {_shown(self.value)}")
        if self.value > limits().seconds:
            raise self.error(f"{_shown(self.value)} seconds are too many: {how_to_raise('seconds')}")
        return float(self.value)

    def whole(self) -> int:
        """A whole number from 0."""
        if isinstance(self.value, bool) or not isinstance(self.value, int) or not 0 <= self.value < _LARGEST:
            raise self.error(f"expected a whole number from 0, found {_shown(self.value)}")
        return int(self.value)

    def radians(self) -> float:
        """An angle, which scripts give in degrees."""
        return math.radians(self.number("degrees"))

    def flag(self) -> bool:
        """True or false."""
        if not isinstance(self.value, bool):
            raise self.error(f"expected true or false, found {_shown(self.value)}")
        return self.value

    def text(self, example: str) -> str:
        """A text that is not empty."""
        if not isinstance(self.value, str) or not self.value.strip():
            raise self.error(f"expected a text, as in {example}; found {_shown(self.value)}")
        return self.value.strip()

    def point(self, axes: str) -> tuple[float, ...]:
        """As many numbers as there are letters in ``axes``."""
        example = f"[{', '.join(axes)}] in metres"
        nodes = self.items(f"{len(axes)} numbers", example)
        if len(nodes) != len(axes):
            raise self.error(f"expected {len(axes)} numbers, as in {example}; found {len(nodes)}")
        return tuple(node.named(self.name).coordinate() for node in nodes)

    def coordinate(self) -> float:
        """Metres from the origin."""
        if abs(self.number("metres")) > limits().metres:
            raise self.error(f"{_shown(self.value)} m is too far from the origin: {how_to_raise('metres')}")
        return float(self.value)

    def place(self) -> tuple[float, float]:
        """[x, z] in metres."""
        x, z = self.point("xz")
        return x, z

    def made(self, make: Callable[[], T]) -> T:
        """What ``make`` gives; its errors are told with the place."""
        try:
            return make()
        except ScriptError:
            raise
        except MotionRTError as error:
            raise self.error(str(error)) from error


def unknown(name: object, known: Sequence[str]) -> str:
    """The end of a message about a name that is none of ``known``: the nearest of them, or all."""
    name = shorten(str(name))
    near = get_close_matches(name, known, n=1, cutoff=0.6)
    return f"'{name}'; did you mean {near[0]}?" if near else f"'{name}'; there are: {', '.join(known)}"


def read_nodes(file: Path) -> Node:
    """The root of a script.

    Raises:
        ScriptError: no such file, not UTF-8, not YAML, a key that stands twice, or more in it than
            :class:`motionrt.limits.Limits` allows.
    """

    def fail(reason: str, line: int | None) -> ScriptError:
        return ScriptError(f"{file}{f':{line}' if line else ''}: {reason}")

    try:
        text = read_utf8(file, fail, "yaml_bytes")
    except FileNotFoundError as error:
        raise fail("there is no such file", None) from error
    root, loader = yaml_text.compose(text, fail)
    try:
        return Node({}, file, 1, "") if root is None else _Reader(file, loader, fail).node(root, ())
    finally:
        loader.dispose()


@dataclass(frozen=True)
class _Reader:
    """From nodes of the YAML library to those of a script."""

    file: Path
    loader: Any
    fail: Fail

    def node(self, node: Any, above: tuple[int, ...]) -> Node:
        line = node.start_mark.line + 1
        if id(node) in above:
            raise self.fail("an alias contains itself", line)
        above = (*above, id(node))
        if node.id == "mapping":
            return Node(self._mapping(node, above), self.file, line, "")
        if node.id == "sequence":
            return Node([self.node(item, above) for item in node.value], self.file, line, "")
        return Node(yaml_text.construct(node, self.loader, self.fail), self.file, line, "")

    def _mapping(self, node: Any, above: tuple[int, ...]) -> dict[str, Node]:
        found: dict[str, Node] = {}
        for key, value in node.value:
            if key.id != "scalar":
                raise self.fail("a key must be a name", key.start_mark.line + 1)
            name, line = key.value, key.start_mark.line + 1
            if name in found:
                raise self.fail(f"'{shorten(name)}' stands twice", line)
            found[name] = Node(self.node(value, above).value, self.file, line, "")
        return found


def _listed(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} or {names[-1]}"


def _shown(value: Any) -> str:
    """A value for a message."""
    if value is None:
        return "nothing"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, dict):
        return f"the keys {shorten(', '.join(value))}" if value else "an empty mapping"
    if isinstance(value, list):
        return f"a list of {len(value)}"
    return f"'{shorten(str(value))}'"
