"""Checkpoints: the trainer's own (everything, to go on from) and the released one (float16, metadata).

    python -m motionrt_training.checkpoint runs/walknet/best.pt --network walknet -o models/walknet.safetensors

releases the averaged weights of a trainer's ``best.pt`` or ``last.pt``; ``--command`` keeps the command that trained
them, ``--licence`` says under which terms they are released (the data's own terms come from the pack).
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

import torch
from torch import Tensor, nn

from motionrt_training.data_record import NOT_STATED
from motionrt_training.networks.latent_denoiser import LatentDenoiser
from motionrt_training.networks.motion_denoiser import MotionDenoiser
from motionrt_training.networks.pose_prior import PosePrior
from motionrt_training.networks.student import TextStudent
from motionrt_training.networks.temos import Temos
from motionrt_training.networks.tmr import TMR
from motionrt_training.networks.transnet import TransNet
from motionrt_training.networks.walknet import WalkNet

NETWORKS: Mapping[str, type[nn.Module]] = {
    "tmr": TMR,
    "text_student": TextStudent,
    "walknet": WalkNet,
    "transnet": TransNet,
    "pose_prior": PosePrior,
    "temos": Temos,
    "latent_denoiser": LatentDenoiser,
    "motion_denoiser": MotionDenoiser,
}
"""Every network that is released; ``config`` of each holds the arguments of its constructor."""

Network = TypeVar("Network", bound=nn.Module)


def save_atomically(state: Mapping[str, Any], path: Path) -> None:
    """Write a torch file under a temporary name, then rename: a reader never sees half a checkpoint."""
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(path.name + ".part")
    torch.save(dict(state), temporary)
    temporary.replace(path)


def load_state(path: str | Path) -> dict[str, Any]:
    """A checkpoint of the trainer, on the CPU; only tensors and plain values are read."""
    path = Path(path)
    if not path.is_file():
        raise FileNotFoundError(f"no checkpoint at {path}; train first, or give the path of a .pt file")
    state: dict[str, Any] = torch.load(path, map_location="cpu", weights_only=True)
    return state


def save_release(model: nn.Module, path: str | Path, metadata: Mapping[str, object]) -> None:
    """Weights as float16 and statistics as float32 in safetensors, metadata as strings.

    The name of the network and the arguments of its constructor are added.
    """
    from safetensors.torch import save_file

    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    halves = {name for name, _ in model.named_parameters()}
    weights = {name: _stored(value, half=name in halves) for name, value in model.state_dict().items()}
    text = {name: value if isinstance(value, str) else json.dumps(value) for name, value in metadata.items()}
    temporary = path.with_name(path.name + ".part")
    save_file(weights, temporary, {**text, "network": network_name(type(model)), "config": json.dumps(model.config)})
    temporary.replace(path)


def load_release(path: str | Path, network: type[Network]) -> tuple[Network, dict[str, str]]:
    """The released model in float32 and evaluation mode, and its metadata.

    Raises:
        FileNotFoundError: no such file.
        ValueError: it was not written by `save_release`, or holds another network.
    """
    from safetensors import safe_open

    path = Path(path)
    if not path.is_file():
        raise FileNotFoundError(f"no released model at {path}")
    with safe_open(path, framework="pt") as file:
        metadata: dict[str, str] = file.metadata() or {}
        weights = {name: file.get_tensor(name).float() for name in file.keys()}  # noqa: SIM118
    if "config" not in metadata:
        raise ValueError(f"{path}: no 'config' in the metadata; it was not written by save_release")
    found = metadata.get("network", "tmr")  # the first releases were all of TMR and did not say so
    if found != network_name(network):
        raise ValueError(f"{path} holds the network '{found}', not '{network_name(network)}'")
    return _built(network, json.loads(metadata["config"]), weights).eval(), metadata


def load_any(path: str | Path, network: type[Network]) -> Network:
    """A released `.safetensors`, or the averaged weights of a trainer's `best.pt`, in evaluation mode."""
    if Path(path).suffix == ".safetensors":
        return load_release(path, network)[0]
    return trained_model(load_state(path), network).eval()


def trained_model(state: Mapping[str, Any], network: type[Network]) -> Network:
    """The averaged network that a trainer's checkpoint holds, `best.pt` or `last.pt`."""
    model = _built(network, state["notes"]["network"], state["model"])
    if "average" in state:  # last.pt has both: the weights that are trained, and their average in the same order
        for parameter, value in zip(model.parameters(), state["average"], strict=True):
            parameter.data = value
    return model


def release(
    source: str | Path, target: str | Path, network: str, command: str | None = None, licence: str | None = None
) -> None:
    """Averaged weights of a trainer's checkpoint -> `save_release`, with how they came to be and their licence.

    Without a licence it is ``"not stated"``, and so it will stand in the manifest.
    """
    state = load_state(source)
    facts: dict[str, object] = {name: state[name] for name in ("seed", "measures", "notes") if name in state}
    facts |= {"recipe": network, "steps": state["step"], "minutes": state["elapsed"] / 60}
    facts |= {"command": command} if command else {}
    facts |= {"licence": licence or NOT_STATED, "data": state.get("data", [])}
    save_release(trained_model(state, NETWORKS[network]), target, facts)


def _built(network: type[Network], config: Mapping[str, Any], weights: Mapping[str, Tensor]) -> Network:
    model = network(**config)
    model.load_state_dict(weights)
    return model


def network_name(network: type[nn.Module]) -> str:
    """What a network is called in `NETWORKS`."""
    return next(name for name, kind in NETWORKS.items() if issubclass(network, kind))


def _stored(value: Tensor, *, half: bool) -> Tensor:
    return value.detach().cpu().to(torch.float16 if half else value.dtype).contiguous()


def main(arguments: Sequence[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description="Release a trained checkpoint.")
    parser.add_argument("checkpoint", type=Path, help="best.pt or last.pt of a run")
    parser.add_argument("--network", required=True, choices=tuple(NETWORKS))
    parser.add_argument("-o", "--out", type=Path, required=True, help="the .safetensors to write")
    parser.add_argument("--command", help="the command that trained the checkpoint, to be released with it")
    parser.add_argument("--licence", help="terms under which you release the weights (default: not stated)")
    args = parser.parse_args(arguments)
    release(args.checkpoint, args.out, args.network, args.command, args.licence)


if __name__ == "__main__":
    main()
