"""How every graph is quantised: the choices; docs/performance.md has the measurements behind them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import onnx

from motionrt_export.quantise import blocks, channels, int8_rows, product_names
from motionrt_export.smooth import Feeds, smooth

FP32, QUANTISED = "fp32", "int8"
"""Names of the variants."""


@dataclass(frozen=True)
class Quantisation:
    """Which weight products get which 8 bits; names are parts of operator names, such as `/feed/down/`.

    Attributes:
        in_blocks: 8-bit blocks, activations too: more accurate, rows never disturb each other, slower.
        block: length of a block along the input axis.
        smoothed: products whose activations are evened out first; needs calibration inputs.
        exact: products that stay float32.
        alpha: how much of the outliers moves into the weights.
    """

    in_blocks: tuple[str, ...] = ()
    block: int = 128
    smoothed: tuple[str, ...] = ()
    alpha: float = 0.6
    exact: tuple[str, ...] = ()

    def describe(self) -> str:
        """For the manifest."""
        parts = ["weights int8 per output channel, 7 bits, with dynamic uint8 activations"]
        if self.in_blocks:
            names = ", ".join(name.strip("/") for name in self.in_blocks)
            parts.append(f"{names}: 8-bit blocks of {self.block}")
        if self.smoothed:
            parts.append(f"{', '.join(name.strip('/') for name in self.smoothed)}: outliers smoothed")
        if self.exact:
            parts.append(f"{', '.join(name.strip('/') for name in self.exact)}: float32")
        return "; ".join([*parts, "lookup tables: int8 rows; norms, softmax and attention products: float32"])


SENTENCE_ENCODER = Quantisation(("/feed/down/",), smoothed=("/qkv/", "/feed/up/", "/feed/down/"))
ENCODER = Quantisation(("/project/",))
DECODER = Quantisation(("/project/", "/hear/"))
MOTION = Quantisation(exact=("/aim/", "/answer/"))
TEMOS_TEXT = Quantisation(("/project/",), exact=("/text_mu/",))
TEMOS_MOTION = Quantisation(("/project/", "/gather/"))
TEMOS_DECODER = Quantisation(("/hear/",), exact=("/project/",))
DENOISER = Quantisation(("/read_text/",), exact=("/read_latent/", "/out/"))

CHOICES: dict[str, Quantisation | None] = {
    "sentence_encoder": SENTENCE_ENCODER,
    "tmr_text": ENCODER,
    "tmr_motion": ENCODER,
    "tmr_decoder": DECODER,
    "walknet": MOTION,
    "transnet": MOTION,
    "pose_prior": None,  # its differences are taken, and it is small: shipped as float32
    "temos_text": TEMOS_TEXT,
    "temos_motion": TEMOS_MOTION,
    "temos_decoder": TEMOS_DECODER,
    "latent_denoiser": DENOISER,
}


def variants(model: str) -> tuple[str, ...]:
    """Variants of a model; the last one is shipped and taken by default."""
    return (FP32,) if CHOICES[model] is None else (FP32, QUANTISED)


def shipped(model: str) -> str:
    """The variant that is shipped."""
    return variants(model)[-1]


def quantise(model: onnx.ModelProto, choice: Quantisation, calibration: Iterable[Feeds] = ()) -> onnx.ModelProto:
    """A quantised copy of a float32 graph."""
    copy = onnx.ModelProto.FromString(model.SerializeToString())
    everything = product_names(copy)
    if choice.smoothed:
        smooth(copy, product_names(copy, *choice.smoothed), calibration, alpha=choice.alpha)
    in_blocks = product_names(copy, *choice.in_blocks) if choice.in_blocks else []
    blocks(copy, in_blocks, block=choice.block)
    kept = product_names(copy, *choice.exact) if choice.exact else []
    channels(copy, [name for name in everything if name not in (*in_blocks, *kept)])
    int8_rows(copy)
    return copy
