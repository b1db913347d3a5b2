"""The torch module of every graph, for `motionrt bench --against torch --only models`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import torch

from motionrt.bench.graphs import Feeds, graph_case, graph_feeds
from motionrt.bench.timing import Call
from motionrt.models import find_manifest, load_manifest
from motionrt_export import references, specs
from motionrt_export.references import Reference
from motionrt_export.torch_locomotion import released
from motionrt_training.networks.latent_denoiser import LatentDenoiser
from motionrt_training.networks.minilm import MiniLM
from motionrt_training.networks.motion_denoiser import MotionDenoiser
from motionrt_training.networks.pose_prior import PosePrior
from motionrt_training.networks.student import TextStudent
from motionrt_training.networks.temos import Temos
from motionrt_training.networks.tmr import TMR
from motionrt_training.networks.transnet import TransNet
from motionrt_training.networks.walknet import WalkNet


def graph_cases(models: str | None, sentences: MiniLM, folder: Path) -> dict[str, Call]:
    """One call of the module behind every graph of a manifest; `folder` holds the released networks."""
    manifest, makers = load_manifest(find_manifest(models)), _references(sentences, folder)
    return {
        graph_case(name): _call(makers[name](), graph_feeds(model))
        for name, model in manifest.models.items()
        if name in makers
    }


def _call(reference: Reference, feeds: Feeds) -> Call:
    @torch.inference_mode()
    def call() -> object:
        return reference(feeds)

    return call


def _references(sentences: MiniLM, folder: Path) -> dict[str, Callable[[], Reference]]:
    return {
        specs.TMR_TEXT.name: lambda: references.text_reference(sentences, released(TMR, folder)),
        specs.TMR_STUDENT.name: lambda: references.student_reference(released(TextStudent, folder)),
        specs.TMR_MOTION.name: lambda: references.motion_reference(released(TMR, folder)),
        specs.TMR_DECODER.name: lambda: references.decoder_reference(released(TMR, folder)),
        specs.WALKNET.name: lambda: references.walk_reference(released(WalkNet, folder)),
        specs.TRANSNET.name: lambda: references.transition_reference(released(TransNet, folder)),
        specs.POSE_PRIOR.name: lambda: references.pose_reference(released(PosePrior, folder)),
        specs.TEMOS_TEXT.name: lambda: references.temos_text_reference(released(Temos, folder)),
        specs.TEMOS_MOTION.name: lambda: references.temos_motion_reference(released(Temos, folder)),
        specs.TEMOS_DECODER.name: lambda: references.temos_decoder_reference(released(Temos, folder)),
        specs.LATENT_DENOISER.name: lambda: references.denoiser_reference(released(LatentDenoiser, folder)),
        specs.MOTION_DENOISER.name: lambda: references.motion_denoiser_reference(released(MotionDenoiser, folder)),
    }
