"""Classes, functions and constants as Markdown."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from functools import cached_property
from importlib import import_module
from typing import Any

from apidoc.constants import constant_doc
from apidoc.prose import markdown
from apidoc.signatures import code, signature_of


def described(place: str) -> Iterator[str]:
    """The Markdown of a class, a function or a constant."""
    target = target_of(place)
    yield f"## {shown(place)}"
    if inspect.isclass(target):
        yield from _class(target)
    elif callable(target):
        yield from _function(target, target.__name__)
    else:
        yield markdown(constant_doc(*place.split(":")))


def _class(target: type) -> Iterator[str]:
    yield code(f"class {target.__name__}", signature_of(target))
    yield markdown(inspect.getdoc(target) or "")
    for name, member in public_members(target):
        if isinstance(member, property | cached_property):
            getter = member.fget if isinstance(member, property) else member.func
            kind = getattr(getter, "__annotations__", {}).get("return", "")
            yield f"### {target.__name__}.{name}"
            yield code("", f"{name}: {kind}")
            yield markdown(inspect.getdoc(member) or "")
        else:
            yield f"### {target.__name__}.{name}"
            yield from _function(member, name)


def _function(target: Callable[..., Any], name: str) -> Iterator[str]:
    yield code(name, signature_of(target))
    yield markdown(inspect.getdoc(target) or "")


def public_members(target: type) -> list[tuple[str, Any]]:
    """Methods and properties of a class and of its own bases, in the order of the source, the class's own first."""
    found: dict[str, Any] = {}
    for base in target.__mro__:
        if base.__module__.startswith("motionrt"):
            for name, member in vars(base).items():
                if _is_public(name, member) and name not in found:
                    found[name] = getattr(target, name) if isinstance(member, classmethod | staticmethod) else member
    return list(found.items())


def _is_public(name: str, member: object) -> bool:
    special = name in {"__getitem__", "__len__", "__iter__", "__call__"}
    kinds = (property, cached_property, classmethod, staticmethod)
    return (not name.startswith("_") or special) and (inspect.isfunction(member) or isinstance(member, kinds))


def errors_page() -> str:
    """The tree of errors."""
    module = import_module("motionrt.errors")
    errors = [
        value for value in vars(module).values() if inspect.isclass(value) and value.__module__ == module.__name__
    ]
    parts = ["# Errors", "All stand in `motionrt.errors`."]
    for error in errors:
        bases = ", ".join(f"`{base.__name__}`" for base in error.__bases__)
        parts += [f"## {error.__name__}", f"Is a {bases}.", markdown(inspect.getdoc(error) or "")]
    return "\n\n".join(part.rstrip() for part in parts) + "\n"


def target_of(place: str) -> Any:
    """The object that ``module:name`` means."""
    module, name = place.split(":")
    return getattr(import_module(module), name)


def shown(place: str) -> str:
    """A place as readers write it: ``motionrt.Runtime``."""
    module, name = place.split(":")
    return f"{module}.{name}"
