"""``--where "turn > 60 and speed < 1.5"``: a small language of conditions on attributes, read without ``eval``."""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.motion.attributes import ATTRIBUTES, POSTURES

Columns = Mapping[str, npt.NDArray[np.float64]]
SHORT = {
    "duration": "seconds",
    "speed": "speed_mean",
    "bend": "path_bend",
    "radius": "path_radius",
    "forward": "walk_forward",
    "left": "walk_left",
    "spin": "spin_extent",
    "lean": "lean_max",
    "lowest": "pelvis_lowest",
    "start": "posture_start",
    "end": "posture_end",
}
"""Short names of attributes in conditions."""

_LONGEST = 500
_COMPARE: dict[type[ast.cmpop], Callable[[Any, Any], Any]] = {
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
}
_COUNT: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
}
_READERS: dict[type[ast.expr], str] = {
    ast.BoolOp: "_joined",
    ast.Compare: "_compared",
    ast.UnaryOp: "_unary",
    ast.BinOp: "_counted",
    ast.Name: "_named",
    ast.Constant: "_constant",
    ast.Call: "_called",
}


def condition(text: str) -> Condition:
    """Read a condition, as in ``"turn > 60 and speed < 1.5"``.

    Raises:
        InvalidInputError: it cannot be read, or names something that is no attribute; the message says what there is.
    """
    if not isinstance(text, str) or not text.strip() or len(text) > _LONGEST:
        raise InvalidInputError(f"a condition is a text of at most {_LONGEST} letters, as in 'turn > 60'")
    try:
        tree = ast.parse(text.strip(), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise InvalidInputError(
            f"cannot read the condition {text!r}: write it as in 'turn > 60 and speed < 1.5'"
        ) from error
    read = Condition(text, tree)
    read({name: np.zeros(1) for name in ATTRIBUTES})  # whatever is wrong shows now
    return read


class Condition:
    """A condition that was read; call it with columns to get ``(N,)`` booleans."""

    def __init__(self, text: str, tree: ast.expr) -> None:
        self.text = text
        self._tree = tree

    def __call__(self, columns: Columns) -> npt.NDArray[np.bool_]:
        """Which rows of the columns fulfil it."""
        with np.errstate(all="ignore"):
            found = np.asarray(self._value(self._tree, columns))
        if found.dtype != bool:
            raise self._wrong("it compares nothing")
        return np.broadcast_to(found, (len(columns["turn"]),))

    def _value(self, node: ast.expr, columns: Columns) -> Any:
        reader = getattr(self, _READERS.get(type(node), ""), None)
        if reader is None:
            raise self._wrong(f"{ast.unparse(node)!r} is not understood")
        return reader(node, columns)

    def _counted(self, node: ast.BinOp, columns: Columns) -> Any:
        if type(node.op) not in _COUNT:
            raise self._wrong("count with +, -, * or /")
        left, right = (self._number(side, columns) for side in (node.left, node.right))
        return _COUNT[type(node.op)](left, right)

    def _called(self, node: ast.Call, columns: Columns) -> Any:
        if not isinstance(node.func, ast.Name) or node.func.id != "abs" or len(node.args) != 1 or node.keywords:
            raise self._wrong("the only function is abs(...), of one number")
        return np.abs(self._number(node.args[0], columns))

    def _joined(self, node: ast.BoolOp, columns: Columns) -> Any:
        parts = [self._truth(part, columns) for part in node.values]
        join = np.logical_and if isinstance(node.op, ast.And) else np.logical_or
        return join.reduce(np.broadcast_arrays(*parts))

    def _compared(self, node: ast.Compare, columns: Columns) -> Any:
        values = [self._number(side, columns) for side in (node.left, *node.comparators)]
        found: Any = True
        for kind, left, right in zip(node.ops, values, values[1:], strict=False):
            if type(kind) not in _COMPARE:
                raise self._wrong("compare with <, <=, >, >=, == or !=")
            found = np.logical_and(found, _COMPARE[type(kind)](left, right))
        return found

    def _unary(self, node: ast.UnaryOp, columns: Columns) -> Any:
        if isinstance(node.op, ast.Not):
            return np.logical_not(self._truth(node.operand, columns))
        value = self._number(node.operand, columns)
        return -value if isinstance(node.op, ast.USub) else value

    def _truth(self, node: ast.expr, columns: Columns) -> Any:
        value = np.asarray(self._value(node, columns))
        if value.dtype != bool:
            raise self._wrong(f"{ast.unparse(node)!r} is a number; compare it, as in '{ast.unparse(node)} > 0'")
        return value

    def _number(self, node: ast.expr, columns: Columns) -> Any:
        value = self._value(node, columns)
        if np.asarray(value).dtype == bool:
            raise self._wrong(f"{ast.unparse(node)!r} is a condition; write 'and' between conditions")
        return value

    def _named(self, node: ast.Name, columns: Columns) -> Any:
        name = node.id
        if name == "in_place":
            return columns["farthest"] < 0.5
        name = SHORT.get(name, name)
        if name not in columns:
            raise self._wrong(
                f"there is no attribute {name!r}; there are {', '.join((*SHORT, *ATTRIBUTES, 'in_place'))}"
            )
        return columns[name]

    def _constant(self, node: ast.Constant, _columns: Columns) -> float:
        value = node.value
        if isinstance(value, str) and value in POSTURES:
            return float(POSTURES.index(value))
        if isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e12:
            return float(value)
        raise self._wrong(f"{value!r} is neither a number nor a posture ({', '.join(POSTURES)})")

    def _wrong(self, reason: str) -> InvalidInputError:
        return InvalidInputError(f"cannot read the condition {self.text!r}: {reason}")
