"""YAML as nodes that know their line, and checks whose errors name file, line and place."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any, TypeVar

from motionrt.errors import MotionRTError, ScriptError

T = TypeVar("T")


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
        """A finite number."""
        if isinstance(self.value, bool) or not isinstance(self.value, int | float) or not math.isfinite(self.value):
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
        return float(self.value)

    def whole(self) -> int:
        """A whole number from 0."""
        if isinstance(self.value, bool) or not isinstance(self.value, int) or self.value < 0:
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
        return tuple(node.named(self.name).number("metres") for node in nodes)

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
    near = get_close_matches(str(name), known, n=1, cutoff=0.6)
    return f"'{name}'; did you mean {near[0]}?" if near else f"'{name}'; there are: {', '.join(known)}"


def read_nodes(file: Path) -> Node:
    """The root of a script.

    Raises:
        ScriptError: no such file, not UTF-8, not YAML, or a key that stands twice.
    """
    import yaml

    try:
        text = file.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise ScriptError(f"{file}: is not UTF-8 text ({error.reason}); save it as UTF-8") from error
    except OSError as error:
        raise ScriptError(f"{file}: cannot be read: {error.strerror}") from error
    loader = yaml.SafeLoader(text)
    try:
        root = loader.get_single_node()
        return Node({}, file, 1, "") if root is None else _node(root, loader, file, ())
    except yaml.MarkedYAMLError as error:
        line = error.problem_mark.line + 1 if error.problem_mark else 1
        raise ScriptError(f"{file}:{line}: is not YAML: {error.problem or error.context}") from error
    except yaml.YAMLError as error:
        raise ScriptError(f"{file}: is not YAML: {error}") from error
    finally:
        loader.dispose()


def _node(node: Any, loader: Any, file: Path, above: tuple[int, ...]) -> Node:
    import yaml

    line = node.start_mark.line + 1
    if id(node) in above:
        raise ScriptError(f"{file}:{line}: an alias contains itself")
    above = (*above, id(node))
    if isinstance(node, yaml.MappingNode):
        return Node(_mapping(node, loader, file, above), file, line, "")
    if isinstance(node, yaml.SequenceNode):
        return Node([_node(item, loader, file, above) for item in node.value], file, line, "")
    return Node(loader.construct_object(node), file, line, "")


def _mapping(node: Any, loader: Any, file: Path, above: tuple[int, ...]) -> dict[str, Node]:
    found: dict[str, Node] = {}
    for key, value in node.value:
        name, line = str(key.value), key.start_mark.line + 1
        if name in found:
            raise ScriptError(f"{file}:{line}: '{name}' stands twice")
        found[name] = Node(_node(value, loader, file, above).value, file, line, "")
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
        return f"the keys {', '.join(value)}" if value else "an empty mapping"
    if isinstance(value, list):
        return f"a list of {len(value)}"
    return f"'{value}'"
