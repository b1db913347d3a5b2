"""Files with semantic point clouds: PLY, CSV and npz."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from motionrt.errors import FormatError, InvalidInputError, MotionFileNotFoundError
from motionrt.locomotion.words.cloud import SemanticCloud
from motionrt.locomotion.words.ply import read_ply

LABEL_COLUMNS = ("label", "class", "category", "semantic", "scalar_label")


def load_cloud(path: str | Path, names: dict[int, str] | None = None) -> SemanticCloud:
    """A semantic point cloud, Y up, metres.

    * ``.ply`` with x, y, z and an integer ``label`` (also ``class``, ``category``, ``semantic``); names come from
      ``names`` or from comments of the form ``comment label 3 sofa``;
    * ``.csv`` with a header ``x,y,z,label``, labels as words;
    * ``.npz`` with ``points`` ``(N, 3)``, ``labels`` ``(N,)`` and, for integer labels, ``names``.

    Raises:
        MotionFileNotFoundError: no such file.
        FormatError: another suffix, or a file that is not as described; names file, line and reason.
    """
    path = Path(path)
    if not path.is_file():
        raise MotionFileNotFoundError(f"there is no file {path}")
    readers = {".ply": _ply, ".csv": _csv, ".npz": _npz}
    if path.suffix.lower() not in readers:
        raise FormatError(path, f"a semantic cloud is one of {', '.join(readers)}")
    try:
        return readers[path.suffix.lower()](path, names)
    except InvalidInputError as error:
        raise FormatError(path, str(error)) from error


def _ply(path: Path, names: dict[int, str] | None) -> SemanticCloud:
    columns, comments = read_ply(path)
    column = next((name for name in LABEL_COLUMNS if name in columns), None)
    if column is None or not {"x", "y", "z"} <= columns.keys():
        raise FormatError(path, f"needs x, y, z and a label among its properties, found: {', '.join(columns)}")
    points = np.stack([columns[axis] for axis in "xyz"], axis=1)
    return SemanticCloud(points, columns[column].astype(np.int64), names or _named(comments))


def _named(comments: tuple[str, ...]) -> dict[int, str] | None:
    rows = [comment.split(maxsplit=2) for comment in comments]
    found = {int(row[1]): row[2] for row in rows if len(row) == 3 and row[0] == "label" and row[1].isdigit()}
    return found or None


def _csv(path: Path, names: dict[int, str] | None) -> SemanticCloud:
    with path.open(encoding="utf-8-sig", newline="") as file:
        reader = csv.DictReader(file)
        if not {"x", "y", "z", "label"} <= set(reader.fieldnames or ()):
            raise FormatError(path, "needs the columns x, y, z and label in its first line", 1)
        rows = [_row(path, reader.line_num, row) for row in reader]
    points, labels = [row[0] for row in rows], [row[1] for row in rows]
    if names is not None:
        labels = [names.get(int(label), label) if label.isdigit() else label for label in labels]
    return SemanticCloud(np.array(points, np.float32).reshape(-1, 3), np.array(labels, str))


def _row(path: Path, line: int, row: dict[str, str]) -> tuple[list[float], str]:
    try:
        return [float(row[axis]) for axis in "xyz"], row["label"].strip()
    except (TypeError, ValueError, AttributeError):
        raise FormatError(path, "expected three numbers and a label", line) from None


def _npz(path: Path, names: dict[int, str] | None) -> SemanticCloud:
    try:
        with np.load(path, allow_pickle=False) as file:
            arrays = dict(file)
    except (OSError, ValueError) as error:
        raise FormatError(path, f"is no npz file: {error}") from error
    if not {"points", "labels"} <= arrays.keys():
        raise FormatError(path, f"needs arrays 'points' and 'labels', found: {', '.join(arrays) or 'none'}")
    given = [str(name) for name in arrays["names"]] if "names" in arrays else None
    return SemanticCloud(arrays["points"], arrays["labels"], names or given)
