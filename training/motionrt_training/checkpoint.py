"""Checkpoints: the trainer's own (everything, to go on from) and the released one (float16, metadata)."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import torch
from torch import Tensor

from motionrt_training.networks.tmr import TMR


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


def save_release(model: TMR, path: str | Path, metadata: Mapping[str, object]) -> None:
    """Float16 weights in safetensors, metadata as strings; the constructor's arguments are added."""
    from safetensors.torch import save_file

    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    weights = {name: _half(value) for name, value in model.state_dict().items()}
    text = {name: value if isinstance(value, str) else json.dumps(value) for name, value in metadata.items()}
    temporary = path.with_name(path.name + ".part")
    save_file(weights, temporary, {**text, "config": json.dumps(model.config)})
    temporary.replace(path)


def load_release(path: str | Path) -> tuple[TMR, dict[str, str]]:
    """The released model in float32 and evaluation mode, and its metadata."""
    from safetensors import safe_open

    path = Path(path)
    if not path.is_file():
        raise FileNotFoundError(f"no released model at {path}")
    with safe_open(path, framework="pt") as file:
        metadata: dict[str, str] = file.metadata() or {}
        weights = {name: file.get_tensor(name).float() for name in file.keys()}  # noqa: SIM118
    if "config" not in metadata:
        raise ValueError(f"{path}: no 'config' in the metadata; it was not written by save_release")
    model = TMR(**json.loads(metadata["config"]))
    model.load_state_dict(weights)
    return model.eval(), metadata


def load_any(path: str | Path) -> TMR:
    """A released `.safetensors`, or the averaged weights of a trainer's `best.pt`, in evaluation mode."""
    if Path(path).suffix == ".safetensors":
        return load_release(path)[0]
    return trained_model(load_state(path)).eval()


def trained_model(state: Mapping[str, Any]) -> TMR:
    """The network that a trainer's checkpoint of TMR holds."""
    model = TMR(**state["notes"]["network"])
    model.load_state_dict(state["model"])
    return model


def _half(value: Tensor) -> Tensor:
    return value.detach().cpu().to(torch.float16).contiguous()
