"""The manifest as it is written: plain mappings in a fixed order, so equal models give equal bytes."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import onnx
import yaml

from motionrt_export.specs import GraphSpec, TensorSpec

SCHEMA = 1
SCHEMA_LINE = "yaml-language-server: $schema=runtime/motionrt/_assets/models_manifest.schema.json"

Entry = dict[str, Any]


def tensor_entry(tensor: TensorSpec) -> Entry:
    """An input or output."""
    return {
        "name": tensor.name,
        "dtype": tensor.dtype,
        "shape": list(tensor.shape),
        "unit": tensor.unit,
        "meaning": tensor.meaning,
    }


def file_entry(path: Path, root: Path) -> Entry:
    """Name (relative to the manifest), checksum and size of a file."""
    content = path.read_bytes()
    return {
        "file": path.relative_to(root).as_posix(),
        "sha256": hashlib.sha256(content).hexdigest(),
        "bytes": len(content),
    }


def variant_entry(
    path: Path,
    root: Path,
    *,
    shipped: bool,
    quantisation: str,
    tolerance: Mapping[str, Mapping[str, float]],
    parity: Mapping[str, Mapping[str, float]],
    producers: Mapping[str, str],
    benchmark: Mapping[str, str | float] | None = None,
    quality: Mapping[str, float] | None = None,
) -> Entry:
    """One ONNX file of a model."""
    model = onnx.load(path, load_external_data=False)
    opset = next(entry.version for entry in model.opset_import if entry.domain in ("", "ai.onnx"))
    return {
        **file_entry(path, root),
        "opset": opset,
        "ir_version": model.ir_version,
        "shipped": shipped,
        "quantisation": quantisation,
        "tolerance": {name: dict(values) for name, values in tolerance.items()},
        "parity": {name: dict(values) for name, values in parity.items()},
        "producers": dict(producers),
        **({"benchmark": dict(benchmark)} if benchmark else {}),
        **({"quality": dict(quality)} if quality else {}),
    }


def statistic_entry(name: str, values: np.ndarray, source: str) -> Entry:
    """An array about the training data, which lies inside the graph."""
    content = np.ascontiguousarray(values, "<f4").tobytes()
    sha256 = hashlib.sha256(content).hexdigest()
    return {"name": name, "shape": list(values.shape), "sha256": sha256, "source": source}


def model_entry(
    spec: GraphSpec,
    *,
    description: str,
    licence: str,
    attribution: str,
    training_data: Sequence[tuple[str, str]],
    recipe: Mapping[str, str | int | float],
    feature_statistics: str,
    default_variant: str,
    variants: Mapping[str, Entry],
    quality: Mapping[str, str | int | float],
    tokenizer: Entry | None = None,
    statistics: Sequence[Entry] = (),
) -> Entry:
    """A model with its variants; `training_data` holds (name, licence) pairs."""
    return {
        "description": description,
        "licence": licence,
        "attribution": attribution,
        "training_data": [{"name": name, "licence": terms} for name, terms in training_data],
        "recipe": dict(recipe),
        "feature_statistics": feature_statistics,
        **({"statistics": list(statistics)} if statistics else {}),
        "inputs": [tensor_entry(tensor) for tensor in spec.taken],
        "outputs": [tensor_entry(tensor) for tensor in spec.outputs],
        **({} if tokenizer is None else {"tokenizer": tokenizer}),
        "default_variant": default_variant,
        "variants": dict(variants),
        "quality": dict(quality),
    }


def write_manifest(path: Path, models: Mapping[str, Entry], heading: str) -> None:
    """Write `models` under a comment, which tells editors of the schema, line feeds only."""
    text = yaml.safe_dump(
        {"schema": SCHEMA, "models": dict(models)},
        sort_keys=False,
        allow_unicode=True,
        width=110,
        default_flow_style=None,
    )
    comment = "".join(f"# {line}\n" for line in (SCHEMA_LINE, *heading.splitlines()))
    path.write_bytes((comment + text).encode("utf-8"))
