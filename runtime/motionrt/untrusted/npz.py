"""Arrays of an npz or npy file of strangers: what its headers claim is checked before anything is unpacked."""

from __future__ import annotations

import io
import math
import struct
import tokenize
import zipfile
import zlib
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import IO, Any

import numpy as np
import numpy.typing as npt

from motionrt.errors import MotionRTError
from motionrt.limits import how_to_raise, limits
from motionrt.untrusted import Fail
from motionrt.untrusted.files import check_file, plain_file

Arrays = dict[str, npt.NDArray[Any]]

BROKEN = (
    OSError,
    ValueError,
    EOFError,
    struct.error,
    zipfile.BadZipFile,
    zipfile.LargeZipFile,
    zlib.error,
    NotImplementedError,  # a compression that Python lacks
    RuntimeError,  # an encrypted member
    tokenize.TokenError,  # NumPy reads old headers as Python
    SyntaxError,
    TypeError,  # a header that holds other things than a header
    UnicodeError,
)
"""What zipfile, zlib and NumPy raise for a damaged file; nothing of this project is called where these are caught."""

_MEMBERS, _NAME, _HEADER = 10_000, 200, 10_000
_PIECE = 1 << 22  # bytes that are unpacked at once


def write_arrays(file: IO[bytes], arrays: Mapping[str, npt.NDArray[Any]], *, compressed: bool = False) -> None:
    """An npz file of arrays of any names; NumPy's own writer takes some of them for its options.

    Raises:
        ValueError: an array of objects.
    """
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED if compressed else zipfile.ZIP_STORED) as archive:
        for name, array in arrays.items():
            with archive.open(f"{name}.npy", "w", force_zip64=True) as member:
                np.lib.format.write_array(member, np.asanyarray(array), allow_pickle=False)


def read_arrays(path: Path, fail: Fail, names: Collection[str] | None = None) -> tuple[Arrays, list[str]]:
    """The arrays of an npz file, or those of ``names`` that it has, and the names of all; objects are refused.

    FileNotFoundError stays what it is: the caller says it in its own words.
    """
    check_file(path, fail)
    try:
        with zipfile.ZipFile(path) as archive:
            members = archive.infolist()
            _check_members(members, most_unpacked(path), fail)
            wanted = [m for m in members if names is None or m.filename.removesuffix(".npy") in names]
            arrays = {m.filename.removesuffix(".npy"): _array(archive, m, fail) for m in wanted}
            return arrays, [m.filename.removesuffix(".npy") for m in members]
    except (MotionRTError, FileNotFoundError):
        raise
    except BROKEN as error:
        raise fail(f"is damaged, or no npz file ({_short(error)})", None) from error


def read_npy(path: Path, fail: Fail) -> npt.NDArray[Any]:
    """The array of an npy file, memory-mapped and read-only, which claims no more than the file holds."""
    size = plain_file(path, fail)
    try:
        with path.open("rb") as file:
            shape, fortran, dtype = _header(file)
            start = file.tell()
        claim = _claimed(shape, dtype, fail)
        if claim != size - start:
            raise fail(f"is damaged (its array needs {claim:,} bytes, it has {size - start:,})", None)
        if not claim:
            return np.zeros(shape, dtype)
        return np.memmap(path, dtype, "r", start, shape, "F" if fortran else "C")
    except (MotionRTError, FileNotFoundError):
        raise
    except BROKEN as error:
        raise fail(f"is damaged, or no npy array ({_short(error)})", None) from error


def most_unpacked(path: Path) -> int:
    """Bytes that a compressed file may unpack to: the limit, or fifty times its size where that is more."""
    return max(limits().unpacked_bytes, 50 * path.stat().st_size)


def _claimed(shape: tuple[int, ...], dtype: np.dtype[Any], fail: Fail) -> int:
    if dtype.hasobject:
        raise fail("holds pickled objects, which are never loaded", None)
    if any(not 0 <= side < 2**62 for side in shape):
        raise fail("holds an array of an impossible shape", None)
    return math.prod(shape) * dtype.itemsize


def _header(file: IO[bytes]) -> tuple[tuple[int, ...], bool, np.dtype[Any]]:
    version = np.lib.format.read_magic(file)
    readers = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}
    if version not in readers:
        raise ValueError(f"npy version {version[0]}.{version[1]}")
    shape, fortran, dtype = readers[version](file, max_header_size=_HEADER)
    return shape, fortran, dtype


def _check_members(members: list[zipfile.ZipInfo], most: int, fail: Fail) -> None:
    if len(members) > _MEMBERS:
        raise fail(f"holds {len(members):,} arrays; at most {_MEMBERS:,} are read", None)
    if any(len(member.filename) > _NAME for member in members):
        raise fail(f"holds an array whose name has more than {_NAME} characters", None)
    total = sum(member.file_size for member in members)
    if total > most:
        raise fail(f"unpacks to {total:,} bytes: {how_to_raise('unpacked_bytes')}", None)


def _array(archive: zipfile.ZipFile, member: zipfile.ZipInfo, fail: Fail) -> npt.NDArray[Any]:
    file = io.BytesIO()
    with archive.open(member) as packed:
        while file.tell() <= member.file_size and (part := packed.read(_PIECE)):
            file.write(part)
    held = file.tell()
    file.seek(0)
    shape, _, dtype = _header(file)
    if (claim := _claimed(shape, dtype, fail)) > held:
        raise fail(f"is damaged ('{member.filename}' needs {claim:,} bytes, it has {held:,})", None)
    file.seek(0)
    return np.asarray(np.lib.format.read_array(file, allow_pickle=False, max_header_size=_HEADER))


def _short(error: BaseException) -> str:
    return " ".join(str(error).split())[:160] or type(error).__name__
