"""What of a glTF document is read must be of the kinds that the specification says  [glTF 2.0, 5]."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

Check = Callable[[Any], bool]


def _index(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


def _text(value: Any) -> bool:
    return isinstance(value, str)


def _list_of(check: Check) -> Check:
    return lambda value: isinstance(value, list) and all(check(item) for item in value)


def _object(needed: dict[str, Check], **known: Check) -> Check:
    """An object that has all of ``needed``; its members are of the kinds that are given, others may be anything."""

    def check(value: Any) -> bool:
        if not isinstance(value, dict) or not needed.keys() <= value.keys():
            return False
        kinds = {**known, **needed}
        return all(kinds[name](member) for name, member in value.items() if name in kinds)

    return check


_PARTS: dict[str, Check] = {
    "nodes": _object({}, children=_list_of(_index)),
    "skins": _object({}, joints=_list_of(_index), inverseBindMatrices=_index),
    "animations": _object(
        {},
        channels=_list_of(_object({"sampler": _index}, target=_object({}, node=_index, path=_text))),
        samplers=_list_of(_object({"input": _index, "output": _index}, interpolation=_text)),
    ),
    "accessors": _object({}, type=_text, sparse=_object({"indices": _object({}), "values": _object({})})),
    "bufferViews": _object({}, extensions=_object({}), buffer=_index),
    "buffers": _object({}),
}


def misshapen(document: dict[str, Any]) -> str | None:
    """The place of the first part that is of another kind than glTF has there, as in ``animations[2]``, or None.

    Only what motionrt reads is looked at.
    """
    for name, check in _PARTS.items():
        entries = document.get(name, [])
        if not isinstance(entries, list):
            return name
        for number, entry in enumerate(entries):
            if not check(entry) or (name == "animations" and not _sampled(entry)):
                return f"{name}[{number}]"
    return None


def _sampled(animation: dict[str, Any]) -> bool:
    """Whether all channels of an animation name samplers that it has."""
    samplers = len(animation.get("samplers", []))
    return all(0 <= channel["sampler"] < samplers for channel in animation.get("channels", []))
