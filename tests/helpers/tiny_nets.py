"""Small untrained torch networks with the real inputs and outputs, and a checkpoint folder made of them."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from pathlib import Path

import numpy as np
import torch

from motionrt.motion.features import ego77
from motionrt.motion.skeleton import SMPL24
from motionrt.synthesis.motion_diffusion import held_columns
from motionrt.text import SLOTS, TARGETS
from motionrt_export.sources import Sources
from motionrt_export.walks import Walks
from motionrt_training.checkpoint import Network, network_name
from motionrt_training.networks.egocentric import to_egocentric
from motionrt_training.networks.latent_denoiser import LatentDenoiser
from motionrt_training.networks.minilm import MiniLM
from motionrt_training.networks.motion_denoiser import MotionDenoiser
from motionrt_training.networks.pose_prior import PosePrior, to_6d
from motionrt_training.networks.student import TextStudent
from motionrt_training.networks.temos import Temos
from motionrt_training.networks.tmr import TMR
from motionrt_training.networks.transnet import TransNet
from motionrt_training.networks.walknet import WalkNet

TOKENIZER = Path(__file__).parents[1] / "fixtures" / "models" / "models" / "tokenizer.json"


def tiny_tmr(patch: int = 1, layers: int = 2) -> TMR:
    """A TMR of width 256 with feature statistics like those of motions."""
    torch.manual_seed(3)
    model = TMR(layers=layers, ff=64, patch=patch, dropout=0.0)
    model.motion_mean.normal_(0.0, 0.5)
    model.motion_std.uniform_(0.01, 0.5)
    return model.eval().requires_grad_(False)


def tiny_student(words: int = 64) -> TextStudent:
    """A small text tower of two thin layers, 2000 words."""
    torch.manual_seed(10)
    model = TextStudent(vocabulary=2000, words=words, d=64, layers=2, heads=2, ff=64, out=256)
    model.positions.data.normal_(0.0, 0.1)
    return model.eval().requires_grad_(False)


def tiny_minilm() -> MiniLM:
    """One layer, 2000 words."""
    torch.manual_seed(4)
    model = MiniLM(vocabulary=2000, positions=256, layers=1)
    model.positions.data.normal_(0.0, 0.1)
    return model.eval().requires_grad_(False)


def tiny_walknet(patch: int = 5, *, wishes: bool = False) -> WalkNet:
    """A WalkNet of two narrow layers that stands about: changes are small."""
    torch.manual_seed(5)
    model = WalkNet(d=64, layers=2, heads=2, ff=64, patch=patch, wishes=wishes)
    model.body.out.weight.data.normal_(0.0, 0.1)
    _standing(model.pose_mean)
    model.pose_std.uniform_(0.05, 0.3)
    model.rate_std.uniform_(0.005, 0.03)
    model.change_std.uniform_(0.001, 0.01)
    return model.eval().requires_grad_(False)


def tiny_transnet(patch: int = 4) -> TransNet:
    """A TransNet of two narrow layers that corrects its straight lines a little."""
    torch.manual_seed(6)
    model = TransNet(d=64, layers=2, heads=2, ff=64, patch=patch)
    _standing(model.pose_mean)
    model.body.out.weight.data.normal_(0.0, 0.1)
    for name in ("pose", "rate", "seed", "change"):
        getattr(model, f"{name}_std").uniform_(0.02, 0.2)
    return model.eval().requires_grad_(False)


def tiny_pose_prior() -> PosePrior:
    """A PosePrior of narrow layers around the T-pose."""
    torch.manual_seed(7)
    model = PosePrior(width=48)
    model.mean.copy_(to_6d(torch.eye(3).expand(24, 3, 3)).flatten())
    model.std.fill_(0.3)
    return model.eval().requires_grad_(False)


def tiny_temos(patch: int = 8) -> Temos:
    """A TEMOS of two thin layers whose people stand about a T-pose and stroll."""
    torch.manual_seed(8)
    model = Temos(layers=2, ff=64, patch=patch, dropout=0.0)
    for name, value in model.named_parameters():
        if not value.any() and "norm" not in name:  # branches that begin at zero
            value.data.normal_(0.0, 0.05)
    model.motion_decoder.project.weight.data.normal_(0.0, 0.05)
    standing = torch.cat((torch.tensor([1.0, 0.0, 0.0, 0.0, 1.0, 0.0]).repeat(22), torch.tensor([0.0, 0.0, 0.9])))
    model.frame_mean.copy_(to_egocentric(standing[None, None])[0, 0])
    model.frame_mean[2] = 0.03
    model.frame_std.uniform_(0.1, 0.3)
    model.frame_std[:3] = 0.01
    return model.eval().requires_grad_(False)


def tiny_latent_denoiser(layers: int = 3) -> LatentDenoiser:
    """A denoiser of thin layers that adds something to its first guess, with statistics of latents."""
    torch.manual_seed(9)
    model = LatentDenoiser(text_dim=256, layers=layers, ff=64, dropout=0.0)
    model.out.weight.data.normal_(0.0, 0.05)
    model.out.bias.data.normal_(0.0, 0.1)
    model.latent_mean.normal_(0.0, 0.5)
    model.latent_std.uniform_(0.5, 1.5)
    return model.eval().requires_grad_(False)


def tiny_motion_denoiser(layers: int = 2) -> MotionDenoiser:
    """A denoiser of thin layers that listens to all it is told, whose people stroll about a rest pose."""
    torch.manual_seed(10)
    model = MotionDenoiser(
        layers=layers, ff=64, d=64, slots=tuple(SLOTS.values()), targets=len(TARGETS), owners=held_columns().tolist()
    )
    for name, value in model.named_parameters():
        if "modulate" in name or "leave" in name:  # what begins at zero
            value.data.normal_(0.0, 0.05)
    rest = np.asarray(SMPL24.rest_positions - SMPL24.rest_positions[:, 1].min() * np.array([0, 1, 0]))
    model.mean.copy_(torch.from_numpy(ego77.encode(np.repeat(rest[None], 3, axis=0))[0]))
    model.mean[2] = 0.05
    model.std.uniform_(0.02, 0.05)
    model.std[:3] = 0.004
    return model.eval().requires_grad_(False)


def _standing(mean: torch.Tensor) -> None:
    mean[:216] = torch.eye(3).flatten().repeat(24)
    mean[217] = 0.9


NOTES = {"seed": "3", "steps": "10", "minutes": "0.123", "measures": '{"test_R1": 12.345, "val_R1": 1}'}
MAKERS = {
    TMR: tiny_tmr,
    TextStudent: tiny_student,
    WalkNet: tiny_walknet,
    TransNet: tiny_transnet,
    PosePrior: tiny_pose_prior,
    Temos: tiny_temos,
    LatentDenoiser: tiny_latent_denoiser,
    MotionDenoiser: tiny_motion_denoiser,
}


class TinySources(Sources):
    """The tiny networks in place of the released ones."""

    steps, characters, generations = 40, 2, 4

    @cached_property
    def backbone(self) -> MiniLM:
        return tiny_minilm()

    def load(self, network: type[Network]) -> tuple[Network, Mapping[str, str]]:
        model = MAKERS[network]()
        assert isinstance(model, network)
        return model, NOTES

    @cached_property
    def walks(self) -> Walks:
        return Walks(self.walknet.model, characters=2, steps=70, settle=5)

    @property
    def tokenizer_file(self) -> Path:
        return TOKENIZER


def tiny_sources(folder: Path) -> TinySources:
    """Sources whose checkpoint files exist, as their checksums go into the manifest."""
    folder.mkdir(parents=True, exist_ok=True)
    for network in MAKERS:
        (folder / f"{network_name(network)}.safetensors").write_bytes(b"tiny")
    return TinySources(folder)
