"""Signatures as Python code, annotations as they are written."""

from __future__ import annotations

import inspect
import textwrap
from importlib import import_module
from typing import Any


def signature_of(target: Any) -> str:
    """``(a: int, *, b: str = 'x') -> T``, annotations as they are written."""
    try:
        found = inspect.signature(target)
    except ValueError:
        return "()"
    shown = [_parameter(one) for name, one in found.parameters.items() if name not in {"self", "cls"}]
    back = found.return_annotation
    arrow = "" if inspect.isclass(target) or back in {inspect.Parameter.empty, "None"} else f" -> {_annotation(back)}"
    return f"({', '.join(_with_star(shown, list(found.parameters.values())))}){arrow}"


def _with_star(shown: list[str], parameters: list[inspect.Parameter]) -> list[str]:
    own = [one for one in parameters if one.name not in {"self", "cls"}]
    kinds = [one.kind for one in own]
    keyword = inspect.Parameter.KEYWORD_ONLY
    if keyword in kinds and inspect.Parameter.VAR_POSITIONAL not in kinds:
        shown.insert(kinds.index(keyword), "*")
    return shown


def _parameter(one: inspect.Parameter) -> str:
    star = {inspect.Parameter.VAR_POSITIONAL: "*", inspect.Parameter.VAR_KEYWORD: "**"}.get(one.kind, "")
    kind = "" if one.annotation is inspect.Parameter.empty else f": {_annotation(one.annotation)}"
    if one.default is inspect.Parameter.empty:
        return f"{star}{one.name}{kind}"
    return f"{star}{one.name}{kind} = {_default(one.default)}"


def _annotation(annotation: object) -> str:
    return annotation if isinstance(annotation, str) else inspect.formatannotation(annotation)


def _default(value: object) -> str:
    if value is None or isinstance(value, bool | int | float | str):
        return repr(value)
    if isinstance(value, tuple) and len(value) < 5 and all(isinstance(one, int | float | str) for one in value):
        return repr(value)
    package = import_module("motionrt")
    return next((name for name in package.__all__ if getattr(package, name) is value), "...")


def code(name: str, signature: str) -> str:
    """A signature as code, one parameter a line where it is long."""
    line = f"{name}{signature}"
    if len(line) > 100 and "(" in line:
        inside, _, back = signature[1:].rpartition(")")
        line = f"{name}(\n{textwrap.indent(_lines(inside), '    ')}\n){back}"
    return f"```python\n{line}\n```"


def _lines(inside: str) -> str:
    """Parameters, one a line: split at commas that no bracket holds."""
    depth, parts, current = 0, [], ""
    for letter in inside:
        depth += (letter in "([{") - (letter in ")]}")
        if letter == "," and depth == 0:
            parts.append(current.strip())
            current = ""
        else:
            current += letter
    return ",\n".join([*parts, current.strip()]) + ","
