"""A torch module -> a clean ONNX model: right names, dynamic axes, nothing of this machine."""

from __future__ import annotations

import io
import warnings
from collections.abc import Mapping

import onnx
import torch
from torch import nn

from motionrt_export.examples import random_examples
from motionrt_export.simplify import simplify
from motionrt_export.specs import OPSET, GraphSpec

IR_VERSION = 10


def trace(
    module: nn.Module, spec: GraphSpec, *, batch: int = 2, length: int = 9, opset: int = OPSET
) -> onnx.ModelProto:
    """Export with the TorchScript exporter, whose graphs run 5 to 10 % faster than the dynamo exporter's."""
    feeds = random_examples(spec)(batch, length, 0)
    buffer = io.BytesIO()
    with warnings.catch_warnings(), torch.no_grad():
        warnings.simplefilter("ignore")
        torch.onnx.export(
            module.eval(),
            tuple(torch.from_numpy(feeds[tensor.name]) for tensor in spec.inputs),
            buffer,
            dynamo=False,
            opset_version=opset,
            input_names=[tensor.name for tensor in spec.inputs],
            output_names=[tensor.name for tensor in spec.outputs],
            dynamic_axes=spec.dynamic_axes(),
        )
    return cleaned(onnx.load_from_string(buffer.getvalue()), spec)


def cleaned(model: onnx.ModelProto, spec: GraphSpec) -> onnx.ModelProto:
    """Drop documentation strings and shapes of inner tensors; name the producer and the graph."""
    model.ir_version = IR_VERSION
    model.producer_name, model.producer_version = "motionrt_export", ""
    model.graph.name, model.graph.doc_string = spec.name, ""
    del model.metadata_props[:], model.graph.value_info[:]
    for node in model.graph.node:
        node.doc_string = ""
        del node.metadata_props[:]
    _set_shapes(model, spec)
    simplify(model)
    return model


def _set_shapes(model: onnx.ModelProto, spec: GraphSpec) -> None:
    wanted: Mapping[str, tuple[int | str, ...]] = {t.name: t.shape for t in (*spec.inputs, *spec.outputs)}
    for value in (*model.graph.input, *model.graph.output):
        shape = value.type.tensor_type.shape
        shape.ClearField("dim")
        for axis in wanted[value.name]:
            shape.dim.add(**({"dim_param": axis} if isinstance(axis, str) else {"dim_value": axis}))
