"""The step decoder of TEMOS as it is exported: one step, what follows the last one, and the loop around the step."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import onnx
import onnx.compose
import torch
import torch.nn.functional as F
from onnx import NodeProto, TensorProto, helper, numpy_helper
from torch import Tensor, nn

from motionrt_export.layers import constant, linear
from motionrt_export.specs import TEMOS_DECODER, GraphSpec, TensorSpec
from motionrt_export.trace import trace
from motionrt_training.networks.egocentric import RATES, WIDTH, from_egocentric
from motionrt_training.networks.temos import AHEAD, CLOCK, HISTORY, LONGEST, StepDecoder, Temos

_FRAMES = TensorSpec("frames", "float32", ("batch", "frames", WIDTH), "1", "normalised egocentric frames")
_STATE = ("batch", HISTORY, WIDTH)
STEP = GraphSpec(
    "step",
    (
        TEMOS_DECODER.inputs[0],
        TensorSpec("history", "float32", _STATE, "1", "the last frames, zeros before the first"),
        TensorSpec("time", "float32", (1,), "1", "frames since the start"),
    ),
    (
        TensorSpec("added", "float32", ("batch", AHEAD, WIDTH), "1", "the next frames"),
        TensorSpec("history_after", "float32", _STATE, "1", "the last frames with them"),
    ),
)
TAIL = GraphSpec("tail", (_FRAMES, TEMOS_DECODER.inputs[1]), TEMOS_DECODER.outputs, "frames")


class StepGraph(nn.Module):
    """`StepDecoder.step` and the history after it. Unknown frames are zeros, so that nothing has to hide them."""

    def __init__(self, source: StepDecoder) -> None:
        super().__init__()
        width = HISTORY * WIDTH
        self.enter = linear(source.enter.weight[:, :width], None)
        self.clock = linear(source.enter.weight[:, width:], source.enter.bias)
        self.ff, layers = source.enter.out_features, len(source.up)
        one = torch.tensor([1.0, 0.0]).repeat_interleave(self.ff).repeat(layers)  # scales are counted from 1
        self.shape = linear(source.shape.weight, source.shape.bias + one)
        self.norms, self.up, self.down, self.project = source.norms, source.up, source.down, source.project
        self.before = constant(torch.arange(-HISTORY, 0).float())
        self.waves = constant(torch.arange(1, CLOCK + 1) * (math.pi / LONGEST))

    def forward(self, latent: Tensor, history: Tensor, time: Tensor) -> tuple[Tensor, Tensor]:
        """(B, 256), (B, 16, 136), (1,) -> (B, 8, 136), (B, 16, 136)."""
        shapes = self.shape(latent[:, None]).split(self.ff, dim=-1)
        known, wave = (time + self.before >= 0).float(), time * self.waves
        clock = self.clock(torch.cat((known, wave.sin(), wave.cos()))[None, None])
        x = self.enter(history.reshape(history.shape[0], 1, HISTORY * WIDTH)) + clock
        for index, (norm, up, down) in enumerate(zip(self.norms, self.up, self.down, strict=True)):
            x = x + down(F.gelu(up(norm(x) * shapes[2 * index] + shapes[2 * index + 1])))
        change = self.project(x).view(history.shape[0], AHEAD, WIDTH)
        there = change[:, :, RATES.stop :] + history[:, -1:, RATES.stop :]
        frames = torch.cat((change[:, :, RATES], there), dim=2)
        return frames, torch.cat((history[:, AHEAD:], frames), dim=1)


class TailGraph(nn.Module):
    """Normalised frames of all steps -> raw sinc135."""

    def __init__(self, model: Temos) -> None:
        super().__init__()
        self.mean, self.std = constant(model.frame_mean), constant(model.frame_std)

    def forward(self, frames: Tensor, mask: Tensor) -> Tensor:
        """(B, 8 N, 136), (B, F) bool -> (B, F, 135)."""
        frames = frames[:, : mask.shape[1]] * self.std + self.mean
        return from_egocentric(frames) * mask[..., None]


@dataclass(frozen=True)
class Steps:
    """A step, and what comes behind the last one."""

    step: StepGraph
    tail: TailGraph

    @classmethod
    def of(cls, model: Temos) -> Steps | None:
        """Of a network with the step decoder; None for any other."""
        decoder = model.motion_decoder
        return cls(StepGraph(decoder), TailGraph(model)) if isinstance(decoder, StepDecoder) else None

    def looped(self, step: onnx.ModelProto) -> onnx.ModelProto:
        """The whole decoder around a traced step, quantised or not."""
        return looped(step, trace(self.tail, TAIL))


def looped(step: onnx.ModelProto, tail: onnx.ModelProto) -> onnx.ModelProto:
    """Latent and mask -> motion: as many steps as the mask is long; what depends on the latent alone is done once."""
    tail = onnx.compose.add_prefix(tail, "tail.", rename_inputs=False, rename_outputs=False)
    inner, outer = _split(step.graph)
    graph = helper.make_graph(
        [*outer, *_start(), _loop(inner), *_frames(), *tail.graph.node],
        TEMOS_DECODER.name,
        [_declared(tensor) for tensor in TEMOS_DECODER.inputs],
        [_declared(tensor) for tensor in TEMOS_DECODER.outputs],
        [*step.graph.initializer, *tail.graph.initializer, *_constants()],
    )
    model = onnx.ModelProto.FromString(step.SerializeToString())
    model.graph.CopyFrom(graph)
    return model


def _split(graph: onnx.GraphProto) -> tuple[list[NodeProto], list[NodeProto]]:
    """Nodes of every step, and those that know nothing of where the step is."""
    moving, inner, outer = {"history", "time"}, list[NodeProto](), list[NodeProto]()
    for node in graph.node:
        inside = any(name in moving for name in node.input)
        (inner if inside else outer).append(node)
        moving.update(node.output if inside else ())
    return inner, outer


def _start() -> list[NodeProto]:
    """How many steps, and the empty history."""
    return [
        helper.make_node("Shape", ["mask"], ["loop.mask_shape"], name="loop.mask_shape"),
        helper.make_node("Gather", ["loop.mask_shape", "loop.1"], ["loop.length"], name="loop.length"),
        helper.make_node("Add", ["loop.length", "loop.short"], ["loop.more"], name="loop.more"),
        helper.make_node("Div", ["loop.more", "loop.ahead"], ["loop.count"], name="loop.count"),
        helper.make_node("Gather", ["loop.mask_shape", "loop.0"], ["loop.batch"], name="loop.batch"),
        helper.make_node("Unsqueeze", ["loop.batch", "loop.axis"], ["loop.rows"], name="loop.rows"),
        helper.make_node("Concat", ["loop.rows", "loop.state"], ["loop.state_shape"], name="loop.state_shape", axis=0),
        helper.make_node("ConstantOfShape", ["loop.state_shape"], ["loop.history"], name="loop.history"),
    ]


def _loop(inner: list[NodeProto]) -> NodeProto:
    nodes = [
        helper.make_node("Cast", ["step.index"], ["step.float"], name="step.float", to=TensorProto.FLOAT),
        helper.make_node("Mul", ["step.float", "loop.stride"], ["time"], name="step.time"),
        helper.make_node("Identity", ["step.go"], ["step.go_on"], name="step.go_on"),
        *inner,
    ]
    state, shape = list(_STATE), ["batch", AHEAD, WIDTH]
    body = helper.make_graph(
        nodes,
        "step",
        [
            helper.make_tensor_value_info("step.index", TensorProto.INT64, []),
            helper.make_tensor_value_info("step.go", TensorProto.BOOL, []),
            helper.make_tensor_value_info("history", TensorProto.FLOAT, state),
        ],
        [
            helper.make_tensor_value_info("step.go_on", TensorProto.BOOL, []),
            helper.make_tensor_value_info("history_after", TensorProto.FLOAT, state),
            helper.make_tensor_value_info("added", TensorProto.FLOAT, shape),
        ],
    )
    outputs = ["loop.last", "loop.steps"]
    return helper.make_node("Loop", ["loop.count", "loop.true", "loop.history"], outputs, name="loop", body=body)


def _frames() -> list[NodeProto]:
    """(steps, B, 8, 136) -> (B, 8 * steps, 136)."""
    return [
        helper.make_node("Transpose", ["loop.steps"], ["loop.turned"], name="loop.turned", perm=[1, 0, 2, 3]),
        helper.make_node("Reshape", ["loop.turned", "loop.flat"], ["frames"], name="loop.frames"),
    ]


def _constants() -> list[TensorProto]:
    values = {
        "loop.0": np.int64(0),
        "loop.1": np.int64(1),
        "loop.short": np.int64(AHEAD - 1),
        "loop.ahead": np.int64(AHEAD),
        "loop.axis": np.array([0]),
        "loop.state": np.array([HISTORY, WIDTH]),
        "loop.true": np.bool_(True),
        "loop.stride": np.array([AHEAD], np.float32),
        "loop.flat": np.array([0, -1, WIDTH]),
    }
    return [numpy_helper.from_array(np.asarray(value), name) for name, value in values.items()]


def _declared(tensor: TensorSpec) -> onnx.ValueInfoProto:
    kind = {"float32": TensorProto.FLOAT, "bool": TensorProto.BOOL}[tensor.dtype]
    return helper.make_tensor_value_info(tensor.name, kind, tensor.shape)
