"""ONNX against torch, in the order names, types, axes, shapes, values; the first difference ends it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import onnx
import onnxruntime as ort

from motionrt.models.sessions import switches_on
from motionrt_export.examples import Examples, Feeds
from motionrt_export.measures import Figures, beyond, measure, worst
from motionrt_export.references import Reference
from motionrt_export.specs import GraphSpec, TensorSpec

LENGTHS = (1, 7, 40, 200)
BATCHES = (1, 3, 32)
EXTRA = 13  # padding that must change nothing

Array = np.ndarray[Any, Any]
Trial = Callable[[Reference, Reference], Figures]  # the file, torch -> figures of a longer use of both
TYPES = {"float32": onnx.TensorProto.FLOAT, "int64": onnx.TensorProto.INT64, "bool": onnx.TensorProto.BOOL}


class ValidationError(Exception):
    """An exported graph is not what it must be; the message names model, check and difference."""


@dataclass(frozen=True)
class Subject:
    """What is validated against what, on which inputs, how exactly.

    `scale` are the units of an output's errors, such as the standard deviations of the features; `trial` tells what the
    errors add up to in use. `independent` rows must come out alone as in a batch, which those of dynamic int8 do not:
    their scales depend on all rows. `exact` is the float32 file that a smaller one is compared with, too.
    """

    spec: GraphSpec
    content: bytes
    reference: Reference
    examples: Examples
    tolerance: Mapping[str, Mapping[str, float]]
    scale: Mapping[str, Array]
    lengths: tuple[int, ...] = LENGTHS
    batches: tuple[int, ...] = BATCHES
    trial: Trial | None = None
    independent: bool = False
    exact: bytes | None = None

    @property
    def tried_lengths(self) -> tuple[int, ...]:
        """The lengths that are tried: one that nobody reads where the graph's own is fixed."""
        return self.lengths if self.spec.length else (1,)


def validate(subject: Subject) -> Figures:
    """The worst figures over all lengths and batches, and those of the trial; raises ValidationError."""
    check_signature(subject)
    check_inference(subject)
    session = open_session(subject.content)
    values = worst(_compare(subject, session, feeds, length) for feeds, length in _cases(subject))
    _check(subject, "values against torch", values)
    if subject.exact:
        _check(subject, "values against the float32 file", _beside(subject, session, open_session(subject.exact)))
    if subject.independent:
        rows = worst(_alone(subject, session, length) for length in subject.tried_lengths)
        _check(subject, "a row alone and in a batch", rows)
    if subject.spec.length:
        _check(subject, "padding invariance", worst(_padding(subject, session, n) for n in subject.lengths))
    if subject.trial:
        drift = subject.trial(lambda feeds: run(session, dict(feeds)), subject.reference)
        _check(subject, "drift from torch", drift)
        values |= drift
    _require_equal(subject, "figures that a tolerance is for", sorted({*subject.tolerance} - {*values}), [])
    return values


def check_signature(subject: Subject) -> None:
    """Names, types and axes as the file declares them; no input has a default."""
    graph = onnx.load_from_string(subject.content).graph
    stored = {tensor.name for tensor in graph.initializer}
    _require_equal(subject, "inputs with a default", [value.name for value in graph.input if value.name in stored], [])
    wanted_switches = [subject.spec.switch.name] if subject.spec.switch else []
    switches = [value.name for value in graph.input if value.name in wanted_switches]
    _require_equal(subject, "switches", switches, wanted_switches)
    for side, declared, wanted in (
        ("inputs", [value for value in graph.input if value.name not in switches], subject.spec.inputs),
        ("outputs", graph.output, subject.spec.outputs),
    ):
        names = [value.name for value in declared]
        _require_equal(subject, f"names of {side}", names, [tensor.name for tensor in wanted])
        for value, tensor in zip(declared, wanted, strict=True):
            kind = value.type.tensor_type
            _require_equal(subject, f"type of {tensor.name}", kind.elem_type, TYPES[tensor.dtype])
            axes = tuple(axis.dim_param or axis.dim_value for axis in kind.shape.dim)
            _require_equal(subject, f"axes of {tensor.name}", axes, tensor.shape)


def check_inference(subject: Subject) -> None:
    """ONNX's own checker, and the types and axes that it infers of every output."""
    try:
        onnx.checker.check_model(subject.content, full_check=True)
        inferred = onnx.shape_inference.infer_shapes(
            _without_outputs(subject.content), strict_mode=True, data_prop=True
        )
    except (onnx.checker.ValidationError, onnx.shape_inference.InferenceError) as error:
        raise ValidationError(f"{subject.spec.name}, ONNX's checker: {error}") from error
    for value, tensor in zip(inferred.graph.output, subject.spec.outputs, strict=True):
        kind = value.type.tensor_type
        _require_equal(subject, f"inferred type of {tensor.name}", kind.elem_type, TYPES[tensor.dtype])
        if not kind.HasField("shape"):  # behind an operator of com.microsoft, which ONNX knows nothing of
            continue
        _require_equal(subject, f"inferred axes of {tensor.name}", len(kind.shape.dim), len(tensor.shape))
        for found, wanted in zip(kind.shape.dim, tensor.shape, strict=True):
            if isinstance(wanted, int) and found.HasField("dim_value"):
                _require_equal(subject, f"inferred size of {tensor.name}", found.dim_value, wanted)


def _without_outputs(content: bytes) -> onnx.ModelProto:
    """The graph with its outputs' shapes forgotten, so that they are inferred and not repeated."""
    model = onnx.load_from_string(content)
    for value in model.graph.output:
        value.type.tensor_type.ClearField("shape")
    return model


def open_session(content: bytes) -> ort.InferenceSession:
    """One thread, so that the same machine always finds the same figures."""
    options = ort.SessionOptions()
    options.intra_op_num_threads, options.inter_op_num_threads, options.log_severity_level = 1, 1, 3
    return ort.InferenceSession(content, options, providers=["CPUExecutionProvider"])


def run(session: ort.InferenceSession, feeds: Feeds) -> dict[str, Array]:
    """All outputs by name; switches that are not given are on."""
    names = [output.name for output in session.get_outputs()]
    return dict(zip(names, session.run(names, {**switches_on(session), **feeds}), strict=True))


def _cases(subject: Subject) -> Iterator[tuple[Feeds, int]]:
    """Every length and batch; in a batch the rows are valid for all, half, a third, a quarter of it."""
    for length in subject.tried_lengths:
        for batch in subject.batches:
            feeds = subject.examples(batch, length, seed=1000 * length + batch)
            if subject.spec.mask:
                for row, valid in enumerate(feeds[subject.spec.mask]):
                    valid[max(1, length // (1 + row % 4)) :] = 0
            yield feeds, length


def _compare(subject: Subject, session: ort.InferenceSession, feeds: Feeds, length: int) -> Figures:
    found, expected = run(session, feeds), subject.reference(feeds)
    batch = len(feeds[subject.spec.inputs[0].name])
    for tensor in subject.spec.outputs:
        shape = tensor.resolved(subject.spec.sizes(batch, length))
        _require_equal(subject, f"shape of {tensor.name}", found[tensor.name].shape, shape)
        _require_equal(subject, f"type of {tensor.name}", found[tensor.name].dtype.name, tensor.dtype)
    return _figures(subject, found, expected, feeds)


def _beside(subject: Subject, session: ort.InferenceSession, exact: ort.InferenceSession) -> Figures:
    """Another file of the same graph in place of torch."""
    return worst(_figures(subject, run(session, f), run(exact, f), f) for f, _ in _cases(subject))


def _alone(subject: Subject, session: ort.InferenceSession, length: int) -> Figures:
    """Rows of the largest batch, and each of them alone."""
    feeds = subject.examples(max(subject.batches), length, seed=length + 1)
    together = run(session, feeds)

    def row(index: int) -> Figures:
        one = {name: value[index : index + 1] for name, value in feeds.items()}
        mine = {name: value[index : index + 1] for name, value in together.items()}
        return _figures(subject, mine, run(session, one), one)

    return worst(row(index) for index in (0, max(subject.batches) - 1))


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
    valid = feeds[subject.spec.mask].astype(bool) if subject.spec.mask else None
    result = {}
    for tensor in subject.spec.outputs:
        rows = valid if subject.spec.length in tensor.shape else None
        scale = subject.scale.get(tensor.name)
        result[tensor.name] = measure(found[tensor.name], expected[tensor.name], rows, scale)
    return result


def _check(subject: Subject, check: str, figures: Figures) -> None:
    limits = {name: values for name, values in subject.tolerance.items() if name in figures}
    _require(subject, check, beyond(figures, limits))


def _require_equal(subject: Subject, check: str, found: object, wanted: object) -> None:
    if found != wanted:
        _require(subject, check, [f"found {found}, expected {wanted}"])


def _require(subject: Subject, check: str, broken: list[str]) -> None:
    if broken:
        raise ValidationError(f"{subject.spec.name}, {check}: {'; '.join(broken)}")
