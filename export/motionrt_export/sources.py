"""Where the trained weights come from, and what each export needs of them."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial
from pathlib import Path
from typing import Any, Generic

import numpy as np
from torch import nn

from motionrt.retrieval.captions import read_captions
from motionrt.services.search import DEFAULT_CAPTIONS
from motionrt_export import references, specs
from motionrt_export.calibration import calibration_feeds, sentence_ids
from motionrt_export.drift import TransitionDrift, WalkDrift
from motionrt_export.examples import Examples, Feeds, Motions, Sentences, random_examples
from motionrt_export.generation_drift import DecoderDrift, DenoiserDrift, MotionDenoiserDrift
from motionrt_export.generation_graphs import LatentDenoiserGraph, TemosDecoderGraph, TemosMotionGraph, TemosTextGraph
from motionrt_export.graphs import DecoderGraph, MotionEncoderGraph, StudentGraph, TextGraph
from motionrt_export.motion_denoiser_graph import MotionDenoiserGraph
from motionrt_export.motion_graphs import TransNetGraph, WalkNetGraph
from motionrt_export.noising import Noised, NoisyMotions
from motionrt_export.references import Reference
from motionrt_export.specs import GraphSpec
from motionrt_export.text_drift import TextDrift
from motionrt_export.transitions import Transitions
from motionrt_export.validate import Trial
from motionrt_export.walks import Walks
from motionrt_training.checkpoint import NETWORKS, Network, load_release, network_name
from motionrt_training.networks.latent_denoiser import LatentDenoiser
from motionrt_training.networks.minilm import MiniLM, package_folder
from motionrt_training.networks.motion_denoiser import MotionDenoiser
from motionrt_training.networks.pose_prior import PosePrior
from motionrt_training.networks.student import TextStudent
from motionrt_training.networks.temos import Temos
from motionrt_training.networks.tmr import TMR
from motionrt_training.networks.transnet import TransNet
from motionrt_training.networks.walknet import WalkNet

PROJECT = Path(__file__).resolve().parents[2] / "models"
"""Checkpoints of this project: they help to try a network out that is exported alone."""

NEEDS: Mapping[str, tuple[type[nn.Module], ...]] = {
    specs.TMR_TEXT.name: (TMR,),
    specs.TMR_STUDENT.name: (TextStudent,),
    specs.TMR_MOTION.name: (TMR,),
    specs.TMR_DECODER.name: (TMR,),
    specs.WALKNET.name: (WalkNet,),
    specs.TRANSNET.name: (TransNet, WalkNet, PosePrior),
    specs.POSE_PRIOR.name: (PosePrior,),
    specs.TEMOS_TEXT.name: (Temos,),
    specs.TEMOS_MOTION.name: (Temos,),
    specs.TEMOS_DECODER.name: (Temos,),
    specs.LATENT_DENOISER.name: (LatentDenoiser, Temos),
    specs.MOTION_DENOISER.name: (MotionDenoiser,),
}
"""The released networks that a graph, its inputs and its trial are made of: its own first."""


class MissingCheckpointsError(FileNotFoundError):
    """Released networks that are to be exported are not in the folder; the message names their files."""


@dataclass(frozen=True)
class Release(Generic[Network]):
    """A released network, how it came to be, and its file."""

    model: Network
    notes: Mapping[str, str]
    path: Path


@dataclass(frozen=True)
class Source:
    """One graph: the module to export, the reference it must equal, inputs to try, units of the errors.

    `release` is where its weights come from, `calibration` gives inputs for quantising, `trial` is a longer use.
    """

    spec: GraphSpec
    module: nn.Module
    reference: Reference
    examples: Examples
    scale: Mapping[str, np.ndarray[Any, Any]] = field(default_factory=dict)
    release: Release[Any] | None = None
    calibration: Callable[[], Iterable[Feeds]] = tuple
    trial: Trial | None = None


class Sources:
    """The released checkpoints and the sentence encoder's package, read when they are needed.

    Beside `checkpoints`, `helpers` is a folder of networks for trials alone (see `checkpoint`). `steps` and
    `characters` say how far how many characters walk when WalkNet is validated, `generations` how many motions are made
    when TEMOS and its denoiser are; texts are tried on every `every`-th caption of the runtime's list.
    """

    steps, characters, generations, every = 1000, 32, 64, 1

    def __init__(self, checkpoints: Path, helpers: Path = PROJECT) -> None:
        self.folder, self.helpers = checkpoints, helpers

    def checkpoint(self, network: type[nn.Module]) -> Path:
        """The file that a network is released in, or, where it is not there, the project's own of that name."""
        name = f"{network_name(network)}.safetensors"
        own = self.folder / name
        return own if own.is_file() or not (self.helpers / name).is_file() else self.helpers / name

    def check(self, graphs: Collection[str] | None = None) -> None:
        """Raise MissingCheckpointsError unless the released networks of these graphs are there; None: all.

        What a graph needs beside its own network, to be tried out, may be the project's.
        """
        own = NETWORKS.values() if graphs is None else {NEEDS[name][0]: None for name in graphs}
        others = (
            () if graphs is None else {kind: None for name in graphs for kind in NEEDS[name][1:] if kind not in own}
        )
        paths = [self.folder / f"{network_name(network)}.safetensors" for network in own]
        paths += [self.checkpoint(network) for network in others]
        if missing := [str(path) for path in paths if not path.is_file()]:
            how = "python -m motionrt_training.checkpoint RUN/best.pt --network NAME -o FILE"
            raise MissingCheckpointsError(f"no released model at {', '.join(missing)}; train, then: {how}")

    def load(self, network: type[Network]) -> tuple[Network, Mapping[str, str]]:
        """A released network and how it came to be."""
        return load_release(self.checkpoint(network), network)

    def _released(self, network: type[Network]) -> Release[Network]:
        return Release(*self.load(network), self.checkpoint(network))

    @cached_property
    def backbone(self) -> MiniLM:
        """The frozen sentence encoder."""
        return MiniLM.from_package()

    @cached_property
    def tmr(self) -> Release[TMR]:
        """TMR as released."""
        return self._released(TMR)

    @cached_property
    def text_student(self) -> Release[TextStudent]:
        """The small text tower."""
        return self._released(TextStudent)

    @cached_property
    def walknet(self) -> Release[WalkNet]:
        """WalkNet as released."""
        return self._released(WalkNet)

    @cached_property
    def transnet(self) -> Release[TransNet]:
        """TransNet as released."""
        return self._released(TransNet)

    @cached_property
    def pose_prior(self) -> Release[PosePrior]:
        """The pose prior as released."""
        return self._released(PosePrior)

    @cached_property
    def temos(self) -> Release[Temos]:
        """TEMOS as released."""
        return self._released(Temos)

    @cached_property
    def latent_denoiser(self) -> Release[LatentDenoiser]:
        """The denoiser of latent diffusion as released."""
        return self._released(LatentDenoiser)

    @cached_property
    def motion_denoiser(self) -> Release[MotionDenoiser]:
        """The denoiser of motions as released."""
        return self._released(MotionDenoiser)

    @property
    def tokenizer_file(self) -> Path:
        """The file of the tokenizer."""
        return package_folder() / "tokenizer.json"

    @cached_property
    def sentences(self) -> Sentences:
        """Sentences as token ids, for examples and calibration."""
        return Sentences(sentence_ids(self.tokenizer_file))

    def source(self, name: str) -> Source:
        """The source of the graph called `name`; KeyError for any other name.

        Raises:
            MissingCheckpointsError: the network of this graph is not in the folder.
        """
        self.check([name])
        makers: dict[str, Callable[[], Source]] = {
            specs.TMR_TEXT.name: self._text,
            specs.TMR_STUDENT.name: self._student,
            specs.TMR_MOTION.name: self._motion,
            specs.TMR_DECODER.name: self._decoder,
            specs.WALKNET.name: self._walknet,
            specs.TRANSNET.name: self._transnet,
            specs.POSE_PRIOR.name: self._pose_prior,
            specs.TEMOS_TEXT.name: self._temos_text,
            specs.TEMOS_MOTION.name: self._temos_motion,
            specs.TEMOS_DECODER.name: self._temos_decoder,
            specs.LATENT_DENOISER.name: self._latent_denoiser,
            specs.MOTION_DENOISER.name: self._motion_denoiser,
        }
        return makers[name]()

    def _text(self) -> Source:
        networks = self.backbone, self.tmr.model
        module, reference = TextGraph(*networks), references.text_reference(*networks)
        return self._of_text(specs.TMR_TEXT, module, reference, self.tmr)

    def _student(self) -> Source:
        model = self.text_student.model
        module, reference = StudentGraph(model), references.student_reference(model)
        return self._of_text(specs.TMR_STUDENT, module, reference, self.text_student)

    def _of_text(self, spec: GraphSpec, module: nn.Module, reference: Reference, release: Release[Any]) -> Source:
        encode = sentence_ids(self.tokenizer_file)
        trial = TextDrift(encode, read_captions(DEFAULT_CAPTIONS)[:: self.every])
        calibration = partial(calibration_feeds, encode)
        return Source(spec, module, reference, self.sentences, release=release, calibration=calibration, trial=trial)

    def _motion(self) -> Source:
        model = self.tmr.model
        module, reference = MotionEncoderGraph(model), references.motion_reference(model)
        return Source(specs.TMR_MOTION, module, reference, self._motions.motion, release=self.tmr)

    def _decoder(self) -> Source:
        model = self.tmr.model
        scale = {"motion": model.motion_std.numpy()}
        module, reference = DecoderGraph(model), references.decoder_reference(model)
        return Source(specs.TMR_DECODER, module, reference, self._motions.decoder, scale, self.tmr)

    def _walknet(self) -> Source:
        model, trial = self.walknet.model, WalkDrift(self.walks, steps=self.steps, characters=self.characters)
        module, reference = WalkNetGraph(model), references.walk_reference(model)
        spec = specs.WALKNET_WISHES if model.wishes else specs.WALKNET
        return Source(spec, module, reference, self.walks, release=self.walknet, trial=trial)

    def _transnet(self) -> Source:
        model, examples = self.transnet.model, Transitions(self.walks, self.pose_prior.model)
        module, reference, trial = (
            TransNetGraph(model),
            references.transition_reference(model),
            TransitionDrift(examples),
        )
        return Source(specs.TRANSNET, module, reference, examples, release=self.transnet, trial=trial)

    def _pose_prior(self) -> Source:
        model, spec = self.pose_prior.model, specs.POSE_PRIOR
        return Source(spec, model, references.pose_reference(model), random_examples(spec), release=self.pose_prior)

    def _temos_text(self) -> Source:
        model = self.temos.model
        module, reference = TemosTextGraph(model), references.temos_text_reference(model)
        return Source(specs.TEMOS_TEXT, module, reference, self._generated.text, release=self.temos)

    def _temos_motion(self) -> Source:
        model = self.temos.model
        module, reference = TemosMotionGraph(model), references.temos_motion_reference(model)
        return Source(specs.TEMOS_MOTION, module, reference, self._generated.motion, release=self.temos)

    def _temos_decoder(self) -> Source:
        model, examples = self.temos.model, self._generated.decoder
        module, reference = TemosDecoderGraph(model), references.temos_decoder_reference(model)
        trial = DecoderDrift(self._generated, count=self.generations)
        return Source(specs.TEMOS_DECODER, module, reference, examples, release=self.temos, trial=trial)

    def _latent_denoiser(self) -> Source:
        model, spec = self.latent_denoiser.model, specs.LATENT_DENOISER
        module, reference = LatentDenoiserGraph(model), references.denoiser_reference(model)
        examples, decode = Noised(self._generated, model), references.temos_decoder_reference(self.temos.model)
        trial = DenoiserDrift(self._generated, decode, count=self.generations)
        return Source(spec, module, reference, examples, release=self.latent_denoiser, trial=trial)

    def _motion_denoiser(self) -> Source:
        release, spec = self.motion_denoiser, specs.MOTION_DENOISER
        model = release.model
        module, reference = MotionDenoiserGraph(model), references.motion_denoiser_reference(model)
        examples = NoisyMotions(self.sentences, self.backbone, model)
        trial = MotionDenoiserDrift(examples, count=self.generations)
        return Source(spec, module, reference, examples, release=release, trial=trial)

    @cached_property
    def _generated(self) -> Motions:
        return Motions(self.sentences, self.backbone, self.temos.model)

    @cached_property
    def _motions(self) -> Motions:
        return Motions(self.sentences, self.backbone, self.tmr.model)

    @cached_property
    def walks(self) -> Walks:
        """Walks that WalkNet begins with."""
        return Walks(self.walknet.model)
