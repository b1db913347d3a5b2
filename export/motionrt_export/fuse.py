"""What onnxruntime makes of a graph when it opens it, made once: files open in less than half the time."""

from __future__ import annotations

import tempfile
from pathlib import Path

import onnx
import onnxruntime as ort

NEWER = frozenset({"weight_prepacked"})
"""Attributes that say the default, and that the oldest onnxruntime which the files are for does not know."""


def fused(model: onnx.ModelProto) -> onnx.ModelProto:
    """The graph with operators fused, constants folded and what is computed twice computed once.

    Only with fusions that hold on every CPU; those of this machine's are left to the machine that opens the file.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "fused.onnx"
        options = ort.SessionOptions()
        options.graph_optimization_level = ort.GraphOptimizationLevel.ORT_ENABLE_EXTENDED
        options.intra_op_num_threads, options.inter_op_num_threads, options.log_severity_level = 1, 1, 3
        options.optimized_model_filepath = str(path)
        ort.InferenceSession(model.SerializeToString(), options, providers=["CPUExecutionProvider"])
        result = onnx.load(path)
    return _as_before(result, model)


def _as_before(result: onnx.ModelProto, model: onnx.ModelProto) -> onnx.ModelProto:
    """Take over what onnxruntime has no say in: versions, names of the producer and of the graph, inputs, outputs."""
    used = {node.domain for node in result.graph.node}
    opsets = [opset for opset in result.opset_import if opset.domain in used]
    del result.opset_import[:], result.metadata_props[:], result.graph.value_info[:]
    result.opset_import.extend(onnx.OperatorSetIdProto.FromString(opset.SerializeToString()) for opset in opsets)
    result.ir_version = model.ir_version
    result.producer_name, result.producer_version = model.producer_name, model.producer_version
    result.graph.name, result.graph.doc_string = model.graph.name, ""
    for node in result.graph.node:
        for attribute in [each for each in node.attribute if each.name in NEWER and each.i == 0]:
            node.attribute.remove(attribute)
    for field in ("input", "output"):
        result.graph.ClearField(field)
        getattr(result.graph, field).extend(getattr(model.graph, field))
    return result
