"""What a packed corpus says of its origin: whose recordings, under which terms, how many.

It travels from the pack to the trainer's checkpoint, from there to the released network and to the manifest.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

NOT_STATED = "not stated"
FIELDS = ("source", "licence", "origin", "recordings")

DataRecord = list[dict[str, Any]]


def data_record(source: str, recordings: int, licence: str | None = None, origin: str | None = None) -> DataRecord:
    """One data set; terms and origin that nobody gave are ``"not stated"``."""
    values = source, licence or NOT_STATED, origin or NOT_STATED, recordings
    return [dict(zip(FIELDS, values, strict=True))]


def data_of(pack: str | Path) -> DataRecord:
    """The record of a packed corpus (``.npz``, or the ``.json`` beside it); empty where it has none."""
    path = Path(pack)
    beside = path.with_suffix(".json")
    if beside.is_file():
        found = json.loads(beside.read_text(encoding="utf-8"))
        return _rows(found.get("provenance", []) if isinstance(found, Mapping) else [])
    if not path.is_file():
        return []
    with np.load(path, allow_pickle=False) as arrays:
        return _rows(json.loads(str(arrays["provenance"]))) if "provenance" in arrays.files else []


def _rows(rows: Sequence[Mapping[str, Any]]) -> DataRecord:
    return [{name: row.get(name, NOT_STATED) for name in FIELDS} for row in rows]
