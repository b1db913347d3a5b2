"""Small untrained torch networks with the real inputs and outputs, and a checkpoint folder made of them."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path

import torch

from motionrt_export.sources import Sources
from motionrt_training.networks.minilm import MiniLM
from motionrt_training.networks.tmr import TMR

TOKENIZER = Path(__file__).parents[1] / "fixtures" / "models" / "models" / "tokenizer.json"


def tiny_tmr(patch: int = 1, layers: int = 2) -> TMR:
    """A TMR of width 256 with feature statistics like those of motions."""
    torch.manual_seed(3)
    model = TMR(layers=layers, ff=64, patch=patch, dropout=0.0)
    model.motion_mean.normal_(0.0, 0.5)
    model.motion_std.uniform_(0.01, 0.5)
    return model.eval().requires_grad_(False)


def tiny_minilm() -> MiniLM:
    """One layer, 2000 words."""
    torch.manual_seed(4)
    model = MiniLM(vocabulary=2000, positions=256, layers=1)
    model.positions.data.normal_(0.0, 0.1)
    return model.eval().requires_grad_(False)


class TinySources(Sources):
    """The tiny networks in place of the released ones."""

    @cached_property
    def backbone(self) -> MiniLM:
        return tiny_minilm()

    @cached_property
    def released(self) -> tuple[TMR, dict[str, str]]:
        notes = {
            "seed": "3",
            "steps": "10",
            "minutes": "0.123",
            "measures": '{"test_R1": 12.345, "val_R1": 1}',
        }
        return tiny_tmr(), notes

    @property
    def tokenizer_file(self) -> Path:
        return TOKENIZER


def tiny_sources(folder: Path) -> TinySources:
    """Sources whose checkpoint file exists, as its checksum goes into the manifest."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "tmr.safetensors").write_bytes(b"tiny")
    return TinySources(folder)
