"""JSON of strangers, with nesting and size bounded."""

from __future__ import annotations

import json
import re
from typing import Any

from motionrt.limits import how_to_raise, limits
from motionrt.untrusted import Fail

_BRACKETS = re.compile(rb'"[^"\\]*(?:\\.[^"\\]*)*"|[\[{]|[\]}]', re.DOTALL)

_HALF = re.compile(rb"\\u[dD][89a-fA-F]")


def parse(content: bytes, fail: Fail, limit: str = "json_bytes", *, halves: bool = False) -> Any:
    """The value of a JSON text in UTF-8, with or without a byte order mark; NaN and infinities are refused.

    Args:
        content: the text.
        fail: makes the error.
        limit: of its bytes.
        halves: keep lone surrogates, which stand for the bytes of file names that are no Unicode.
    """
    if len(content) > getattr(limits(), limit):
        raise fail(f"holds {len(content):,} bytes of JSON: {how_to_raise(limit)}", None)
    _check_nesting(content, fail)
    try:
        value = json.loads(content.decode("utf-8-sig"), parse_constant=_refused)
        return _whole(value) if not halves and _HALF.search(content) else value
    except UnicodeDecodeError as error:
        raise fail(f"its JSON is not UTF-8 text ({error.reason})", None) from error
    except json.JSONDecodeError as error:
        raise fail(f"is not JSON: {error.msg}", error.lineno) from error
    except ValueError as error:  # a number of thousands of digits, NaN
        raise fail(f"its JSON holds a number that cannot be read: {error}", None) from error


def _whole(value: Any) -> Any:
    """The same with every lone half of a character replaced: no file and no console could take it."""
    if isinstance(value, str):
        return value.encode("utf-16", "surrogatepass").decode("utf-16", "replace")
    if isinstance(value, list):
        return [_whole(item) for item in value]
    return {_whole(key): _whole(item) for key, item in value.items()} if isinstance(value, dict) else value


def _check_nesting(content: bytes, fail: Fail) -> None:
    depth, most = 0, limits().nesting
    if content.count(b"[") + content.count(b"{") <= most:
        return
    for found in _BRACKETS.finditer(content):
        byte = found.group()[:1]
        if byte in b"[{":
            depth += 1
            if depth > most:
                raise fail(f"its JSON is nested too deep: {how_to_raise('nesting')}", None)
        elif byte in b"]}":
            depth -= 1


def _refused(name: str) -> float:
    raise ValueError(f"{name} is no number of JSON")
