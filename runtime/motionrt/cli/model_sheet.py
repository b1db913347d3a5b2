"""What the manifest says of one model, for people and for programs."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from motionrt.models import Model, TensorInfo, Variant

WIDTH = 110
NONE = "-"


def sheet(model: Model, variants: Sequence[Variant]) -> str:
    """Everything about a model and some of its variants, as lines of text."""
    lines = [f"{model.name}: {model.description}", ""]
    lines += _told("licence", [model.licence])
    lines += _told("attribution", [model.attribution])
    lines += _told("training data", [f"{data.name} ({data.licence})" for data in model.training_data])
    lines += _told("recipe", _pairs(model.recipe))
    lines += _told("statistics", [model.feature_statistics])
    lines += _told("", [f"{s.name} {_shape(s.shape)}, in {s.source}, sha256 {s.sha256}" for s in model.statistics])
    if model.tokenizer is not None:
        lines += _told("tokenizer", [f"{model.tokenizer.file}, at most {model.tokenizer.max_tokens} tokens"])
    lines += _told("quality", _pairs(model.quality) or [NONE])
    lines += ["", *_tensors("input", model.inputs), "", *_tensors("output", model.outputs)]
    for variant in variants:
        lines += ["", *_variant(model, variant)]
    return "\n".join(line.rstrip() for line in lines)


def as_json(model: Model, variants: Sequence[Variant]) -> dict[str, Any]:
    """The same in plain values, with the fields of the manifest."""
    return asdict(model) | {"variants": {variant.name: asdict(variant) for variant in variants}}


def _variant(model: Model, variant: Variant) -> Iterator[str]:
    notes = ["taken by default"] if variant.name == model.default_variant else []
    notes += [] if variant.shipped else ["not shipped: python -m motionrt_export all"]
    yield f"variant {variant.name}{' (' + '; '.join(notes) + ')' if notes else ''}"
    yield from _told("file", [f"{variant.file}, {variant.bytes:,} bytes", f"sha256 {variant.sha256}"])
    yield from _told(
        "format", [f"ONNX opset {variant.opset}, IR version {variant.ir_version}", *_pairs(variant.producers)]
    )
    yield from _told("weights", ["float32" if variant.quantisation == "none" else variant.quantisation])
    yield from _told("quality", _pairs(variant.quality) or [NONE])
    yield from _told("benchmark", _pairs(variant.benchmark or {}) or [NONE])
    yield from _columns(["  against torch", "measure", "promised", "found"], list(_exactness(variant)), "<<>>")


def _exactness(variant: Variant) -> Iterator[list[str]]:
    """Every measure that was found, beside what is promised of it."""
    for output, found in variant.parity.items():
        promised = variant.tolerance.get(output, {})
        for measure, value in found.items():
            limit = promised.get(measure)
            sign = ">=" if measure.endswith("_min") else "<="
            yield [f"  {output}", measure, NONE if limit is None else f"{sign} {limit:g}", f"{value:g}"]


def _tensors(kind: str, tensors: Sequence[TensorInfo]) -> list[str]:
    rows = [[tensor.name, tensor.dtype, _shape(tensor.shape), tensor.unit, tensor.meaning] for tensor in tensors]
    return _columns([kind, "type", "shape", "unit", "meaning"], rows, "<<<<<")


def _columns(head: list[str], rows: list[list[str]], align: str) -> list[str]:
    widths = [max(map(len, column)) for column in zip(head, *rows, strict=True)]
    return [
        "  ".join(f"{cell:{side}{width}}" for cell, side, width in zip(row, align, widths, strict=True))
        for row in (head, *rows)
    ]


def _told(name: str, texts: Iterable[str]) -> list[str]:
    """A name and what is to be said, in lines of a readable width."""
    lines = [line for text in texts for line in textwrap.wrap(text, WIDTH, break_long_words=False)]
    return [f"  {name if i == 0 else '':<15}{line}" for i, line in enumerate(lines)]


def _pairs(values: Mapping[str, object]) -> list[str]:
    return [f"{name}: {value}" for name, value in values.items()]


def _shape(shape: Sequence[int | str]) -> str:
    return f"({', '.join(map(str, shape))})"
