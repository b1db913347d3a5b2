"""ONNX against torch, in the order names, types, axes, shapes, values; the first difference ends it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import onnx
import onnxruntime as ort

from motionrt_export.examples import Examples, Feeds
from motionrt_export.measures import Figures, beyond, measure, worst
from motionrt_export.references import Reference
from motionrt_export.specs import GraphSpec, TensorSpec

LENGTHS = (1, 7, 40, 200)
BATCHES = (1, 3, 32)
EXTRA = 13  # padding that must change nothing

Array = np.ndarray[Any, Any]
TYPES = {"float32": onnx.TensorProto.FLOAT, "int64": onnx.TensorProto.INT64, "bool": onnx.TensorProto.BOOL}


class ValidationError(Exception):
    """An exported graph is not what it must be; the message names model, check and difference."""


@dataclass(frozen=True)
class Subject:
    """What is validated against what, on which inputs, how exactly.

    `scale` are the units of an output's errors, such as the standard deviations of the features.
    """

    spec: GraphSpec
    content: bytes
    reference: Reference
    examples: Examples
    tolerance: Mapping[str, Mapping[str, float]]
    scale: Mapping[str, Array]
    lengths: tuple[int, ...] = LENGTHS
    batches: tuple[int, ...] = BATCHES


def validate(subject: Subject) -> Figures:
    """The worst figures over all lengths and batches; raises ValidationError."""
    check_signature(subject)
    session = open_session(subject.content)
    values = worst(_compare(subject, session, feeds) for feeds in _cases(subject))
    _require(subject, "values against torch", beyond(values, subject.tolerance))
    padding = worst(_padding(subject, session, length) for length in subject.lengths)
    _require(subject, "padding invariance", beyond(padding, subject.tolerance))
    return values


def check_signature(subject: Subject) -> None:
    """Names, types and axes as the file declares them."""
    graph = onnx.load_from_string(subject.content).graph
    for side, declared, wanted in (
        ("inputs", graph.input, subject.spec.inputs),
        ("outputs", graph.output, subject.spec.outputs),
    ):
        names = [value.name for value in declared]
        _require_equal(subject, f"names of {side}", names, [tensor.name for tensor in wanted])
        for value, tensor in zip(declared, wanted, strict=True):
            kind = value.type.tensor_type
            _require_equal(subject, f"type of {tensor.name}", kind.elem_type, TYPES[tensor.dtype])
            axes = tuple(axis.dim_param or axis.dim_value for axis in kind.shape.dim)
            _require_equal(subject, f"axes of {tensor.name}", axes, tensor.shape)


def open_session(content: bytes) -> ort.InferenceSession:
    """One thread, so that the same machine always finds the same figures."""
    options = ort.SessionOptions()
    options.intra_op_num_threads, options.inter_op_num_threads, options.log_severity_level = 1, 1, 3
    return ort.InferenceSession(content, options, providers=["CPUExecutionProvider"])


def run(session: ort.InferenceSession, feeds: Feeds) -> dict[str, Array]:
    """All outputs by name."""
    names = [output.name for output in session.get_outputs()]
    return dict(zip(names, session.run(names, feeds), strict=True))


def _cases(subject: Subject) -> Iterator[Feeds]:
    """Every length and batch; in a batch the rows are valid for all, half, a third, a quarter of it."""
    for length in subject.lengths:
        for batch in subject.batches:
            feeds = subject.examples(batch, length, seed=1000 * length + batch)
            mask = feeds[subject.spec.mask]
            for row in range(batch):
                mask[row, max(1, length // (1 + row % 4)) :] = 0
            yield feeds


def _compare(subject: Subject, session: ort.InferenceSession, feeds: Feeds) -> Figures:
    found, expected = run(session, feeds), subject.reference(feeds)
    for tensor in subject.spec.outputs:
        mask = feeds[subject.spec.mask]
        shape = tensor.resolved({"batch": mask.shape[0], subject.spec.length: mask.shape[1]})
        _require_equal(subject, f"shape of {tensor.name}", found[tensor.name].shape, shape)
        _require_equal(subject, f"type of {tensor.name}", found[tensor.name].dtype.name, tensor.dtype)
    return _figures(subject, found, expected, feeds)


def _padding(subject: Subject, session: ort.InferenceSession, length: int) -> Figures:
    """One row alone, and the same row with rubbish behind its end."""
    feeds = subject.examples(1, length, seed=length)
    padded = {tensor.name: _padded(tensor, feeds[tensor.name], subject.spec) for tensor in subject.spec.inputs}
    alone, beside = run(session, feeds), run(session, padded)
    for tensor in subject.spec.outputs:
        if subject.spec.length in tensor.shape:
            beside[tensor.name] = beside[tensor.name][:, :length]
    return _figures(subject, beside, alone, feeds)


def _padded(tensor: TensorSpec, value: Array, spec: GraphSpec) -> Array:
    if spec.length not in tensor.shape:
        return value
    fill = 0 if tensor.name == spec.mask else 5
    widths = [(0, EXTRA) if axis == spec.length else (0, 0) for axis in tensor.shape]
    return np.pad(value, widths, constant_values=fill)


def _figures(subject: Subject, found: dict[str, Array], expected: dict[str, Array], feeds: Feeds) -> Figures:
    valid = feeds[subject.spec.mask].astype(bool)
    result = {}
    for tensor in subject.spec.outputs:
        rows = valid if subject.spec.length in tensor.shape else None
        scale = subject.scale.get(tensor.name)
        result[tensor.name] = measure(found[tensor.name], expected[tensor.name], rows, scale)
    return result


def _require_equal(subject: Subject, check: str, found: object, wanted: object) -> None:
    if found != wanted:
        _require(subject, check, [f"found {found}, expected {wanted}"])


def _require(subject: Subject, check: str, broken: list[str]) -> None:
    if broken:
        raise ValidationError(f"{subject.spec.name}, {check}: {'; '.join(broken)}")
