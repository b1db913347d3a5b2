"""Columns of a safetensors file of strangers, memory-mapped: what its header claims is checked first.

The format (https://github.com/huggingface/safetensors): eight bytes with the length of the header, the header in JSON,
and the arrays, one behind the other, little-endian.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from motionrt.untrusted import Fail, json_text
from motionrt.untrusted.files import plain_file
from motionrt.untrusted.words import shown

Columns = dict[str, npt.NDArray[Any]]

DTYPES: Mapping[str, np.dtype[Any]] = {
    name: np.dtype(kind)
    for name, kind in {
        "F64": "<f8", "F32": "<f4", "F16": "<f2", "I64": "<i8", "I32": "<i4", "I16": "<i2", "I8": "i1",
        "U64": "<u8", "U32": "<u4", "U16": "<u2", "U8": "u1",
    }.items()
}  # fmt: skip
"""What a column may hold, by the name that the format gives it."""

_LONGEST_HEADER = 1 << 20


def read_columns(path: Path, fail: Fail) -> tuple[Columns, dict[str, str]]:
    """The columns of a file by name, memory-mapped and read-only, and its metadata.

    FileNotFoundError stays what it is: the caller says it in its own words.
    """
    size = plain_file(path, fail)
    try:
        with path.open("rb") as file:
            length = int.from_bytes(file.read(8), "little")
            header = file.read(length) if length <= min(_LONGEST_HEADER, size - 8) else b""
    except FileNotFoundError:
        raise
    except OSError as error:
        raise fail(f"cannot be read: {error.strerror or error}", None) from error
    if not length or len(header) != length:
        raise fail("is damaged, or no safetensors file (its header is cut off)", None)
    told = json_text.parse(header, fail)
    if not isinstance(told, dict):
        raise fail("is no safetensors file (its header is no table)", None)
    metadata = _metadata(told.pop("__metadata__", {}), fail)
    content = np.memmap(path, np.uint8, "r", 8 + length) if size > 8 + length else np.zeros(0, np.uint8)
    return {name: _column(content, name, entry, fail) for name, entry in told.items()}, metadata


def checked(
    columns: Columns, kinds: Mapping[str, tuple[str, tuple[int | None, ...]]], fail: Fail
) -> Callable[[str], npt.NDArray[Any]]:
    """Gives columns by name, all of which have the type and shape that ``kinds`` asks for; None is any length."""
    for name, (kind, shape) in kinds.items():
        found = columns.get(name)
        if found is None or found.dtype != DTYPES[kind] or found.ndim != len(shape):
            raise fail(f"is damaged (its column {name} is missing or of another kind)", None)
        if any(want not in (None, side) for want, side in zip(shape, found.shape, strict=True)):
            raise fail(f"is damaged (its column {name} has the shape {found.shape})", None)
    return columns.__getitem__


def _metadata(told: object, fail: Fail) -> dict[str, str]:
    if not isinstance(told, dict) or not all(isinstance(value, str) for value in told.values()):
        raise fail(f"is damaged (its metadata is {shown(told)})", None)
    return dict(told)


def _column(content: npt.NDArray[np.uint8], name: str, entry: object, fail: Fail) -> npt.NDArray[Any]:
    if not isinstance(entry, dict) or entry.get("dtype") not in DTYPES:
        raise fail(f"is damaged (its column {shown(name)} is {shown(entry)})", None)
    shape, place = _whole_numbers(entry.get("shape")), _whole_numbers(entry.get("data_offsets"))
    if shape is None or place is None or len(place) != 2:
        raise fail(f"is damaged (its column {shown(name)} is {shown(entry)})", None)
    dtype = DTYPES[entry["dtype"]]
    start, end = place
    if not start <= end <= len(content) or math.prod(shape) * dtype.itemsize != end - start:
        raise fail(f"is damaged (its column {shown(name)} does not fit into it)", None)
    return np.asarray(content[start:end]).view(dtype).reshape(shape)


def _whole_numbers(value: object) -> list[int] | None:
    if not isinstance(value, list) or not all(type(number) is int and 0 <= number < 2**62 for number in value):
        return None
    return value
