"""``models_manifest.yaml`` as frozen values: what ships, what it takes and gives, how it was made."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from motionrt.errors import ModelNotFoundError
from motionrt.models.fields import Scalar

MANIFEST_NAME = "models_manifest.yaml"

Figures = Mapping[str, Mapping[str, float]]  # output -> measure -> number


@dataclass(frozen=True)
class TensorInfo:
    """An input or output; ``shape`` holds numbers and the names of dynamic axes."""

    name: str
    dtype: str
    shape: tuple[int | str, ...]
    unit: str
    meaning: str


@dataclass(frozen=True)
class Variant:
    """One file of a model.

    Attributes:
        file: relative to the manifest, with forward slashes.
        shipped: whether the file comes with motionrt; others are built with ``python -m motionrt_export``.
        quantisation: which layers hold how many bits, in words.
        tolerance: what is promised of every output against the torch module: ``cosine_min``,
            ``max_abs_error``.
        parity: the same measures as found when the file was made.
        producers: the versions of the programs that made the file.
        benchmark: milliseconds of one standard call, and of the torch module beside it, where they were measured.
        quality: what is made with this file, by the measures of its task.
    """

    name: str
    file: str
    sha256: str
    bytes: int
    opset: int
    ir_version: int
    shipped: bool
    quantisation: str
    tolerance: Figures
    parity: Figures
    producers: Mapping[str, Scalar]
    benchmark: Mapping[str, Scalar] | None
    quality: Mapping[str, Scalar]


@dataclass(frozen=True)
class Statistic:
    """Numbers about the training data that a graph holds inside, such as the mean of every feature.

    ``sha256`` is that of the float32 numbers, little endian, in C order; ``source`` the file that has them by ``name``.
    """

    name: str
    shape: tuple[int, ...]
    sha256: str
    source: str


@dataclass(frozen=True)
class Tokenizer:
    """The tokenizer file of a text model; longer texts are cut at ``max_tokens``."""

    file: str
    sha256: str
    bytes: int
    max_tokens: int


@dataclass(frozen=True)
class Dataset:
    """Data that a model was trained on."""

    name: str
    licence: str


@dataclass(frozen=True)
class Model:
    """A model with its variants; ``feature_statistics`` says in words what its ``statistics`` are."""

    name: str
    description: str
    licence: str
    attribution: str
    training_data: tuple[Dataset, ...]
    recipe: Mapping[str, Scalar]
    feature_statistics: str
    statistics: tuple[Statistic, ...]
    inputs: tuple[TensorInfo, ...]
    outputs: tuple[TensorInfo, ...]
    tokenizer: Tokenizer | None
    default_variant: str
    variants: Mapping[str, Variant]
    quality: Mapping[str, Scalar]

    def variant(self, name: str | None = None) -> Variant:
        """The variant called ``name``, or the default one; ModelNotFoundError lists those there are."""
        name = self.default_variant if name is None else name
        if name not in self.variants:
            known = ", ".join(sorted(self.variants))
            raise ModelNotFoundError(f"model '{self.name}' has no variant '{name}'; choose one of: {known}")
        return self.variants[name]


@dataclass(frozen=True)
class Manifest:
    """All models of one manifest; ``root`` is the folder that its file names are relative to."""

    path: Path
    models: Mapping[str, Model]

    @property
    def root(self) -> Path:
        """The folder that files in the manifest are relative to."""
        return self.path.parent

    def model(self, name: str) -> Model:
        """The model called ``name``; ModelNotFoundError lists those there are."""
        if name not in self.models:
            known = ", ".join(sorted(self.models))
            raise ModelNotFoundError(f"{self.path} has no model '{name}'; it has: {known}")
        return self.models[name]

    def variant(self, model: str, name: str | None = None) -> Variant:
        """The variant of a model that somebody means who asks all models for ``name``.

        A model that lacks what others have (the pose prior has no ``int8``) gives its default one; None is the default.

        Raises:
            ModelNotFoundError: no such model, or no model at all has such a variant.
        """
        found = self.model(model)
        if name is not None and name not in found.variants and name in self.variants:
            return found.variant()
        return found.variant(name)

    @property
    def variants(self) -> frozenset[str]:
        """The names of all variants of all models."""
        return frozenset(name for model in self.models.values() for name in model.variants)

    def locate(self, file: str) -> Path:
        """The path of a file that the manifest names."""
        return self.root.joinpath(*PurePosixPath(file).parts)
