"""Files for engines: standard operators of opset 15 alone, no branches, large weights stored as float16.

`index.json` beside the files names for each its inputs, outputs, operators, errors against torch, and the engines of
:mod:`motionrt_export.targets` that open it.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Collection, Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import onnx

from motionrt.errors import InvalidInputError
from motionrt_export.halve import DESCRIPTION, halve
from motionrt_export.measures import Figures, rounded
from motionrt_export.optimise import CHOICES, FP16, NOT_SHIPPED
from motionrt_export.sources import Source, Sources
from motionrt_export.specs import GraphSpec
from motionrt_export.targets import operators, targets
from motionrt_export.tolerances import tolerance
from motionrt_export.trace import trace
from motionrt_export.validate import Subject, ValidationError, validate

OPSET, IR_VERSION = 15, 8
INDEX = "index.json"
MODELS = tuple(name for name in CHOICES if name not in NOT_SHIPPED)
LENGTHS, BATCHES = (1, 40, 200), (1, 3)


def portable(source: Source) -> onnx.ModelProto:
    """The graph of a source, for engines."""
    model = halve(trace(source.module, plain(source.spec), opset=OPSET))
    model.ir_version = IR_VERSION
    return model


def plain(spec: GraphSpec) -> GraphSpec:
    """A signature without its switch, which would be a branch: all outputs are always computed."""
    return replace(spec, switch=None)


def build(sources: Sources, out: Path, say: Callable[[str], None], only: Collection[str] | None = None) -> Path:
    """Write ``MODEL.portable.onnx`` for every model and the index; gives the index.

    Raises:
        InvalidInputError: `only` names a model that there is not.
        MissingCheckpointsError: before anything is written.
        ValidationError: a file is beyond the tolerance of its float16 variant, or an engine of the lists refuses it.
    """
    names = MODELS if only is None else tuple(name for name in MODELS if name in only)
    if only is not None and (unknown := sorted({*only} - {*MODELS})):
        raise InvalidInputError(f"no model {', '.join(unknown)}; choose from: {', '.join(MODELS)}")
    sources.check(names)
    out.mkdir(parents=True, exist_ok=True)
    entries = {name: _built(sources.source(name), out, say) for name in names}
    index = out / INDEX
    index.write_text(json.dumps({"version": 1, "models": entries}, indent=1) + "\n", encoding="utf-8")
    return index


def prove(source: Source, content: bytes) -> Figures:
    """Worst errors of a file against torch, within the tolerance of the float16 variant; raises ValidationError."""
    spec = plain(source.spec)
    outputs = {tensor.name for tensor in spec.outputs}
    limits = {name: values for name, values in tolerance(spec.name, FP16).items() if name in outputs}
    subject = Subject(spec, content, source.reference, source.examples, limits, source.scale, LENGTHS, BATCHES)
    return validate(subject)


def engines(model: onnx.ModelProto, name: str) -> dict[str, list[str]]:
    """Engine -> operators that it leaves to another device; ValidationError where one refuses the model."""
    refusals = {target.name: target.refuses(model) for target in targets().values()}
    if broken := [f"{engine}: {', '.join(why)}" for engine, why in refusals.items() if why]:
        raise ValidationError(f"{name} does not open in {'; '.join(broken)}")
    return {target.name: target.outside(model) for target in targets().values()}


def table(index: Path) -> str:
    """The index as a Markdown table of sizes and errors."""
    found: Mapping[str, Any] = json.loads(index.read_text(encoding="utf-8"))["models"]
    rows = ["| model | MB | largest error against torch | operators |", "|---|---:|---|---:|"]
    for name, entry in found.items():
        errors = ", ".join(f"`{output}` {each['max_abs_error']:.1e}" for output, each in entry["parity"].items())
        rows.append(f"| `{name}` | {entry['bytes'] / 1e6:.1f} | {errors} | {len(entry['operators'])} |")
    return "\n".join(rows)


def _built(source: Source, out: Path, say: Callable[[str], None]) -> dict[str, Any]:
    name, model = source.spec.name, portable(source)
    content = model.SerializeToString(deterministic=True)
    opened, figures = engines(model, name), rounded(prove(source, content))
    path = out / f"{name}.portable.onnx"
    path.write_bytes(content)
    say(f"{path}: {len(content) / 1e6:.1f} MB, within its tolerance")
    return {
        "file": path.name,
        "sha256": hashlib.sha256(content).hexdigest(),
        "bytes": len(content),
        "opset": OPSET,
        "weights": DESCRIPTION,
        "inputs": [_described(tensor) for tensor in source.spec.inputs],
        "outputs": [_described(tensor) for tensor in source.spec.outputs],
        "operators": sorted(operator for _, operator in operators(model)),
        "elsewhere": opened,
        "parity": figures,
    }


def _described(tensor: Any) -> dict[str, Any]:
    return {key: value for key, value in asdict(tensor).items() if key != "below"}
