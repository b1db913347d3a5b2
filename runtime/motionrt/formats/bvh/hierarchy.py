"""The HIERARCHY part of a BVH file: a token parser that knows on which line it stands."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from motionrt.errors import FormatError
from motionrt.formats.text import shorten, to_float
from motionrt.limits import how_to_raise, limits

_CHANNELS = {f"{axis}{kind}".lower(): f"{axis}{kind}" for axis in "XYZ" for kind in ("position", "rotation")}


@dataclass
class BvhJoint:
    """One joint or end site as the file declares it; ``channels`` are names such as ``Zrotation``."""

    name: str
    parent: int
    line: int
    offset: tuple[float, float, float] | None = None
    channels: list[str] = field(default_factory=list)
    is_end: bool = False

    @property
    def rotations(self) -> list[int]:
        """Which of the channels are rotations."""
        return [i for i, channel in enumerate(self.channels) if channel.endswith("rotation")]

    @property
    def rotation_order(self) -> str:
        """Axes of the rotation channels in file order, such as ``ZXY``; may be empty."""
        return "".join(self.channels[i][0] for i in self.rotations)

    @property
    def positions(self) -> list[tuple[int, int]]:
        """Which of the channels are positions, each with its axis 0, 1 or 2."""
        return [(i, "XYZ".index(c[0])) for i, c in enumerate(self.channels) if c.endswith("position")]


def parse_hierarchy(text: str, path: Path) -> list[BvhJoint]:
    """Joints and end sites, parents before children, from all text before ``MOTION``."""
    if [word.upper() for word in text.split(maxsplit=1)[:1]] != ["HIERARCHY"]:
        raise FormatError(path, "not a BVH file: it does not start with HIERARCHY", 1)
    return _HierarchyParser(text, path).parse()


class _HierarchyParser:
    def __init__(self, text: str, path: Path) -> None:
        self.path = path
        self.words: list[tuple[str, int]] = [
            (word, number)
            for number, line in enumerate(text.split("\n"), start=1)
            for word in line.replace("{", " { ").replace("}", " } ").split()
        ]
        self.at = 1
        self.joints: list[BvhJoint] = []
        self._taken: dict[str, int] = {}
        self.open: list[int] = []

    def parse(self) -> list[BvhJoint]:
        while self.at < len(self.words):
            self._statement()
        if self.open:
            joint = self.joints[self.open[-1]]
            raise self._error(f"the '{{' of '{joint.name}' is never closed", joint.line)
        if not self.joints:
            raise self._error("the hierarchy has no ROOT", self.line)
        self._check_offsets()
        return self.joints

    def _statement(self) -> None:
        word, line = self._next("a keyword")
        keyword = word.upper()
        if keyword in ("ROOT", "JOINT", "END"):
            self._block(keyword, line)
        elif keyword == "}":
            if not self.open:
                raise self._error("a '}' too many", line)
            self.open.pop()
        elif keyword == "OFFSET":
            x, y, z = (self._number() for _ in range(3))
            self._current(line).offset = (x, y, z)
        elif keyword == "CHANNELS":
            self._channels(self._current(line), line)
        else:
            known = "ROOT, JOINT, End Site, OFFSET, CHANNELS or '}'"
            raise self._error(f"expected {known}, found '{shorten(word)}'", line)

    def _block(self, keyword: str, line: int) -> None:
        name = self._name(line)
        if keyword == "ROOT" and self.joints:
            raise self._error("a second ROOT: files with several skeletons are not supported, split it", line)
        if keyword != "ROOT" and not self.open:
            raise self._error(f"'{keyword.title()} {name}' stands outside of any ROOT", line)
        if self.open and self._current(line).is_end:
            raise self._error("an End Site cannot have children", line)
        parent = self.open[-1] if self.open else -1
        if keyword == "END":
            name = f"{self.joints[parent].name}_end"
        elif not name:
            raise self._error(f"{keyword} without a name", line)
        brace, brace_line = self._next(f"'{{' after '{name}'")
        if brace != "{":
            raise self._error(f"expected '{{' after '{name}', found '{shorten(brace)}'", brace_line)
        if len(self.joints) >= limits().joints * 2:  # every joint may have an end site
            raise self._error(f"more joints than are read: {how_to_raise('joints')}", line)
        self.open.append(len(self.joints))
        self.joints.append(BvhJoint(self._unique(name), parent, line, is_end=keyword == "END"))

    def _name(self, line: int) -> str:
        """The rest of the line: names may hold spaces, colons and anything but braces."""
        words = []
        while self.at < len(self.words) and self.words[self.at][1] == line and self.words[self.at][0] != "{":
            words.append(self._next("a name")[0])
        return " ".join(words)

    def _unique(self, name: str) -> str:
        """The second joint of a name becomes ``<name>_2``, the third ``<name>_3``."""
        candidate, count = name, self._taken.get(name, 0) + 1
        while count > 1 and (candidate := f"{name}_{count}") in self._taken:
            count += 1
        self._taken[name] = max(count, 1)
        self._taken.setdefault(candidate, 1)
        return candidate

    def _channels(self, joint: BvhJoint, line: int) -> None:
        word, _ = self._next("the number of channels")
        if not (word.isascii() and word.isdecimal() and len(word) < 10) or not 0 <= int(word) <= 6:
            raise self._error(f"a joint has 0 to 6 channels, not '{shorten(word)}'", line)
        if joint.channels:
            raise self._error(f"'{joint.name}' has two CHANNELS lines", line)
        for _ in range(int(word)):
            name, at = self._next("a channel name")
            if name.lower() not in _CHANNELS:
                known = ", ".join(_CHANNELS.values())
                raise self._error(f"unknown channel '{shorten(name)}'; known are {known}", at)
            joint.channels.append(_CHANNELS[name.lower()])
        axes = [axis for _, axis in joint.positions]
        if len(axes) != len(set(axes)) or len(joint.rotations) > 3:
            raise self._error(f"'{joint.name}' lists a channel twice", line)

    def _check_offsets(self) -> None:
        for joint in self.joints:
            if joint.offset is None and not joint.is_end:
                raise self._error(f"joint '{joint.name}' has no OFFSET", joint.line)

    @property
    def line(self) -> int:
        return self.words[min(self.at, len(self.words)) - 1][1]

    def _current(self, line: int) -> BvhJoint:
        if not self.open:
            raise self._error("OFFSET or CHANNELS outside of any joint", line)
        return self.joints[self.open[-1]]

    def _next(self, expected: str) -> tuple[str, int]:
        if self.at >= len(self.words):
            raise self._error(f"the hierarchy ends where {expected} should stand", self.line)
        self.at += 1
        return self.words[self.at - 1]

    def _number(self) -> float:
        word, line = self._next("a number")
        return to_float(word, self.path, line)

    def _error(self, reason: str, line: int) -> FormatError:
        return FormatError(self.path, reason, line)
