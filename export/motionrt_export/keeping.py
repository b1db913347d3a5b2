"""Exporting some of the models: which are exported, and what the manifest says of the others."""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from pathlib import Path

import yaml

from motionrt.models import load_manifest
from motionrt_export.entries import Entry
from motionrt_export.optimise import CHOICES


def chosen(only: Collection[str] | None) -> list[str]:
    """The models to export, in the order of the manifest; None: all.

    Raises:
        ValueError: a name that is none.
    """
    if unknown := sorted({*(only or ())} - {*CHOICES}):
        raise ValueError(f"there is no model {', '.join(unknown)}; there are {', '.join(CHOICES)}")
    return [name for name in CHOICES if only is None or name in only]


def kept_entries(manifest: Path, exported: Collection[str]) -> dict[str, Entry]:
    """The entries of all models that are not exported, as they stand in the manifest; none where there is none.

    Raises:
        ManifestError: there is one, and it is damaged.
    """
    if not manifest.is_file():
        return {}
    load_manifest(manifest)
    models: dict[str, Entry] = yaml.safe_load(manifest.read_text(encoding="utf-8"))["models"]
    return {name: entry for name, entry in models.items() if name not in exported}


def check_tokenizer(kept: Mapping[str, Entry], file: Path, content: str) -> None:
    """ValueError where models that are kept read text otherwise: the tokenizer is one for all.

    The same entries in another order are the same tokenizer.
    """
    readers = [name for name, entry in kept.items() if "tokenizer" in entry]
    if readers and not (file.is_file() and json.loads(file.read_text(encoding="utf-8")) == json.loads(content)):
        raise ValueError(f"the tokenizer {file} is another one; export {', '.join(readers)} as well")


def with_tokenizer(kept: Mapping[str, Entry], tokenizer: Entry) -> dict[str, Entry]:
    """The entries with the tokenizer's file as it is now."""
    return {name: {**e, "tokenizer": dict(tokenizer)} if "tokenizer" in e else e for name, e in kept.items()}


def in_order(entries: Mapping[str, Entry]) -> dict[str, Entry]:
    """The entries in the order of `CHOICES`, others behind."""
    order = [name for name in CHOICES if name in entries]
    return {name: entries[name] for name in (*order, *(name for name in entries if name not in CHOICES))}
