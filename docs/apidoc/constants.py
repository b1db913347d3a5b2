"""What stands below constants: Python forgets it, so the source is read."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterator
from importlib import import_module
from itertools import pairwise
from types import ModuleType


def constant_doc(module: str, name: str) -> str:
    """The string below a constant, where it is defined."""
    home: ModuleType = import_module(module)
    if module == "motionrt":
        from motionrt import _HOMES

        home = import_module(f"motionrt.{next(place for place, names in _HOMES.items() if name in names)}")
    for source in (home, *_imported(home, name)):
        body = ast.parse(inspect.getsource(source)).body
        for statement, after in pairwise(body):
            if name in _assigned(statement) and isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant):
                return inspect.cleandoc(str(after.value.value))
    return ""


def _imported(home: ModuleType, name: str) -> Iterator[ModuleType]:
    """The modules that a package has a name from, at once or when it is asked for."""
    for statement in ast.walk(ast.parse(inspect.getsource(home))):
        if isinstance(statement, ast.ImportFrom) and any(alias.name == name for alias in statement.names):
            yield import_module(str(statement.module))


def _assigned(statement: ast.stmt) -> set[str]:
    targets = statement.targets if isinstance(statement, ast.Assign) else [getattr(statement, "target", None)]
    return {target.id for target in targets if isinstance(target, ast.Name)}
