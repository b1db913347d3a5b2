"""Where the trained weights come from, and the four things that each export needs of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from torch import nn

from motionrt_export import specs
from motionrt_export.calibration import sentence_ids
from motionrt_export.examples import Examples, Motions, Sentences
from motionrt_export.graphs import DecoderGraph, MotionEncoderGraph, SentenceEncoderGraph, TextEncoderGraph
from motionrt_export.references import (
    Reference,
    decoder_reference,
    motion_reference,
    sentence_reference,
    text_reference,
)
from motionrt_export.specs import GraphSpec
from motionrt_training.checkpoint import load_release
from motionrt_training.networks.minilm import MiniLM, package_folder
from motionrt_training.networks.tmr import TMR

CHECKPOINT = "tmr.safetensors"


@dataclass(frozen=True)
class Source:
    """One graph: the module to export, the reference it must equal, inputs to try, units of the errors."""

    spec: GraphSpec
    module: nn.Module
    reference: Reference
    examples: Examples
    scale: Mapping[str, np.ndarray[Any, Any]]


class Sources:
    """The released checkpoint and the sentence encoder's package, read when they are needed."""

    def __init__(self, checkpoints: Path) -> None:
        self.checkpoint = checkpoints / CHECKPOINT

    @cached_property
    def backbone(self) -> MiniLM:
        return MiniLM.from_package()

    @cached_property
    def released(self) -> tuple[TMR, dict[str, str]]:
        return load_release(self.checkpoint)

    @property
    def tokenizer_file(self) -> Path:
        return package_folder() / "tokenizer.json"

    @cached_property
    def sentences(self) -> Sentences:
        return Sentences(sentence_ids(self.tokenizer_file))

    def source(self, name: str) -> Source:
        """The source of the graph called `name`; KeyError for any other name."""
        makers: dict[str, Callable[[], Source]] = {
            specs.SENTENCE_ENCODER.name: self._sentence_encoder,
            specs.TMR_TEXT.name: self._text,
            specs.TMR_MOTION.name: self._motion,
            specs.TMR_DECODER.name: self._decoder,
        }
        return makers[name]()

    def _sentence_encoder(self) -> Source:
        module, reference = SentenceEncoderGraph(self.backbone), sentence_reference(self.backbone)
        return Source(specs.SENTENCE_ENCODER, module, reference, self.sentences, {})

    def _text(self) -> Source:
        model = self.released[0]
        return Source(specs.TMR_TEXT, TextEncoderGraph(model), text_reference(model), self._motions.text, {})

    def _motion(self) -> Source:
        model = self.released[0]
        module, reference = MotionEncoderGraph(model), motion_reference(model)
        return Source(specs.TMR_MOTION, module, reference, self._motions.motion, {})

    def _decoder(self) -> Source:
        model = self.released[0]
        scale = {"motion": model.motion_std.numpy()}
        module, reference = DecoderGraph(model), decoder_reference(model)
        return Source(specs.TMR_DECODER, module, reference, self._motions.decoder, scale)

    @cached_property
    def _motions(self) -> Motions:
        return Motions(self.sentences, self.backbone, self.released[0])
