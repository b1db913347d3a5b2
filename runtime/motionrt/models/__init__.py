"""ONNX models and text encoding: the only room that knows of ONNX. Nothing heavy is imported until used."""

from __future__ import annotations

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
