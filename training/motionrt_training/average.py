"""Exponential moving average of a model's weights."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import torch
from torch import Tensor, nn


class Average:
    """Averaged copies of the parameters; the decay grows from 0.1 so that early steps are soon forgotten."""

    def __init__(self, model: nn.Module, decay: float) -> None:
        self.decay = decay
        self.values = [p.detach().clone() for p in model.parameters()]

    @torch.no_grad()
    def update(self, model: nn.Module, step: int) -> None:
        """Move towards the parameters as they are after `step` (from 0)."""
        decay = min(self.decay, (1 + step) / (10 + step))
        torch._foreach_lerp_(self.values, [p.detach() for p in model.parameters()], 1.0 - decay)

    @contextmanager
    def applied_to(self, model: nn.Module) -> Iterator[None]:
        """The model holds the averaged weights inside the `with`, its own again after it."""
        self._swap(model)
        try:
            yield
        finally:
            self._swap(model)

    def state(self) -> list[Tensor]:
        """What a checkpoint keeps."""
        return self.values

    def load(self, state: list[Tensor]) -> None:
        """The inverse of `state`."""
        for value, saved in zip(self.values, state, strict=True):
            value.copy_(saved)

    def _swap(self, model: nn.Module) -> None:
        for index, parameter in enumerate(model.parameters()):
            parameter.data, self.values[index] = self.values[index], parameter.data
