"""What the manifest says of a model's origin: its recipe, the statistics of its data, what training measured."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from importlib import metadata
from pathlib import Path
from typing import Any

from motionrt_export.cards import CARDS
from motionrt_export.entries import Entry, statistic_entry
from motionrt_export.layout import Layout
from motionrt_export.sources import Source

RECIPES = {"text_student": "student"}
"""Recipes that are not called like their network."""


def statistics(source: Source, layout: Layout) -> list[Entry]:
    """The arrays about the training data that the checkpoint brings, if the graph holds any of them."""
    if source.release is None or CARDS[source.spec.name].feature_statistics == "none":
        return []
    where = _relative(source.release.path, layout.root)
    arrays = source.release.model.state_dict()
    kept = [name for name, _ in source.release.model.named_buffers(recurse=False) if name in arrays]
    return [statistic_entry(name, arrays[name].numpy(), where) for name in sorted(kept)]


def recipe(source: Source, layout: Layout) -> dict[str, Any]:
    """How to make the weights again."""
    if source.release is None:
        return dict(CARDS[source.spec.name].origin)
    notes, checkpoint = source.release.notes, source.release.path
    settings = json.loads(notes.get("notes", "{}"))
    return {
        "command": notes.get(
            "command", f"python -m motionrt_training.recipes.{RECIPES.get(checkpoint.stem, checkpoint.stem)}"
        ),
        **{key: _plain(notes[key]) for key in ("seed", "steps", "minutes") if key in notes},
        **{key: settings[key] for key in ("teacher_sha256",) if key in settings},
        "checkpoint": _relative(checkpoint, layout.root),
        "checkpoint_sha256": hashlib.sha256(checkpoint.read_bytes()).hexdigest(),
        **CARDS[source.spec.name].origin,
    }


def trained_quality(source: Source) -> Mapping[str, float]:
    """Measures that the checkpoint carries from its training: of the test split, else of the validation."""
    if source.release is None:
        return {}
    measures = json.loads(source.release.notes.get("measures", "{}"))
    tested = {key: value for key, value in measures.items() if key.startswith("test_")}
    validated = {f"validation_{key}": value for key, value in measures.items() if key != "score"}
    return {key: round(float(value), 2) for key, value in (tested or validated).items()}


def _plain(text: str) -> str | int | float:
    try:
        value = json.loads(text)
    except ValueError:
        return text
    return round(value, 2) if isinstance(value, float) else value if isinstance(value, int) else text


def _relative(path: Path, root: Path) -> str:
    path, root = path.resolve(), root.resolve()
    return path.relative_to(root).as_posix() if path.is_relative_to(root) else path.name


def producers() -> dict[str, str]:
    """Versions of the programs that make the files."""
    return {name: metadata.version(name).split("+")[0] for name in ("torch", "onnx", "onnxruntime")}
