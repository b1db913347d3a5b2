"""WalkNet for programs that have nothing but the ONNX file: frames in the world in, the next frame in the world out.

    python -m motionrt_export.world_graph --checkpoints models --out build/walknet_world.onnx

What :class:`motionrt.locomotion.crowd.Crowd` does around the model is in the graph: the goal may be anywhere, and
the rotations that come out are proper ones. The file is not shipped; it is compared with the runtime when it is made.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import onnxruntime as ort
import torch
from torch import Tensor, nn

from motionrt.locomotion.crowd import Crowd
from motionrt_export.motion_graphs import WalkNetGraph
from motionrt_export.optimise import CHOICES, quantise
from motionrt_export.sources import Sources
from motionrt_export.specs import WALKNET, GraphSpec, TensorSpec
from motionrt_export.standing import Standing, in_columns, ordered
from motionrt_export.trace import trace
from motionrt_export.validate import ValidationError, open_session
from motionrt_training.networks.walknet import WalkNet

SPEC = GraphSpec(
    "walknet_world",
    (
        TensorSpec("history", "float32", ("batch", 30, 219), "1, m", "the last ccf219 frames at 30 fps, in the world"),
        TensorSpec("goal", "float32", ("batch", 3), "m, rad", "x, z and heading (from +Z towards +X) of the goal"),
        WALKNET.inputs[1],
    ),
    (TensorSpec("next", "float32", ("batch", 219), "1, m", "the frame after the last one, in the world"),),
)
CLOSE = 1e-4  # metres, and of rotations: what a float32 file may differ from the runtime by
STEPS = 3  # of the iteration that makes rotations proper: errors of 20 % are gone


class WalkNetWorldGraph(nn.Module):
    """One step of `motionrt.locomotion.crowd.Crowd`.

    Places are taken from the last frame's before anything else, so nothing is lost far from the origin but what
    float32 itself leaves out there: 0.06 mm at 1 km. Who wants that, too, moves the world.
    """

    def __init__(self, source: WalkNet) -> None:
        super().__init__()
        self.walk = WalkNetGraph(source)

    def forward(self, history: Tensor, goal: Tensor, speed: Tensor) -> Tensor:
        """(B, 30, 219), (B, 3), (B,) -> (B, 219)."""
        frames = ordered(history)
        body = Standing.of(frames[:, -1:])
        return proper(in_columns(self.walk.step(frames, body, beside(body, goal).goal(), speed))[:, 0])


def beside(body: Standing, goal: Tensor) -> Standing:
    """The body as it is seen from goals (B, 3)."""
    x, z, heading = goal[:, None].split(1, dim=2)
    cos, sin = heading.cos(), heading.sin()
    x, z = body.x - x, body.z - z  # only the last of the four, the root's, is a place
    return Standing(
        body.cos * cos + body.sin * sin, body.sin * cos - body.cos * sin, cos * x - sin * z, cos * z + sin * x
    )


def proper(frame: Tensor) -> Tensor:
    """(B, 219) with the nearest rotations, by X <- X (15 - 10 A + 3 A^2) / 8 with A = X^T X."""
    rotations = frame[:, :216].reshape(-1, 24, 3, 3)
    for _ in range(STEPS):
        square = rotations.transpose(2, 3) @ rotations
        rotations = rotations @ (1.875 * torch.eye(3) - 1.25 * square + 0.375 * (square @ square))
    return torch.cat((rotations.reshape(-1, 216), frame[:, 216:]), dim=1)


def furthest(session: ort.InferenceSession, sources: Sources, count: int = 64) -> float:
    """The largest difference of the next frame from the runtime's step with the torch module."""
    frames, goals, speeds = sources.walks.histories(count, seed=3)
    model = sources.source(WALKNET.name).reference
    crowd = Crowd(lambda seen, speed: model(sources.walks.told(seen, speed))["next"], frames)
    expected = crowd.step(goals, speeds)
    feeds = {"history": frames, "goal": goals, "speed": speeds}
    found = session.run(["next"], {name: value.astype(np.float32) for name, value in feeds.items()})[0]
    return float(np.abs(found - expected).max())


def main(arguments: Sequence[str] | None = None) -> int:
    """Build, compare, write the file and its quantised sibling."""
    parser = argparse.ArgumentParser(prog="motionrt_export.world_graph", description=__doc__.splitlines()[0])
    parser.add_argument("--checkpoints", type=Path, default=Path("models"), help="folder of the released networks")
    parser.add_argument("--out", type=Path, default=Path("build/walknet_world.onnx"), help="file to write")
    args = parser.parse_args(arguments)
    sources = Sources(args.checkpoints)
    exact = trace(WalkNetWorldGraph(sources.walknet.model), SPEC)
    choice = CHOICES[WALKNET.name]
    apart = furthest(open_session(exact.SerializeToString()), sources)
    if apart > CLOSE:
        raise ValidationError(f"{SPEC.name}: differs from the runtime by {apart:.1e}, more than {CLOSE:g}")
    args.out.parent.mkdir(parents=True, exist_ok=True)
    args.out.write_bytes(exact.SerializeToString())
    print(f"{args.out}: differs from the runtime by {apart:.1e} at most")
    if choice is not None:
        small = args.out.with_suffix(".int8.onnx")
        small.write_bytes(quantise(exact, choice).SerializeToString())
        apart = furthest(open_session(small.read_bytes()), sources)
        print(f"{small}: differs from the runtime by {apart:.1e} at most")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
