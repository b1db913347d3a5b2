"""Checkpoints -> ONNX files, each proven, and the manifest: the same bytes whenever it runs."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import Any

import onnx

from motionrt_export import calibration
from motionrt_export.cards import CARDS, SENTENCE_RECIPE
from motionrt_export.entries import Entry, file_entry, model_entry, variant_entry, write_manifest
from motionrt_export.measures import Figures, rounded
from motionrt_export.optimise import CHOICES, FP32, QUANTISED, quantise, shipped, variants
from motionrt_export.sources import Source, Sources
from motionrt_export.tolerances import FLOAT32, INT8
from motionrt_export.trace import trace
from motionrt_training.networks.minilm import MAX_TOKENS

SENTENCE_ENCODER = "sentence_encoder"
HEADING = "Every shipped model. Written by `python -m motionrt_export all --checkpoints models --out models`."

Check = Callable[[str, str, Path], Figures]  # model, variant, file -> worst figures; raises when beyond tolerance
Say = Callable[[str], None]


@dataclass(frozen=True)
class Layout:
    """Where the files go; `out` (shipped) and `build` (not shipped) lie beneath the manifest's folder."""

    manifest: Path
    out: Path
    build: Path

    @property
    def root(self) -> Path:
        return self.manifest.parent

    def file(self, model: str, variant: str) -> Path:
        """The ONNX file of a variant."""
        return (self.out if variant == shipped(model) else self.build) / f"{model}.{variant}.onnx"


def tolerance(model: str, variant: str) -> Figures:
    """What is promised of a variant."""
    return (FLOAT32 if variant == FP32 else INT8)[model]


def publish(sources: Sources, layout: Layout, check: Check, quality: Mapping[str, Any], say: Say) -> None:
    """Export, quantise and validate every model, then write the manifest; on failure it is not touched.

    Raises:
        MissingCheckpointsError: before anything is written.
        ValidationError: a file is beyond its tolerance.
    """
    sources.check()
    tokenizer = _publish_tokenizer(sources, layout)
    entries = {}
    for name in CHOICES:
        source = sources.source(name)
        _export(source, layout)
        proven = {variant: _variant(name, variant, layout, check, say) for variant in variants(name)}
        found = quality.get(name, _trained_quality(source))
        tokens = tokenizer if name == SENTENCE_ENCODER else None
        entries[name] = _entry(source, proven, _recipe(source, layout), found, tokens)
    write_manifest(layout.manifest, entries, HEADING)
    say(f"{layout.manifest}: {len(entries)} models")


def _export(source: Source, layout: Layout) -> None:
    name = source.spec.name
    exact = trace(source.module, source.spec)
    _save(exact, layout.file(name, FP32))
    if choice := CHOICES[name]:
        _save(quantise(exact, choice, source.calibration()), layout.file(name, QUANTISED))


def _save(model: onnx.ModelProto, path: Path) -> None:
    _write(path, model.SerializeToString(deterministic=True))


def _write(path: Path, content: bytes) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f"{path.name}.part")
    temporary.write_bytes(content)
    temporary.replace(path)


def _publish_tokenizer(sources: Sources, layout: Layout) -> Entry:
    path = layout.out / "tokenizer.json"
    _write(path, calibration.plain_tokenizer_json(sources.tokenizer_file).encode("utf-8"))
    return {**file_entry(path, layout.root), "max_tokens": MAX_TOKENS}


def _variant(name: str, variant: str, layout: Layout, check: Check, say: Say) -> Entry:
    path, limits = layout.file(name, variant), tolerance(name, variant)
    figures, choice = rounded(check(name, variant, path)), CHOICES[name]
    shown = ", ".join(f"{output} {key} {figures[output][key]:g}" for output in limits for key in limits[output])
    say(f"{path}: {path.stat().st_size / 1e6:.1f} MB, {shown}")
    return variant_entry(
        path,
        layout.root,
        shipped=variant == shipped(name),
        quantisation=choice.describe() if choice and variant == QUANTISED else "none",
        tolerance=limits,
        parity=figures,
        producers=_producers(),
    )


def _entry(
    source: Source,
    proven: Mapping[str, Entry],
    recipe: Mapping[str, Any],
    quality: Mapping[str, Any],
    tokenizer: Entry | None,
) -> Entry:
    card = CARDS[source.spec.name]
    return model_entry(
        source.spec,
        description=card.description,
        licence=card.licence,
        attribution=card.attribution,
        training_data=card.training_data,
        recipe=recipe,
        feature_statistics=card.feature_statistics,
        default_variant=shipped(source.spec.name),
        variants=proven,
        quality=quality,
        tokenizer=tokenizer,
    )


def _recipe(source: Source, layout: Layout) -> dict[str, Any]:
    if source.release is None:
        return dict(SENTENCE_RECIPE)
    notes, checkpoint = source.release.notes, source.release.path
    return {
        "command": notes.get("command", f"python -m motionrt_training.recipes.{checkpoint.stem}"),
        **{key: _plain(notes[key]) for key in ("seed", "steps", "minutes") if key in notes},
        "checkpoint": _relative(checkpoint, layout.root),
        "checkpoint_sha256": hashlib.sha256(checkpoint.read_bytes()).hexdigest(),
    }


def _trained_quality(source: Source) -> Mapping[str, float]:
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


def _producers() -> dict[str, str]:
    return {name: metadata.version(name).split("+")[0] for name in ("torch", "onnx", "onnxruntime")}
