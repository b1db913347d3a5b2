"""What is measured of the models themselves: one call of every graph, with inputs made from the manifest."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from motionrt.bench.timing import Call
from motionrt.models import Sessions
from motionrt.models.manifest import Model, TensorInfo
from motionrt.models.transnet import SEED

TOKENS, FRAMES = 16, {"tmr_motion": 200}  # a sentence; a window of retrieval
ANY_FRAMES = 120

Feeds = Mapping[str, npt.NDArray[Any]]


def graph_case(model: str) -> str:
    """Name of one call of a model."""
    return f"model {model}"


def sizes(model: Model) -> dict[str, int]:
    """What the names of the dynamic axes stand for here."""
    known = {"batch": 1, "tokens": TOKENS, "frames": FRAMES.get(model.name, ANY_FRAMES)}
    names = dict.fromkeys(axis for info in model.inputs for axis in info.shape if isinstance(axis, str))
    return {name: known.get(name, 1) for name in names}


def graph_feeds(model: Model) -> Feeds:
    """Inputs of a model: small numbers for what is real, ones for what is whole, true for what is masked, and
    for the gap that a transition fills.
    """
    chance = np.random.default_rng(0)
    axes = sizes(model)
    return {info.name: _array(info, axes, chance) for info in model.inputs}


def _array(info: TensorInfo, axes: Mapping[str, int], chance: np.random.Generator) -> npt.NDArray[Any]:
    shape = [axes[axis] if isinstance(axis, str) else axis for axis in info.shape]
    if info.dtype == "float32":
        return 0.1 * chance.standard_normal(shape, np.float32)
    filled = np.ones(shape, info.dtype)
    if info.name == "hidden":
        filled[:, :SEED] = filled[:, -1:] = False
    return filled


def graph_call(sessions: Sessions, model: str, variant: str | None = None) -> Call:
    """One call of a model for all of its outputs."""
    feeds = graph_feeds(sessions.model(model))
    return lambda: sessions.run(model, [info.name for info in sessions.model(model).outputs], feeds, variant)


def called_with(model: Model) -> str:
    """The inputs in words, as in ``batch 1, tokens 16``."""
    return ", ".join(f"{name} {size}" for name, size in sizes(model).items()) or "fixed shapes"
