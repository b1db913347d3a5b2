"""Checkpoints -> ONNX files, each proven, and the manifest: the same bytes whenever it runs."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import onnx

from motionrt.retrieval.captions import read_captions
from motionrt.services.search import DEFAULT_CAPTIONS
from motionrt_export import calibration, halve
from motionrt_export.branch import with_switch
from motionrt_export.cards import CARDS
from motionrt_export.entries import Entry, file_entry, model_entry, variant_entry, write_manifest
from motionrt_export.keeping import check_tokenizer, chosen, in_order, kept_entries, with_tokenizer
from motionrt_export.layout import Layout
from motionrt_export.measured import Measured
from motionrt_export.measures import Figures, beyond, rounded
from motionrt_export.optimise import CHOICES, FP16, FP32, QUANTISED, is_shipped, preferred, quantise, variants
from motionrt_export.pipelines import PIPELINES
from motionrt_export.provenance import producers, recipe, statistics, trained_quality
from motionrt_export.records import terms_of
from motionrt_export.sources import Source, Sources
from motionrt_export.tolerances import pipeline_tolerance, tolerance
from motionrt_export.trace import trace
from motionrt_export.validate import ValidationError
from motionrt_training.networks.minilm import MAX_TOKENS
from motionrt_training.wording.grammar import sentences

HEADING = "Every shipped model. Written by `python -m motionrt_export all --checkpoints models --out models`."

UNUSED = {"tmr_decoder", "temos_motion"}
"""Models that nothing which files make together uses."""

Check = Callable[[str, str, Path, Path | None], Figures]
"""Model, variant, file, float32 file -> worst figures; raises where they are beyond the tolerance."""
PipelineCheck = Callable[[str, Path], Mapping[str, Figures]]
"""Name of a pipeline, manifest of the files -> figures of every variant."""
Say = Callable[[str], None]


@dataclass(frozen=True)
class Proof:
    """Who proves the files, one by one and together."""

    file: Check
    pipeline: PipelineCheck


def publish(
    sources: Sources,
    layout: Layout,
    proof: Proof,
    measured: Measured,
    say: Say,
    only: Collection[str] | None = None,
) -> None:
    """Export, quantise and validate every model, then write the manifest; on failure it is not touched.

    With `only` just these models: what the manifest says of the others stays as it is, and what files make together is
    proven where one of these owns it.

    Raises:
        MissingCheckpointsError: before anything is written.
        ValueError: `only` names no model, or the manifest that it goes into cannot take it.
        ValidationError: a file, or what the files make together, is beyond its tolerance.
    """
    names = chosen(only)
    kept = {} if only is None else kept_entries(layout.manifest, names)
    sources.check(None if only is None else names)
    tokenizer = _publish_tokenizer(sources, layout, kept)
    made = {name: _published(sources.source(name), tokenizer, layout, proof.file, measured, say) for name in names}
    entries = in_order({**with_tokenizer(kept, tokenizer), **made})
    try:
        write_manifest(layout.draft, entries, HEADING)
        for pipeline in [name for name, drift in PIPELINES.items() if drift.owner in made]:
            if missing := sorted(set(CHOICES) - set(entries) - UNUSED):
                say(f"{pipeline}: not proven, as the manifest lacks {', '.join(missing)}")
            else:
                _prove_pipeline(pipeline, entries, proof.pipeline(pipeline, layout.draft), say)
    finally:
        layout.draft.unlink(missing_ok=True)
    write_manifest(layout.manifest, entries, HEADING)
    for name in names:
        for variant in variants(name):
            layout.tidy(name, variant)
    say(f"{layout.manifest}: {len(entries)} models, {len(made)} of them exported")


def _published(source: Source, tokenizer: Entry, layout: Layout, check: Check, measured: Measured, say: Say) -> Entry:
    """The entry of a model whose files are written and proven."""
    name = source.spec.name
    _export(source, layout)
    proven = {variant: _variant(name, variant, layout, check, measured, say) for variant in variants(name)}
    tokens = dict(tokenizer) if "input_ids" in [tensor.name for tensor in source.spec.inputs] else None
    return _entry(source, proven, layout, tokens)


def _prove_pipeline(pipeline: str, entries: Mapping[str, Entry], found: Mapping[str, Figures], say: Say) -> None:
    """Check what the files make together, and note it at the model that owns the pipeline."""
    proven = entries[PIPELINES[pipeline].owner]["variants"]
    for variant, figures in found.items():
        limits = pipeline_tolerance(pipeline, variant)
        if broken := beyond(figures, limits):
            raise ValidationError(f"{pipeline} with the {variant} files: {'; '.join(broken)}")
        say(f"{pipeline}, {variant}: {_shown(figures, limits)}")
        proven[variant]["tolerance"] |= limits
        proven[variant]["parity"] |= rounded(figures)


def _export(source: Source, layout: Layout) -> None:
    name, spec = source.spec.name, source.spec
    exact = trace(source.module, spec)
    _save(with_switch(exact, spec), layout.file(name, FP32))
    _save(with_switch(halve.halve(exact), spec), layout.file(name, FP16))
    if choice := CHOICES[name]:
        _save(with_switch(quantise(exact, choice, source.calibration()), spec), layout.file(name, QUANTISED))


def _save(model: onnx.ModelProto, path: Path) -> None:
    _write(path, model.SerializeToString(deterministic=True))


def _write(path: Path, content: bytes) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f"{path.name}.part")
    temporary.write_bytes(content)
    temporary.replace(path)


def _publish_tokenizer(sources: Sources, layout: Layout, kept: Mapping[str, Entry]) -> Entry:
    """One file for all models that read text; refused where those that are kept have another."""
    path = layout.out / "tokenizer.json"
    said = [*read_captions(DEFAULT_CAPTIONS), *sentences(3000, np.random.default_rng(0))]
    content = calibration.plain_tokenizer_json(sources.tokenizer_file, said)
    check_tokenizer(kept, path, content)
    _write(path, content.encode("utf-8"))
    return {**file_entry(path, layout.root), "max_tokens": MAX_TOKENS}


def _variant(name: str, variant: str, layout: Layout, check: Check, measured: Measured, say: Say) -> Entry:
    path, limits = layout.file(name, variant), tolerance(name, variant)
    figures = rounded(check(name, variant, path, None if variant == FP32 else layout.file(name, FP32)))
    say(f"{path}: {path.stat().st_size / 1e6:.1f} MB, {_shown(figures, limits)}")
    return variant_entry(
        path,
        layout.root,
        shipped=is_shipped(name, variant),
        quantisation=_quantisation(name, variant),
        tolerance=limits,
        parity=figures,
        producers=producers(),
        benchmark=measured.of("benchmark", name, variant),
        quality=measured.of("quality", name, variant),
    )


def _shown(figures: Figures, limits: Figures) -> str:
    return ", ".join(f"{output} {key} {figures[output][key]:.3g}" for output in limits for key in limits[output])


def _quantisation(name: str, variant: str) -> str:
    if variant == FP16:
        return halve.DESCRIPTION
    choice = CHOICES[name]
    return choice.describe() if choice and variant == QUANTISED else "none"


def _entry(source: Source, proven: Mapping[str, Entry], layout: Layout, tokenizer: Entry | None) -> Entry:
    card, terms = CARDS[source.spec.name], terms_of(source)
    return model_entry(
        source.spec,
        description=card.description,
        licence=terms.licence,
        attribution=card.attribution,
        training_data=terms.training_data,
        recipe=recipe(source, layout),
        feature_statistics=card.feature_statistics,
        statistics=statistics(source, layout),
        default_variant=preferred(source.spec.name),
        variants=proven,
        quality=trained_quality(source),
        tokenizer=tokenizer,
    )
