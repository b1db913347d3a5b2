"""ONNX models and text encoding: the only package that knows of ONNX. Nothing heavy is imported until used.

The names below are loaded when they are first used, so that each use waits for its own models alone.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from motionrt._lazy import lazily

if TYPE_CHECKING:
    from motionrt.models.checks import FileReport, verify
    from motionrt.models.latent_denoiser import LatentDenoiser
    from motionrt.models.locate import find_manifest
    from motionrt.models.manifest import Manifest, Model, TensorInfo, Tokenizer, Variant
    from motionrt.models.pose_prior import PosePrior
    from motionrt.models.reading import load_manifest
    from motionrt.models.sessions import Sessions
    from motionrt.models.temos import LatentDistribution, TemosModel
    from motionrt.models.text import SentenceEncoder, SentenceFeatures
    from motionrt.models.tmr import TextMotionModel
    from motionrt.models.transnet import TransitionModel
    from motionrt.models.walknet import WalkModel

_HOMES = {
    "checks": ("FileReport", "verify"),
    "latent_denoiser": ("LatentDenoiser",),
    "locate": ("find_manifest",),
    "manifest": ("Manifest", "Model", "TensorInfo", "Tokenizer", "Variant"),
    "pose_prior": ("PosePrior",),
    "reading": ("load_manifest",),
    "sessions": ("Sessions",),
    "temos": ("LatentDistribution", "TemosModel"),
    "text": ("SentenceEncoder", "SentenceFeatures"),
    "tmr": ("TextMotionModel",),
    "transnet": ("TransitionModel",),
    "walknet": ("WalkModel",),
}
__all__ = [
    "FileReport",
    "LatentDenoiser",
    "LatentDistribution",
    "Manifest",
    "Model",
    "PosePrior",
    "SentenceEncoder",
    "SentenceFeatures",
    "Sessions",
    "TemosModel",
    "TensorInfo",
    "TextMotionModel",
    "Tokenizer",
    "TransitionModel",
    "Variant",
    "WalkModel",
    "find_manifest",
    "load_manifest",
    "verify",
]

__getattr__ = lazily(__name__, _HOMES)
