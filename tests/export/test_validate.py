"""Validation passes what is right and ends at the first thing that is not, in its order."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")
onnx = pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")

from onnx import TensorProto, numpy_helper  # noqa: E402
from tiny_nets import tiny_minilm, tiny_sources, tiny_tmr  # noqa: E402

from motionrt_export.branch import with_switch  # noqa: E402
from motionrt_export.halve import halve  # noqa: E402
from motionrt_export.optimise import CHOICES, quantise, variants  # noqa: E402
from motionrt_export.specs import TMR_TEXT  # noqa: E402
from motionrt_export.tolerances import tolerance  # noqa: E402
from motionrt_export.trace import trace  # noqa: E402
from motionrt_export.validate import Subject, ValidationError, validate  # noqa: E402

SMALL = {"lengths": (1, 7, 20), "batches": (1, 3)}


@pytest.fixture(scope="module")
def sources(tmp_path_factory: pytest.TempPathFactory):
    return tiny_sources(tmp_path_factory.mktemp("checkpoints"))


def subject(sources, name: str, variant: str = "fp32") -> Subject:
    source = sources.source(name)
    model = trace(source.module, source.spec)
    rest = {**SMALL, "trial": source.trial, "independent": variant != "int8"}
    if variant != "fp32":
        rest["exact"] = with_switch(model, source.spec).SerializeToString(deterministic=True)
    choice = CHOICES[name]
    if variant == "int8" and choice:
        model = quantise(model, choice, source.calibration())
    elif variant == "fp16":
        model = halve(model)
    content = with_switch(model, source.spec).SerializeToString(deterministic=True)
    limits = tolerance(name, variant)
    return Subject(source.spec, content, source.reference, source.examples, limits, source.scale, **rest)


def altered(subject: Subject, change: Callable[[onnx.ModelProto], object]) -> Subject:
    model = onnx.load_from_string(subject.content)
    change(model)
    return dataclasses.replace(subject, content=model.SerializeToString())


@pytest.fixture(scope="module")
def text(sources) -> Subject:
    return subject(sources, "tmr_text")


@pytest.mark.parametrize(("name", "variant"), [(name, variant) for name in CHOICES for variant in variants(name)])
def test_an_honest_export_passes(sources, name: str, variant: str) -> None:
    figures = validate(subject(sources, name, variant))
    assert set(figures) >= {tensor.name for tensor in sources.source(name).spec.outputs}
    assert set(figures) >= set(tolerance(name, variant))


def test_texts_are_tried_up_to_the_longest(sources) -> None:
    student = dataclasses.replace(subject(sources, "tmr_student"), lengths=(1, 120, 200), batches=(1,))
    assert student.tried_lengths == (1, 120, 128)
    assert validate(student)["embedding"]["max_abs_error"] <= 1e-4


def test_a_corrupted_weight_fails_with_the_figure(text: Subject) -> None:
    def corrupt(model: onnx.ModelProto) -> None:
        tensor = next(t for t in model.graph.initializer if tuple(t.dims) == (384, 1152))
        value = numpy_helper.to_array(tensor).copy()
        value[5, 7] += 0.5
        tensor.CopyFrom(numpy_helper.from_array(value, tensor.name))

    with pytest.raises(
        ValidationError, match=r"tmr_text, values against torch: .*token_features: max_abs_error is .* at most"
    ):
        validate(altered(text, corrupt))


def test_a_renamed_output_fails_at_the_names(text: Subject) -> None:
    def rename(model: onnx.ModelProto) -> None:
        model.graph.output[1].name = "code"

    with pytest.raises(ValidationError, match=r"names of outputs: found \['embedding', 'code', "):
        validate(altered(text, rename))


def test_another_type_fails_at_the_types(text: Subject) -> None:
    def retype(model: onnx.ModelProto) -> None:
        model.graph.input[1].type.tensor_type.elem_type = TensorProto.INT32

    with pytest.raises(ValidationError, match="type of attention_mask"):
        validate(altered(text, retype))


def test_a_fixed_length_fails_at_the_axes(text: Subject) -> None:
    def fix(model: onnx.ModelProto) -> None:
        model.graph.input[0].type.tensor_type.shape.dim[1].dim_value = 9

    with pytest.raises(ValidationError, match=r"axes of input_ids: found \('batch', 9\)"):
        validate(altered(text, fix))


def test_a_tolerance_that_nothing_was_measured_for_fails(text: Subject) -> None:
    limits = {**text.tolerance, "walk": {"height_cm": 1.0}}
    with pytest.raises(ValidationError, match=r"figures that a tolerance is for: found \['walk'\]"):
        validate(dataclasses.replace(text, tolerance=limits))


class IgnoresItsMask(torch.nn.Module):
    """Right on everything but padding."""

    def forward(self, input_ids: torch.Tensor, attention_mask: torch.Tensor):
        features = (input_ids[..., None] * torch.arange(1.0, 385.0)).sin() * attention_mask[..., None]
        latent = input_ids.sum(dim=1)[:, None] * torch.ones(256)
        return latent / latent.norm(dim=-1, keepdim=True) + latent, latent, features, features.sum(dim=1)


def test_a_graph_that_reads_padding_fails_though_its_values_are_right(text: Subject) -> None:
    module = IgnoresItsMask()

    def reference(feeds):
        outputs = module(*(torch.from_numpy(feeds[t.name]) for t in TMR_TEXT.inputs))
        return dict(zip((t.name for t in TMR_TEXT.outputs), (x.numpy() for x in outputs), strict=True))

    content = with_switch(trace(module, TMR_TEXT), TMR_TEXT).SerializeToString()
    wrong = dataclasses.replace(text, content=content, reference=reference)
    with pytest.raises(ValidationError, match="tmr_text, padding invariance: embedding"):
        validate(wrong)


def test_the_torch_modules_pass_through_untouched(text: Subject) -> None:
    """The export wrappers must not change the network that they wrap."""
    model = tiny_tmr()
    before = {name: value.clone() for name, value in model.state_dict().items()}
    from motionrt_export.graphs import DecoderGraph, MotionEncoderGraph, TextGraph

    TextGraph(tiny_minilm(), model)
    for graph in (MotionEncoderGraph, DecoderGraph):
        graph(model)
    assert all(torch.equal(value, before[name]) for name, value in model.state_dict().items())


def test_figures_are_the_same_twice(text: Subject) -> None:
    assert validate(text) == validate(text)
    assert np.isfinite(validate(text)["embedding"]["cosine_min"])


def test_a_graph_that_the_checker_refuses_fails_before_it_is_opened(text: Subject) -> None:
    def undo(model: onnx.ModelProto) -> None:
        model.graph.node[0].input[0] = "nobody makes this"

    with pytest.raises(ValidationError, match=r"tmr_text, ONNX's checker: .*nobody makes this"):
        validate(altered(text, undo))


def test_an_output_that_is_wider_than_declared_fails_at_the_inferred_axes(text: Subject) -> None:
    def widen(model: onnx.ModelProto) -> None:
        made = next(node for node in model.graph.node if "latent" in node.output)
        made.output[list(made.output).index("latent")] = "narrow"
        for node in model.graph.node:
            node.input[:] = ["narrow" if name == "latent" else name for name in node.input]
        model.graph.node.append(onnx.helper.make_node("Concat", ["narrow", "narrow"], ["latent"], axis=1))

    with pytest.raises(ValidationError, match=r"checker|inferred size of latent: found 512, expected 256"):
        validate(altered(text, widen))


def test_rows_that_disturb_each_other_are_found(sources) -> None:
    """Every row gets a little of the mean of all, which the comparison with torch cannot see in rows that are alike."""
    source = sources.source("pose_prior")
    honest = subject(sources, "pose_prior")

    def mixed(feeds):
        return source.reference({"latent": feeds["latent"] + 0.05 * feeds["latent"].mean(axis=0)})

    def mix(model: onnx.ModelProto) -> None:
        first = next(node for node in model.graph.node if "latent" in node.input)
        first.input[list(first.input).index("latent")] = "mixed"
        nodes = [
            onnx.helper.make_node("ReduceMean", ["latent", "first_axis"], ["mean_row"], keepdims=1),
            onnx.helper.make_node("Mul", ["mean_row", "share"], ["some"]),
            onnx.helper.make_node("Add", ["latent", "some"], ["mixed"]),
        ]
        rest = [onnx.NodeProto.FromString(node.SerializeToString()) for node in model.graph.node]
        del model.graph.node[:]
        model.graph.node.extend([*nodes, *rest])
        constants = {"first_axis": np.array([0], np.int64), "share": np.array(0.05, np.float32)}
        model.graph.initializer.extend(numpy_helper.from_array(value, name) for name, value in constants.items())

    bad = dataclasses.replace(altered(honest, mix), reference=mixed)
    with pytest.raises(ValidationError, match="pose_prior, a row alone and in a batch: rotations"):
        validate(bad)
    validate(dataclasses.replace(bad, independent=False))


def test_a_smaller_file_is_compared_with_the_exact_one_too(sources, text: Subject) -> None:
    other = altered(text, lambda model: None)
    model = onnx.load_from_string(text.content)
    tensor = next(t for t in model.graph.initializer if tuple(t.dims) == (384, 1152))
    tensor.CopyFrom(numpy_helper.from_array(numpy_helper.to_array(tensor) * 1.1, tensor.name))
    with pytest.raises(ValidationError, match="values against the float32 file: "):
        validate(dataclasses.replace(other, exact=model.SerializeToString()))
