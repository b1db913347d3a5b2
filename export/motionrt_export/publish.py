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
from motionrt_export.optimise import CHOICES, QUANTISED, quantise
from motionrt_export.sources import Source, Sources
from motionrt_export.tolerances import FLOAT32, INT8
from motionrt_export.trace import trace
from motionrt_training.networks.minilm import MAX_TOKENS

FP32 = "fp32"
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
        return (self.build if variant == FP32 else self.out) / f"{model}.{variant}.onnx"


def tolerance(model: str, variant: str) -> Figures:
    """What is promised of a variant."""
    return (FLOAT32 if variant == FP32 else INT8)[model]


def publish(sources: Sources, layout: Layout, check: Check, quality: Mapping[str, Any], say: Say) -> None:
    """Export, quantise and validate every model, then write the manifest; on failure it is not touched."""
    tokenizer = _publish_tokenizer(sources, layout)
    entries = {}
    for name in CHOICES:
        source = sources.source(name)
        _export(source, sources, layout)
        variants = {variant: _variant(name, variant, layout, check, say) for variant in (FP32, QUANTISED)}
        recipe, found = _recipe(name, sources, layout), quality.get(name, _trained_quality(name, sources))
        tokens = tokenizer if name == SENTENCE_ENCODER else None
        entries[name] = _entry(source, variants, recipe, found, tokens)
    write_manifest(layout.manifest, entries, HEADING)
    say(f"{layout.manifest}: {len(entries)} models")


def _export(source: Source, sources: Sources, layout: Layout) -> None:
    name = source.spec.name
    exact = trace(source.module, source.spec)
    feeds = sources.sentences.one_by_one() if name == SENTENCE_ENCODER else ()
    _save(exact, layout.file(name, FP32))
    _save(quantise(exact, CHOICES[name], feeds), layout.file(name, QUANTISED))


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
    figures = rounded(check(name, variant, path))
    shown = ", ".join(f"{output} {key} {figures[output][key]:g}" for output in limits for key in limits[output])
    say(f"{path}: {path.stat().st_size / 1e6:.1f} MB, {shown}")
    return variant_entry(
        path,
        layout.root,
        shipped=variant != FP32,
        quantisation="none" if variant == FP32 else CHOICES[name].describe(),
        tolerance=limits,
        parity=figures,
        producers=_producers(),
    )


def _entry(
    source: Source,
    variants: Mapping[str, Entry],
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
        default_variant=QUANTISED,
        variants=variants,
        quality=quality,
        tokenizer=tokenizer,
    )


def _recipe(name: str, sources: Sources, layout: Layout) -> dict[str, Any]:
    if name == SENTENCE_ENCODER:
        return dict(SENTENCE_RECIPE)
    notes, checkpoint = sources.released[1], sources.checkpoint
    return {
        "command": notes.get("command", "python -m motionrt_training.recipes.tmr"),
        **{key: _plain(notes[key]) for key in ("seed", "steps", "minutes") if key in notes},
        "checkpoint": _relative(checkpoint, layout.root),
        "checkpoint_sha256": hashlib.sha256(checkpoint.read_bytes()).hexdigest(),
    }


def _trained_quality(name: str, sources: Sources) -> Mapping[str, float]:
    """Measures of the test split that the checkpoint carries from its training."""
    if name == SENTENCE_ENCODER:
        return {}
    measures = json.loads(sources.released[1].get("measures", "{}"))
    return {key: round(float(value), 2) for key, value in measures.items() if key.startswith("test_")}


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
