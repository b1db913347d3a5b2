"""Whose data and which licence: what the manifest says of them comes from the checkpoint's own record.

A released network carries ``licence`` and ``data`` (:mod:`motionrt_training.data_record`). What they do not state is
"not stated" in the manifest, too. Checkpoints that this project released before there were records are known by their
checksums, in ``models/records.yaml``; for them the words of :mod:`motionrt_export.cards` hold.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from motionrt_export.cards import CARDS, SENTENCES
from motionrt_export.sources import Release, Source
from motionrt_training.data_record import NOT_STATED

KNOWN = Path(__file__).resolve().parents[2] / "models" / "records.yaml"

Data = tuple[tuple[str, str], ...]  # name and licence of each data set


@dataclass(frozen=True)
class Terms:
    """Licence of the weights, and the data that they were trained on, each with its own licence."""

    licence: str
    training_data: Data


def terms_of(source: Source, known: Path = KNOWN) -> Terms:
    """What the manifest says of a model's licence and data."""
    card = CARDS[source.spec.name]
    if source.release is None:
        return Terms(card.licence, card.training_data)
    if "licence" not in source.release.notes and is_known(source.release, known):
        return Terms(card.licence, card.training_data)
    rows: Sequence[Mapping[str, Any]] = json.loads(source.release.notes.get("data", "[]"))
    data: Data = tuple((_named(row), str(row.get("licence", NOT_STATED))) for row in rows)
    upstream = (SENTENCES,) if card.origin else ()
    return Terms(source.release.notes.get("licence", NOT_STATED), (*(data or ((NOT_STATED, NOT_STATED),)), *upstream))


def is_known(release: Release[Any], known: Path = KNOWN) -> bool:
    """Whether the checkpoint is one that the project released itself."""
    if not (known.is_file() and release.path.is_file()):
        return False
    rows = yaml.safe_load(known.read_text(encoding="utf-8")) or {}
    return hashlib.sha256(release.path.read_bytes()).hexdigest() in rows.get("checkpoints", ())


def _named(row: Mapping[str, Any]) -> str:
    origin = row.get("origin", NOT_STATED)
    of = f" of {origin}" if origin not in {NOT_STATED, ""} else ""
    return f"{row.get('source', NOT_STATED)}{of}, {row.get('recordings', 0)} recordings"
