"""The denoiser of motions as it is exported: one step of diffusion with its guidance."""

from __future__ import annotations

from torch import Tensor, nn

from motionrt_training.networks.motion_denoiser import Condition, MotionDenoiser


class MotionDenoiserGraph(nn.Module):
    """`MotionDenoiser.guided`, which answers normalised and in the units of ``ego77``."""

    def __init__(self, model: MotionDenoiser) -> None:
        super().__init__()
        self.model = model

    def forward(self, noisy: Tensor, level: Tensor, *told: Tensor) -> tuple[Tensor, Tensor]:
        """Inputs as in `specs.MOTION_DENOISER` -> (B, F, 77) twice."""
        mask, tokens, words, slots, numbers, known, held, holding, guidance = told
        condition = Condition(mask, tokens, words.bool(), slots, numbers, known, held, holding)
        clean = self.model.guided(noisy, level, condition, guidance)
        return clean, self.model.denormalise(clean)
