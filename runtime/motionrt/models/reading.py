"""``models_manifest.yaml`` -> `Manifest`, strictly: what is unknown, missing or of another type is an error."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from motionrt.errors import ManifestError
from motionrt.models.fields import Fields, listed, number, scalar, table, whole
from motionrt.models.manifest import Dataset, Manifest, Model, Statistic, TensorInfo, Tokenizer, Variant
from motionrt.untrusted import yaml_text
from motionrt.untrusted.files import read_utf8
from motionrt.untrusted.words import shown

SCHEMA = 1
TYPES = ("bool", "float16", "float32", "float64", "int32", "int64")


def load_manifest(path: str | Path) -> Manifest:
    """Read and check a manifest; the model files are not touched.

    Raises:
        ManifestError: no such file, no YAML, an unknown schema, a missing, unknown or repeated key, a value of the
            wrong type or out of range, a name that leads nowhere, a file that is named twice.
    """
    path = Path(path)
    manifest = manifest_of(_parsed(path), path)
    check_references(manifest)
    return manifest


def manifest_of(content: object, path: Path) -> Manifest:
    """The manifest of plain values; what one entry says of another is not checked yet.

    This much is also in ``_assets/models_manifest.schema.json``.
    """
    fields = Fields(content, path.name)
    if (schema := fields.integer("schema", least=0)) != SCHEMA:
        advice = "update motionrt (pip install --upgrade motionrt)" if schema > SCHEMA else "export the models again"
        raise ManifestError(f"{path}: schema version {schema} is not known (this motionrt reads {SCHEMA}); {advice}")
    models = fields.named("models", _model)
    fields.done()
    return Manifest(path, models)


def check_references(manifest: Manifest) -> None:
    """ManifestError where a default is none of the variants, or a file or a tensor is named twice."""
    files: dict[str, str] = {}
    for model in manifest.models.values():
        place = f"{manifest.path.name}.models.{model.name}"
        if model.default_variant not in model.variants:
            raise ManifestError(f"{place}.default_variant: there is no variant '{model.default_variant}'")
        _check_unique([tensor.name for tensor in (*model.inputs, *model.outputs)], f"{place}: inputs and outputs")
        _check_unique([statistic.name for statistic in model.statistics], f"{place}.statistics")
        for variant in model.variants.values():
            here = f"{place}.variants.{variant.name}"
            if (other := files.setdefault(variant.file.casefold(), here)) != here:
                raise ManifestError(f"{here}.file: '{variant.file}' is the file of {other}; each needs one of its own")


def _check_unique(names: Iterable[str], place: str) -> None:
    seen: set[str] = set()
    for name in names:
        if name in seen:
            raise ManifestError(f"{place}: '{name}' stands there twice")
        seen.add(name)


def _parsed(path: Path) -> Any:
    import yaml

    from motionrt.models.yaml_keys import unique_keys

    def fail(reason: str, line: int | None) -> ManifestError:
        return ManifestError(f"{path}{f':{line}' if line else ''}: {reason}")

    try:
        text = read_utf8(path, fail, "yaml_bytes")
    except FileNotFoundError as error:
        raise ManifestError(f"cannot read {path}: {error.strerror or error}") from error
    return yaml_text.parse(text, unique_keys(yaml), fail)


def _model(content: object, place: str) -> Model:
    fields = Fields(content, place)
    model = Model(
        name=place.rpartition(".")[2],
        description=fields.text("description"),
        licence=fields.text("licence"),
        attribution=fields.text("attribution"),
        training_data=fields.items("training_data", _dataset),
        recipe=fields.table("recipe", scalar),
        feature_statistics=fields.text("feature_statistics"),
        statistics=fields.optional("statistics", listed(_statistic)) or (),
        inputs=fields.items("inputs", _tensor),
        outputs=fields.items("outputs", _tensor),
        tokenizer=fields.optional("tokenizer", _tokenizer),
        default_variant=fields.text("default_variant"),
        variants=fields.named("variants", _variant),
        quality=fields.table("quality", scalar),
    )
    fields.done()
    return model


def _dataset(content: object, place: str) -> Dataset:
    fields = Fields(content, place)
    dataset = Dataset(fields.text("name"), fields.text("licence"))
    fields.done()
    return dataset


def _statistic(content: object, place: str) -> Statistic:
    fields = Fields(content, place)
    shape = fields.items("shape", whole)
    statistic = Statistic(fields.text("name"), shape, fields.sha256("sha256"), fields.text("source"))
    fields.done()
    return statistic


def _tensor(content: object, place: str) -> TensorInfo:
    fields = Fields(content, place)
    tensor = TensorInfo(
        fields.text("name"),
        fields.text("dtype"),
        fields.items("shape", _axis),
        fields.text("unit"),
        fields.text("meaning"),
    )
    fields.done()
    if tensor.dtype not in TYPES:
        raise ManifestError(f"{place}.dtype: expected one of {', '.join(TYPES)}, found {shown(tensor.dtype)}")
    return tensor


def _axis(content: object, place: str) -> int | str:
    if isinstance(content, str) and content.strip():
        return content
    if isinstance(content, bool | str) or not isinstance(content, int | float):
        raise ManifestError(f"{place}: an axis is a number or a name, found {shown(content)}")
    return whole(content, place)


def _tokenizer(content: object, place: str) -> Tokenizer:
    fields = Fields(content, place)
    tokenizer = Tokenizer(
        fields.file("file"), fields.sha256("sha256"), fields.integer("bytes"), fields.integer("max_tokens")
    )
    fields.done()
    return tokenizer


def _variant(content: object, place: str) -> Variant:
    fields = Fields(content, place)
    variant = Variant(
        name=place.rpartition(".")[2],
        file=fields.file("file"),
        sha256=fields.sha256("sha256"),
        bytes=fields.integer("bytes"),
        opset=fields.integer("opset"),
        ir_version=fields.integer("ir_version"),
        shipped=fields.flag("shipped"),
        quantisation=fields.text("quantisation"),
        tolerance=fields.table("tolerance", table(number)),
        parity=fields.table("parity", table(number)),
        producers=fields.table("producers", scalar),
        benchmark=fields.optional("benchmark", table(scalar)),
        quality=fields.optional("quality", table(scalar)) or {},
    )
    fields.done()
    return variant
