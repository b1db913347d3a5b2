"""Arguments of callers: of the right kind, or refused by an InvalidInputError that names them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from types import UnionType
from typing import Any

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.untrusted.words import shown


def check_flags(**flags: object) -> None:
    """InvalidInputError unless all are True or False."""
    for name, value in flags.items():
        if not isinstance(value, bool | np.bool_):
            raise InvalidInputError(f"{name} must be True or False, not {shown(value)}")


def check_functions(**functions: object) -> None:
    """InvalidInputError unless all can be called, or are None."""
    for name, value in functions.items():
        if value is not None and not callable(value):
            raise InvalidInputError(f"{name} must be a function, not {shown(value)}")


def check_kind(value: object, kind: type | tuple[type, ...] | UnionType, name: str, what: str) -> None:
    """InvalidInputError unless ``value`` is an instance of ``kind``, which ``what`` says in words."""
    if not isinstance(value, kind):
        raise InvalidInputError(f"{name} must be {what}, not {shown(value)}")


def iterable(value: object) -> bool:
    """Whether a value has items to go through; an array without axes has none."""
    return isinstance(value, Iterable) and not (isinstance(value, np.ndarray) and not value.ndim)


def listed(value: object, name: str, what: str) -> list[Any]:
    """The items of a list, tuple, array or other iterable of ``what``; a text, a mapping and a set are none."""
    if isinstance(value, str | bytes | Mapping | set | frozenset) or not iterable(value):
        raise InvalidInputError(f"{name} must be a list of {what}, not {shown(value)}")
    return list(value)  # type: ignore[call-overload,no-any-return]


def checked_mapping(value: object, name: str, example: str = "{'left_hip': 'L_Thigh'}") -> dict[str, str] | None:
    """A mapping of texts to texts as a dict; None stays None."""
    texts = isinstance(value, Mapping) and all(isinstance(text, str) for pair in value.items() for text in pair)
    if value is not None and not texts:
        raise InvalidInputError(f"{name} must be like {example}, not {shown(value)}")
    return dict(value) if isinstance(value, Mapping) else None


def checked_array(value: object, name: str, what: str) -> npt.NDArray[np.float64]:
    """``value`` as an array of numbers, which ``what`` says in words."""
    try:
        found = np.asarray(value)
        if found.dtype.kind in "fiub" or not found.size:
            return found.astype(np.float64)
    except (TypeError, ValueError, OverflowError):
        pass
    raise InvalidInputError(f"{name} must be {what}, not {shown(value)}")


def checked_choice(value: object, name: str) -> None:
    """InvalidInputError unless one of several things is named by a text or a number, or not at all."""
    if value is not None and not isinstance(value, str) and not (isinstance(value, int) and value is not True):
        raise InvalidInputError(f"{name} must be a name or an index, not {shown(value)}")


def checked_up(up: object) -> None:
    """InvalidInputError unless an axis is ``"y"``, ``"z"`` or not said."""
    if up is not None and not (isinstance(up, str) and up in {"y", "z"}):
        raise InvalidInputError(f"up must be 'y' or 'z', not {shown(up)}")


def real(value: object) -> float:
    """A real number as a float, infinite where it is too large; NaN for anything else, truth values too."""
    if isinstance(value, bool) or not isinstance(value, int | float | np.integer | np.floating):
        return math.nan
    try:
        return float(value)
    except OverflowError:  # a whole number of hundreds of digits
        return math.inf


def checked_number(value: Any, name: str, least: float = -math.inf, most: float = math.inf) -> float:
    """``value`` as a finite number in a range; InvalidInputError otherwise, which says the name and the range."""
    number = real(value)
    if not (math.isfinite(number) and least <= number <= most):
        raise InvalidInputError(f"{name} must be a number{_range(least, most)}, not {shown(value)}")
    return number


def checked_whole(value: Any, name: str, least: float = -math.inf, most: float = math.inf) -> int:
    """``value`` as a whole number in a range; InvalidInputError otherwise, which says the name and the range."""
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or not least <= value <= most:
        raise InvalidInputError(f"{name} must be a whole number{_range(least, most)}, not {shown(value)}")
    return int(value)


def _range(least: float, most: float) -> str:
    if least == -math.inf:
        return ""
    return f" from {least:g}" if most == math.inf else f" from {least:g} to {most:g}"
