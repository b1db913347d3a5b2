"""Docstrings as Markdown."""

from __future__ import annotations

import inspect
import re
from functools import cached_property

from apidoc.constants import constant_doc

_SECTIONS = {
    "Args": "Arguments",
    "Attributes": "Attributes",
    "Raises": "Raises",
    "Returns": "Returns",
    "Yields": "Yields",
}
_ROLE = re.compile(r":(?:class|func|meth|mod|data|attr):`~?([\w.]+)`")
_ENTRY = re.compile(r"^([\w*][\w*., ]*?): (.*)$")


def markdown(docstring: str) -> str:
    """A docstring with its sections as Markdown."""
    out: list[str] = []
    section = ""
    for line in docstring.splitlines():
        if line.rstrip(":") in _SECTIONS and line.endswith(":"):
            section = line.rstrip(":")
            out += [f"**{_SECTIONS[section]}**", ""]
        else:
            section = section if not line or line.startswith(" ") else ""
            out.append(_entry(line) if section and line else inline(line))
    return "\n".join(out).strip()


def _entry(line: str) -> str:
    """A line of a section: the name in code, what goes on is indented below it."""
    depth, text = len(line) - len(line.lstrip()), line.strip()
    if depth > 4:
        return "  " + inline(text)
    found = _ENTRY.match(text)
    if not found:
        return "* " + inline(text)
    names = ", ".join(f"`{name.strip()}`" for name in found[1].split(","))
    return f"* {names}: {inline(found[2])}"


def inline(text: str) -> str:
    """Inline markup of reStructuredText as Markdown."""
    plain = _ROLE.sub(lambda match: f"`{match[1].removeprefix('motionrt.')}`", text)
    return re.sub(r"``([^`]+)``", r"`\1`", plain)


def first_sentence(target: object, place: str = "") -> str:
    """The first sentence of what a thing says of itself; of a constant, which stands at ``module:name``, too."""
    own = inspect.isroutine(target) or inspect.isclass(target) or isinstance(target, property | cached_property)
    text = (inspect.getdoc(target) if own else constant_doc(*place.split(":"))) or ""
    return inline(" ".join(text.split("\n\n")[0].split())).replace("|", "\\|")
