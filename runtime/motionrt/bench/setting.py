"""What the benchmarks share: models, inputs and a folder for files, each opened when first needed."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from contextlib import ExitStack
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionrt.bench.workload import Workload
from motionrt.models import Sessions, TextMotionModel, find_manifest, load_manifest
from motionrt.models.manifest import Manifest
from motionrt.models.tmr import chosen_tower
from motionrt.runtime import Runtime

if TYPE_CHECKING:
    from onnxruntime import SessionOptions

    from motionrt.locomotion.character_models import OnnxCharacterModels


class Setting:
    """Open models at one thread count; ``contextlib.closing`` removes its folder at the end.

    Args:
        models: the manifest or its folder, by default the shipped one.
        threads: of every model.
        work: the inputs.
        variant: which files of the models.
        session_options: for every session, instead of the runtime's own.
    """

    def __init__(
        self,
        models: str | None,
        threads: int,
        work: Workload,
        *,
        variant: str | None = None,
        session_options: SessionOptions | None = None,
    ) -> None:
        self.models, self.threads, self.work, self.variant = models, threads, work, variant
        self.runtime = Runtime(models, threads=threads, variant=variant, session_options=session_options)
        self._closing = ExitStack()

    def close(self) -> None:
        """Remove the folder."""
        self._closing.close()

    @cached_property
    def manifest(self) -> Manifest:
        """Of the models."""
        return load_manifest(find_manifest(self.models))

    @cached_property
    def full_text(self) -> TextMotionModel:
        """The encoders with the full text tower, in the same sessions."""
        return TextMotionModel(self.runtime.model.sessions, variant=self.variant, text_tower="full")

    @property
    def character_models(self) -> OnnxCharacterModels:
        """The models of walking and acting."""
        character_models: Any = self.runtime.character_models
        found: OnnxCharacterModels = character_models
        return found

    @cached_property
    def folder(self) -> Path:
        """A folder for the files of this setting."""
        return Path(self._closing.enter_context(tempfile.TemporaryDirectory(prefix="motionrt-bench-")))

    def sessions(self, model: str) -> Sessions:
        """The sessions that the runtime opens a model in."""
        ours = self.runtime.model.sessions
        return self.character_models.sessions if model in MOVING else ours

    def named(self, needed: Sequence[str]) -> list[str]:
        """The models by their names, with that of the text tower that is taken by default."""
        return [chosen_tower(self.manifest, None) if name == TEXT_TOWER else name for name in needed]

    def missing(self, needed: Sequence[str]) -> list[str]:
        """Those of the models that the manifest does not hold."""
        return [name for name in self.named(needed) if name not in self.manifest.models]


TEXT_TOWER = "text tower"
"""Stands for the model that embeds texts."""
MOVING = ("walknet", "transnet", "pose_prior")
