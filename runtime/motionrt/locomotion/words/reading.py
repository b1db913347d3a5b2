"""Files with semantic point clouds: PLY, CSV, npz and OBJ."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import numpy as np

from motionrt.errors import FormatError, InvalidInputError, MotionFileNotFoundError
from motionrt.locomotion.words.cloud import SemanticCloud
from motionrt.locomotion.words.obj import read_obj
from motionrt.locomotion.words.ply import read_ply
from motionrt.untrusted.files import as_path, check_file, read_utf8
from motionrt.untrusted.npz import read_arrays
from motionrt.untrusted.words import shorten

LABEL_COLUMNS = ("label", "class", "category", "semantic", "scalar_label")


def load_cloud(path: str | Path, names: dict[int, str] | None = None) -> SemanticCloud:
    """A semantic point cloud, Y up, metres.

    * ``.ply`` with x, y, z and an integer ``label`` (also ``class``, ``category``, ``semantic``); names come from
      ``names`` or from comments of the form ``comment label 3 sofa``;
    * ``.csv`` with a header ``x,y,z,label``, labels as words;
    * ``.obj``: points on the faces of a mesh, labelled by object (``o``), else group (``g``), else material;
    * ``.npz`` with ``points`` ``(N, 3)``, ``labels`` ``(N,)`` and, for integer labels, ``names``.

    Raises:
        MotionFileNotFoundError: no such file.
        FormatError: another suffix, or a file that is not as described; names file, line and reason.
    """
    path = as_path(path)
    readers = {".ply": _ply, ".csv": _csv, ".npz": _npz, ".obj": _obj}
    if path.suffix.lower() not in readers:
        raise FormatError(path, f"a semantic cloud is one of {', '.join(readers)}")
    try:
        check_file(path, lambda reason, line: FormatError(path, reason, line))
        return readers[path.suffix.lower()](path, names)
    except FileNotFoundError as error:
        raise MotionFileNotFoundError(f"there is no file {path}") from error
    except InvalidInputError as error:
        raise FormatError(path, str(error)) from error


def _ply(path: Path, names: dict[int, str] | None) -> SemanticCloud:
    columns, comments = read_ply(path)
    column = next((name for name in LABEL_COLUMNS if name in columns), None)
    if column is None or not {"x", "y", "z"} <= columns.keys():
        raise FormatError(path, f"needs x, y, z and a label among its properties, found: {shorten(', '.join(columns))}")
    points = np.stack([columns[axis] for axis in "xyz"], axis=1)
    labels = columns[column]
    if labels.dtype.kind == "f":
        labels = np.clip(np.nan_to_num(labels), -(2**62), 2**62)
    return SemanticCloud(points, labels.astype(np.int64), names or _named(comments))


def _named(comments: tuple[str, ...]) -> dict[int, str] | None:
    rows = [comment.split(maxsplit=2) for comment in comments]
    found = {int(row[1]): row[2] for row in rows if len(row) == 3 and row[0] == "label" and _is_number(row[1])}
    return found or None


def _is_number(word: str) -> bool:
    return word.isascii() and word.isdigit() and len(word) < 19


def _csv(path: Path, names: dict[int, str] | None) -> SemanticCloud:
    text = read_utf8(path, lambda reason, line: FormatError(path, reason, line))
    reader = csv.DictReader(io.StringIO(text, newline=""))
    try:
        if not {"x", "y", "z", "label"} <= set(reader.fieldnames or ()):
            raise FormatError(path, "needs the columns x, y, z and label in its first line", 1)
        rows = [_row(path, reader.line_num, row) for row in reader]
    except csv.Error as error:  # a field of more than 131072 characters, a NUL
        raise FormatError(path, f"is no table: {error}", reader.line_num) from error
    points, labels = [row[0] for row in rows], [row[1] for row in rows]
    if names is not None:
        labels = [names.get(int(label), label) if _is_number(label) else label for label in labels]
    return SemanticCloud(np.array(points, np.float64).reshape(-1, 3), np.array(labels, str))


def _row(path: Path, line: int, row: dict[str, str]) -> tuple[list[float], str]:
    try:
        return [float(row[axis]) for axis in "xyz"], row["label"].strip()
    except (TypeError, ValueError, AttributeError):
        raise FormatError(path, "expected three numbers and a label", line) from None


def _obj(path: Path, names: dict[int, str] | None) -> SemanticCloud:
    points, labels = read_obj(path)
    if names is not None:
        labels = np.array([names.get(int(label), label) if _is_number(label) else label for label in labels.tolist()])
    return SemanticCloud(points, labels)


def _npz(path: Path, names: dict[int, str] | None) -> SemanticCloud:
    arrays, _ = read_arrays(path, lambda reason, line: FormatError(path, reason, line))
    if not {"points", "labels"} <= arrays.keys():
        found = shorten(", ".join(arrays)) or "none"
        raise FormatError(path, f"needs arrays 'points' and 'labels', found: {found}")
    if arrays["points"].dtype.kind not in "fiu" or arrays["labels"].dtype.kind not in "iuUS":
        raise FormatError(path, "its points must be numbers, and its labels whole numbers or words")
    given = arrays.get("names")
    if given is not None and (given.ndim != 1 or given.dtype.kind not in "US"):
        raise FormatError(path, "its names must be a list of words")
    listed = None if given is None else given.astype(str).tolist()
    return SemanticCloud(arrays["points"], arrays["labels"], names or listed)
