"""Which variants there are, which one ships, and how every graph is quantised; docs/quantisation.md says why."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import onnx

from motionrt_export.attention import join_attention
from motionrt_export.fuse import fused
from motionrt_export.gptq import input_products
from motionrt_export.quantise import blocks, channels, int8_rows, product_names
from motionrt_export.smooth import Feeds, smooth

FP32, FP16, QUANTISED = "fp32", "fp16", "int8"
"""Names of the variants: float32, weights stored as float16, and the integers of `CHOICES`."""


@dataclass(frozen=True)
class Quantisation:
    """Which weight products get which 8 bits; names are parts of operator names, such as `/feed/down/`.

    Attributes:
        in_blocks: 8-bit blocks, activations too: more accurate, rows never disturb each other, slower.
        block: length of a block along the input axis.
        smoothed: products whose activations are evened out first; needs calibration inputs.
        exact: products that stay float32.
        compensated: products in channels whose weights make up for each other's errors; needs calibration inputs.
        alpha: how much of the outliers moves into the weights.
    """

    in_blocks: tuple[str, ...] = ()
    block: int = 128
    smoothed: tuple[str, ...] = ()
    alpha: float = 0.6
    exact: tuple[str, ...] = ()
    compensated: tuple[str, ...] = ()

    def describe(self) -> str:
        """For the manifest."""
        parts = ["weights int8 per output channel, 7 bits, with dynamic uint8 activations"]
        if self.in_blocks:
            names = ", ".join(name.strip("/") for name in self.in_blocks)
            parts.append(f"{names}: 8-bit blocks of {self.block}")
        if self.smoothed:
            parts.append(f"{', '.join(name.strip('/') for name in self.smoothed)}: outliers smoothed")
        if self.compensated:
            parts.append(f"{', '.join(name.strip('/') for name in self.compensated)}: rounded by GPTQ")
        if self.exact:
            parts.append(f"{', '.join(name.strip('/') for name in self.exact)}: float32")
        return "; ".join([*parts, "lookup tables: int8 rows; norms, softmax and attention products: float32"])


TEXT = Quantisation(
    (
        "/sentences/*/feed/down/",
        "/sentences/layers.[145]/attention/qkv/",  # of one to four layers tried, these; all six cost 5 % more time
        "/sentences/layers.[145]/feed/up/",
        "/encoder/project/",
    ),
    smoothed=("/sentences/*/qkv/", "/sentences/*/feed/up/", "/sentences/*/feed/down/"),
    compensated=("/sentences/",),
    alpha=0.7,
)
STUDENT = Quantisation(("/leave/",))
ENCODER = Quantisation(("/project/",))
DECODER = Quantisation(("/project/", "/hear/"))
MOTION = Quantisation(exact=("/aim/", "/answer/"))
TRANSITION = MOTION  # an int8 answer is 7 % faster, and lets feet slide 5 % more
TEMOS_TEXT = Quantisation(("/project/",), exact=("/text_mu/",))
TEMOS_MOTION = Quantisation(("/project/", "/gather/"))
TEMOS_DECODER = Quantisation(("/hear/",), exact=("/project/",))
DENOISER = Quantisation(("/read_text/",), exact=("/read_latent/", "/out/"))
MOTION_DENOISER = Quantisation(exact=("/enter/", "/leave/"))

CHOICES: dict[str, Quantisation | None] = {
    "tmr_text": TEXT,
    "tmr_student": STUDENT,
    "tmr_motion": ENCODER,
    "tmr_decoder": DECODER,
    "walknet": MOTION,
    "transnet": TRANSITION,
    "pose_prior": None,  # its differences are taken, and it is small: shipped as float32
    "temos_text": TEMOS_TEXT,
    "temos_motion": TEMOS_MOTION,
    "temos_decoder": TEMOS_DECODER,
    "latent_denoiser": DENOISER,
    "motion_denoiser": MOTION_DENOISER,
}


NOT_SHIPPED = frozenset({"tmr_decoder", "temos_motion"})
"""Models that no verb of the runtime needs: their files are built, and stay in the checkout."""


def variants(model: str) -> tuple[str, ...]:
    """Variants of a model."""
    return (FP32, FP16) if CHOICES[model] is None else (FP32, FP16, QUANTISED)


def preferred(model: str) -> str:
    """The variant that is taken by default."""
    return FP32 if CHOICES[model] is None else QUANTISED


def is_shipped(model: str, variant: str) -> bool:
    """Whether a file comes with motionrt; all others are only built."""
    return variant == preferred(model) and model not in NOT_SHIPPED


def quantise(model: onnx.ModelProto, choice: Quantisation, calibration: Iterable[Feeds] = ()) -> onnx.ModelProto:
    """A quantised copy of a float32 graph, with its operators fused."""
    copy = onnx.ModelProto.FromString(model.SerializeToString())
    everything, feeds = product_names(copy), list(calibration)
    if choice.smoothed:
        smooth(copy, product_names(copy, *choice.smoothed), feeds, alpha=choice.alpha)
    in_blocks = product_names(copy, *choice.in_blocks) if choice.in_blocks else []
    kept = product_names(copy, *choice.exact) if choice.exact else []
    rest = [name for name in everything if name not in (*in_blocks, *kept)]
    compensated = product_names(copy, *choice.compensated) if choice.compensated else []
    products = input_products(copy, {*compensated} & {*rest}, feeds)
    blocks(copy, in_blocks, block=choice.block)
    channels(copy, rest, products)
    int8_rows(copy)
    join_attention(copy)
    return fused(copy)
