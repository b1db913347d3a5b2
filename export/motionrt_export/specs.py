"""What every exported graph takes and gives: the one place for names, types, axes and units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from motionrt.text import SLOTS, TARGETS

OPSET = 18

Axis = int | str  # a number, or the name of a dynamic axis


@dataclass(frozen=True)
class TensorSpec:
    """One input or output: `shape` holds numbers and the names of dynamic axes, whole numbers lie under `below`."""

    name: str
    dtype: str  # float32, int64 or bool
    shape: tuple[Axis, ...]
    unit: str
    meaning: str
    below: int = 2000

    def dynamic_axes(self) -> dict[int, str]:
        """{position: name} of the axes that are not fixed."""
        return {i: axis for i, axis in enumerate(self.shape) if isinstance(axis, str)}

    def resolved(self, sizes: Mapping[str, int]) -> tuple[int, ...]:
        """The shape with the dynamic axes filled in."""
        return tuple(sizes[axis] if isinstance(axis, str) else axis for axis in self.shape)


@dataclass(frozen=True)
class Switch:
    """An input that is a bool: where it is false, `outputs` come without rows; the runtime gives true unless told."""

    name: str
    outputs: tuple[str, ...]

    @property
    def tensor(self) -> TensorSpec:
        """The input as the manifest describes it."""
        return TensorSpec(self.name, "bool", (), "1", f"true; false leaves out {' and '.join(self.outputs)}")


@dataclass(frozen=True)
class GraphSpec:
    """A graph's signature; `embeddings` names the outputs that are compared by cosine, row by row.

    `length` names the axis that padding extends, `mask` the input that says what is valid; graphs whose lengths are
    fixed have neither; `longest` is as long as it may be. `further` has the sizes that other dynamic axes are tried at.
    `switch` spares those who do not want some of the outputs
    what they cost.
    """

    name: str
    inputs: tuple[TensorSpec, ...]
    outputs: tuple[TensorSpec, ...]
    length: str | None = None
    mask: str | None = None
    embeddings: tuple[str, ...] = field(default=())
    switch: Switch | None = None
    longest: int | None = None
    further: tuple[tuple[str, int], ...] = ()

    @property
    def taken(self) -> tuple[TensorSpec, ...]:
        """All that a file takes: the inputs, and the switch behind them."""
        return self.inputs if self.switch is None else (*self.inputs, self.switch.tensor)

    def dynamic_axes(self) -> dict[str, dict[int, str]]:
        """What `torch.onnx.export` wants."""
        return {tensor.name: tensor.dynamic_axes() for tensor in (*self.inputs, *self.outputs)}

    def sizes(self, batch: int, length: int) -> dict[str, int]:
        """The dynamic axes with their sizes."""
        return {"batch": batch, **dict(self.further)} | ({self.length: length} if self.length else {})


_TOKEN_MASK = TensorSpec("attention_mask", "int64", ("batch", "tokens"), "1", "1 for a token, 0 for padding")
_FRAME_MASK = TensorSpec("mask", "bool", ("batch", "frames"), "1", "true for a frame, false for padding")
_TOKEN_FEATURES = TensorSpec(
    "token_features", "float32", ("batch", "tokens", 384), "1", "contextual features of every token"
)
_MOTION = TensorSpec(
    "motion",
    "float32",
    ("batch", "frames", 263),
    "m, rad, m/frame",
    "raw guo263 features at 20 fps, not normalised",
)
_EMBEDDING = TensorSpec("embedding", "float32", ("batch", 256), "1", "latent divided by its length: dot = cosine")
_LATENT = TensorSpec("latent", "float32", ("batch", 256), "1", "mean of the predicted distribution")

TMR_TEXT = GraphSpec(
    "tmr_text",
    (
        TensorSpec("input_ids", "int64", ("batch", "tokens"), "1", "WordPiece ids with [CLS] and [SEP]"),
        _TOKEN_MASK,
    ),
    (
        _EMBEDDING,
        _LATENT,
        _TOKEN_FEATURES,
        TensorSpec("sentence_embedding", "float32", ("batch", 384), "1", "masked mean of the features, unit length"),
    ),
    "tokens",
    "attention_mask",
    ("embedding", "token_features", "sentence_embedding"),
    Switch("embed", ("embedding", "latent")),
)
TMR_STUDENT = GraphSpec(
    "tmr_student",
    (
        TensorSpec("input_ids", "int64", ("batch", "tokens"), "1", "WordPiece ids with [CLS] and [SEP], at most 128"),
        _TOKEN_MASK,
    ),
    (
        _EMBEDDING,
        TensorSpec(
            "latent", "float32", ("batch", 256), "1", "a vector in the embedding's direction; no latent to decode"
        ),
    ),
    "tokens",
    "attention_mask",
    ("embedding", "latent"),
    longest=128,
)
TMR_MOTION = GraphSpec("tmr_motion", (_MOTION, _FRAME_MASK), (_EMBEDDING, _LATENT), "frames", "mask", ("embedding",))
TMR_DECODER = GraphSpec("tmr_decoder", (_LATENT, _FRAME_MASK), (_MOTION,), "frames", "mask", ())

_SEEN = "ccf219 frames at 30 fps"
_NEXT = "the frame after the last one, seen from the goal; rotations to be projected to SO(3)"
WALKNET = GraphSpec(
    "walknet",
    (
        TensorSpec("frames", "float32", ("batch", 30, 219), "1, m", f"the last {_SEEN}, seen from the goal"),
        TensorSpec("speed", "float32", ("batch",), "m/s", "how fast to walk"),
    ),
    (TensorSpec("next", "float32", ("batch", 219), "1, m", _NEXT),),
)
_WISH = (
    "1 and a velocity (x, z), 1 and a facing (x, z) of length 1, 1 and the speed to arrive with, seen from the goal; "
    "zeros where nothing of the kind is wished"
)
WALKNET_WISHES = replace(
    WALKNET, inputs=(*WALKNET.inputs, TensorSpec("wish", "float32", ("batch", 8), "1, m/s", _WISH))
)
"""WalkNet that was trained with wishes beside the goal."""
TRANSNET = GraphSpec(
    "transnet",
    (
        TensorSpec("frames", "float32", ("batch", 120, 219), "1, m", f"{_SEEN}, seen from the target"),
        TensorSpec("hidden", "bool", ("batch", 120), "1", "true for frames to be filled: one gap, from frame 60 on"),
    ),
    (
        TensorSpec(
            "motion",
            "float32",
            ("batch", 120, 219),
            "1, m",
            "the frames with the hidden ones filled, whose rotations are to be projected to SO(3)",
        ),
    ),
)
POSE_PRIOR = GraphSpec(
    "pose_prior",
    (TensorSpec("latent", "float32", ("batch", 32), "1", "a normal latent: zero is the mean pose"),),
    (
        TensorSpec(
            "rotations", "float32", ("batch", 24, 3, 3), "1", "local to the parent; the pelvis tilts and has no yaw"
        ),
    ),
)

_TEMOS_LATENT = TensorSpec("latent", "float32", ("batch", 256), "1", "raw latent of TEMOS")
_SINC = TensorSpec(
    "motion", "float32", ("batch", "frames", 135), "1, m", "raw sinc135 features at 30 fps, not normalised"
)
_DISTRIBUTION = (
    TensorSpec("mu", "float32", ("batch", 256), "1", "means of the predicted distribution"),
    TensorSpec("logvar", "float32", ("batch", 256), "1", "natural logarithms of its variances"),
)
TEMOS_TEXT = GraphSpec("temos_text", (_TOKEN_FEATURES, _TOKEN_MASK), _DISTRIBUTION, "tokens", "attention_mask", ("mu",))
TEMOS_MOTION = GraphSpec("temos_motion", (_SINC, _FRAME_MASK), _DISTRIBUTION, "frames", "mask", ("mu",))
TEMOS_DECODER = GraphSpec("temos_decoder", (_TEMOS_LATENT, _FRAME_MASK), (_SINC,), "frames", "mask", ())
LATENT_DENOISER = GraphSpec(
    "latent_denoiser",
    (
        TensorSpec("latent", "float32", ("batch", 256), "1", "noisy latent, normalised: pure noise is standard normal"),
        TensorSpec("timestep", "int64", ("batch",), "1", "0 (hardly any noise) to 999 (nothing else)", below=1000),
        TensorSpec("text_latent", "float32", ("batch", 256), "1", "mean of the text's latent, raw as of temos_text"),
        TensorSpec("guidance", "float32", ("batch",), "1", "weight of the text: 0 without it, 1 as trained"),
    ),
    (
        TensorSpec("clean", "float32", ("batch", 256), "1", "estimate of the clean latent, normalised"),
        TensorSpec("latent_out", "float32", ("batch", 256), "1", "the same as a raw latent of TEMOS"),
    ),
    embeddings=("clean", "latent_out"),
)

_EGO = "raw ego77 features at 20 fps"
MOTION_DENOISER = GraphSpec(
    "motion_denoiser",
    (
        TensorSpec("noisy", "float32", ("batch", "frames", 77), "1", "normalised motion with level times normal noise"),
        TensorSpec("level", "float32", ("batch",), "1", "standard deviation of that noise, 0.02 to 90"),
        _FRAME_MASK,
        _TOKEN_FEATURES,
        _TOKEN_MASK,
        TensorSpec("slots", "int64", ("batch", len(SLOTS)), "1", "classes of motionrt.text.SLOTS, 0 unknown", below=3),
        TensorSpec("numbers", "float32", ("batch", len(TARGETS)), "1", "numbers of motionrt.text.TARGETS"),
        TensorSpec("known", "bool", ("batch", len(TARGETS)), "1", "which of the numbers are given"),
        TensorSpec("held", "float32", ("batch", "frames", 77), "m, rad", f"{_EGO} to be kept where holding is true"),
        TensorSpec(
            "holding", "bool", ("batch", "frames", 6), "1", "which of the six body parts of the frames are held"
        ),
        TensorSpec("guidance", "float32", ("batch", 2), "1", "weights of the condition, for the turn and for the rest"),
    ),
    (
        TensorSpec("clean", "float32", ("batch", "frames", 77), "1", "estimate of the motion, normalised"),
        TensorSpec("motion", "float32", ("batch", "frames", 77), "m, rad", f"the same as {_EGO}"),
    ),
    "frames",
    "mask",
    longest=200,
    further=(("tokens", 12),),
)
