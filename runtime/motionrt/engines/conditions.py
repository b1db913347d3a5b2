"""Conditions on attributes (``turn > 60 and speed < 1.5``) in the words of a database."""

from __future__ import annotations

import ast
from collections.abc import Callable

from motionrt.errors import InvalidInputError
from motionrt.motion.attributes import POSTURES
from motionrt.retrieval.where import SHORT, condition

_COMPARE: dict[type[ast.cmpop], str] = {
    ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "=", ast.NotEq: "<>",
}  # fmt: skip
_COUNT: dict[type[ast.operator], str] = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}


class Conditions:
    """Writes conditions that were read, and so hold no more than comparisons, numbers and attributes.

    Args:
        column: what an attribute is called in the database.
        equal, unequal: how the database compares.
        absolute: whether it knows ``abs()``.
    """

    def __init__(
        self, column: Callable[[str], str], equal: str = "=", unequal: str = "<>", *, absolute: bool = True
    ) -> None:
        self._column, self._absolute = column, absolute
        self._compare = {**_COMPARE, ast.Eq: equal, ast.NotEq: unequal}

    def written(self, where: str) -> str:
        """A condition in the database's words.

        Raises:
            InvalidInputError: it cannot be read, or the database cannot say it.
        """
        condition(where)  # what is wrong with it is said there
        return self._text(ast.parse(where.strip(), mode="eval").body)

    def _text(self, node: ast.expr) -> str:
        match node:
            case ast.BoolOp(op, values):
                text = (" and " if isinstance(op, ast.And) else " or ").join(self._text(part) for part in values)
            case ast.Compare(left, ops, others):
                pairs = zip(ops, [left, *others], others, strict=False)
                text = " and ".join(self._compared(op, a, b) for op, a, b in pairs)
            case ast.UnaryOp(ast.Not(), operand):
                text = f"not {self._text(operand)}"
            case ast.UnaryOp(ast.USub(), operand):
                text = f"-{self._text(operand)}"
            case ast.UnaryOp(_, operand):
                text = self._text(operand)
            case ast.BinOp(left, op, right):
                text = f"{self._text(left)} {_COUNT[type(op)]} {self._text(right)}"
            case ast.Call(_, [argument]) if self._absolute:
                return f"abs({self._text(argument)})"
            case ast.Name() | ast.Constant():
                return self._atom(node)
            case _:
                raise InvalidInputError("this store takes abs() only alone, on the left of a comparison with a number")
        return f"({text})"

    def _atom(self, node: ast.Name | ast.Constant) -> str:
        if isinstance(node, ast.Name):
            return f"({self._column('farthest')} < 0.5)" if node.id == "in_place" else self._column(_full(node.id))
        value = node.value
        return repr(float(POSTURES.index(value)) if isinstance(value, str) else float(value))  # type: ignore[arg-type]

    def _compared(self, op: ast.cmpop, left: ast.expr, right: ast.expr) -> str:
        sign = self._compare[type(op)]
        if self._absolute or not isinstance(left, ast.Call):
            return f"{self._text(left)} {sign} {self._text(right)}"
        inner, limit = self._text(left.args[0]), self._text(right)
        if isinstance(op, ast.Lt | ast.LtE):  # |a| < b
            return f"({inner} {sign} {limit} and {inner} {sign.replace('<', '>')} -{limit})"
        if isinstance(op, ast.Gt | ast.GtE):  # |a| > b
            return f"({inner} {sign} {limit} or {inner} {sign.replace('>', '<')} -{limit})"
        raise InvalidInputError("this store compares abs() by <, <=, > and >= alone")


def _full(name: str) -> str:
    return SHORT.get(name, name)
