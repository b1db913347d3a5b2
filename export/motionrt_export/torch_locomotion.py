"""Walking, transitions and poses with the torch modules, for `motionrt bench --against torch`.

The same steps with a torch module in the place of a session: all frames of `WalkNet`, with torch's fused attention.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from motionrt.bench.locomotion import CROWDS, POSE, TRANSITION, Moves, pose_call, transition_call, walk_call, walk_case
from motionrt.bench.timing import Call
from motionrt.locomotion.crowd import NextFrame
from motionrt.locomotion.transitions import Infill
from motionrt.models.pose_prior import PosePrior as Prior
from motionrt_export.examples import Array
from motionrt_training.checkpoint import Network, load_release, network_name
from motionrt_training.networks.pose_prior import PosePrior
from motionrt_training.networks.transformer import set_fused_attention
from motionrt_training.networks.transnet import TransNet
from motionrt_training.networks.walknet import WalkNet


def move_cases(moves: Moves, folder: Path) -> dict[str, Call]:
    """A step of every crowd, a transition and a pose; ``folder`` holds the released networks."""
    walk, infill, prior = torch_walk(folder), torch_infill(folder), torch_prior(folder)
    steps = {
        walk_case(count, spread=spread): walk_call(walk, moves, count)
        for count in CROWDS
        for spread in (False, True)
        if count > 1 or not spread
    }
    return {**steps, TRANSITION: transition_call(infill, moves), POSE: pose_call(prior, moves)}


def torch_walk(folder: Path) -> NextFrame:
    """WalkNet: the first of the 30 frames that it predicts."""
    model = released(WalkNet, folder)

    @torch.inference_mode()
    def step(*told: Array) -> Array:
        return numpy(model(*(tensor(values) for values in told))[:, 0])

    return step


def torch_infill(folder: Path) -> Infill:
    """TransNet."""
    model = released(TransNet, folder)

    @torch.inference_mode()
    def infill(frames: Array, hidden: Array) -> Array:
        return numpy(model(tensor(frames), tensor(hidden)))

    return infill


def torch_prior(folder: Path) -> Prior:
    """The pose prior."""
    model = released(PosePrior, folder)

    @torch.inference_mode()
    def decode(latents: Array) -> Array:
        return numpy(model.decode(tensor(latents)))

    return Prior(decode)


def released(network: type[Network], folder: Path) -> Network:
    """The released network; freshly made weights, which are as fast, where the checkpoint is not at hand."""
    path = folder / f"{network_name(network)}.safetensors"
    model = load_release(path, network)[0] if path.is_file() else network()
    set_fused_attention(model.eval(), fused=True)
    return model


def tensor(array: Array) -> Tensor:
    """A copy: what the bench passes may be read-only."""
    return torch.from_numpy(np.array(array))


def numpy(value: Tensor) -> Array:
    """The values as float32."""
    made: Array = value.float().numpy()
    return made
