"""YAML of strangers: aliases are counted as what they stand for, and nesting, size and numbers are bounded."""

from __future__ import annotations

from typing import Any

from motionrt.limits import how_to_raise, limits
from motionrt.untrusted import Fail
from motionrt.untrusted.words import shorten

_OPENING, _CLOSING = ("MappingStartEvent", "SequenceStartEvent"), ("MappingEndEvent", "SequenceEndEvent")


def compose(text: str, fail: Fail) -> tuple[Any, Any]:
    """The root node of a YAML text (None where it is empty), and the loader that constructs plain values of it."""
    import yaml

    check_yaml(text, fail)
    try:
        loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)(text)
        return loader.get_single_node(), loader
    except yaml.YAMLError as error:
        raise _told(error, fail) from error


def parse(text: str, loader: Any, fail: Fail) -> Any:
    """The plain value of a YAML text, by a safe loader class."""
    import yaml

    check_yaml(text, fail)
    try:
        return yaml.load(text, loader)
    except yaml.YAMLError as error:
        raise _told(error, fail) from error
    except (ValueError, OverflowError, TypeError) as error:  # a date or a number that is none; a key that is a list
        raise fail(f"holds a value that cannot be read: {shorten(str(error), 90)}", None) from error


def construct(node: Any, loader: Any, fail: Fail) -> Any:
    """The value of a scalar node."""
    import yaml

    try:
        return loader.construct_object(node)
    except yaml.YAMLError as error:
        raise _told(error, fail) from error
    except (ValueError, OverflowError) as error:  # 2001-13-45; a number of thousands of digits
        line = node.start_mark.line + 1
        raise fail(f"'{shorten(node.value)}' is no value that can be read: {shorten(str(error), 90)}", line) from error


def check_yaml(text: str, fail: Fail) -> None:
    """Refuse a text that would cost more than its size says: read event by event, nothing is built."""
    import yaml

    if len(text) > limits().yaml_bytes:
        raise fail(f"has {len(text):,} characters: {how_to_raise('yaml_bytes')}", None)
    counted = _Counted(fail)
    try:
        for event in yaml.parse(text, getattr(yaml, "CSafeLoader", yaml.SafeLoader)):
            counted.take(event)
    except yaml.YAMLError as error:
        raise _told(error, fail) from error


class _Counted:
    """Values of a document so far, aliases written out."""

    def __init__(self, fail: Fail) -> None:
        self._fail, self._nodes, self._most = fail, 0, limits()
        self._open: list[tuple[str | None, int]] = []
        self._sizes: dict[str, int] = {}

    def take(self, event: Any) -> None:
        kind = type(event).__name__
        if kind == "AliasEvent":
            self._nodes += self._sizes.get(event.anchor, 1)
        elif kind in _OPENING:
            self._open.append((event.anchor, self._nodes))
            self._nodes += 1
        elif kind in _CLOSING:
            anchor, before = self._open.pop()
            if anchor is not None:
                self._sizes[anchor] = self._nodes - before
        elif kind == "ScalarEvent":
            self._nodes += 1
            if event.anchor is not None:
                self._sizes[event.anchor] = 1
        if len(self._open) > self._most.nesting:
            raise self._fail(f"is nested too deep: {how_to_raise('nesting')}", event.start_mark.line + 1)
        if self._nodes > self._most.yaml_nodes:
            reason = f"holds too many values, aliases written out: {how_to_raise('yaml_nodes')}"
            raise self._fail(reason, event.start_mark.line + 1)


def _told(error: Any, fail: Fail) -> Exception:
    """What a YAML parser complains about, in few words."""
    mark = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
    words = getattr(error, "problem", None) or getattr(error, "context", None) or getattr(error, "reason", None)
    return fail(f"is not YAML: {words or str(error)[:200]}", mark.line + 1 if mark else None)
