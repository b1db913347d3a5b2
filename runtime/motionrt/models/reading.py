"""``models_manifest.yaml`` -> `Manifest`, strictly: what is unknown, missing or of another type is an error."""

from __future__ import annotations

from pathlib import Path, PurePosixPath
from typing import Any

from motionrt.errors import ManifestError
from motionrt.models.fields import Fields, number, scalar, table
from motionrt.models.manifest import Dataset, Manifest, Model, TensorInfo, Tokenizer, Variant

SCHEMA = 1


def load_manifest(path: str | Path) -> Manifest:
    """Read and check a manifest; the model files are not touched.

    Raises:
        ManifestError: no such file, no YAML, an unknown schema, a missing or unknown key, a wrong type.
    """
    path = Path(path)
    fields = Fields(_parsed(path), path.name)
    if (schema := fields.integer("schema")) != SCHEMA:
        advice = "update motionrt (pip install --upgrade motionrt)" if schema > SCHEMA else "export the models again"
        raise ManifestError(f"{path}: schema version {schema} is not known (this motionrt reads {SCHEMA}); {advice}")
    models = fields.named("models", _model)
    fields.done()
    return Manifest(path, models)


def _parsed(path: Path) -> Any:
    import yaml

    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        return yaml.load(path.read_text(encoding="utf-8"), loader)  # a safe loader, either of the two
    except OSError as error:
        raise ManifestError(f"cannot read {path}: {error.strerror or error}") from error
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise ManifestError(f"{path} is not a YAML file: {error}") from error


def _model(content: object, place: str) -> Model:
    fields = Fields(content, place)
    model = Model(
        name=place.rpartition(".")[2],
        description=fields.text("description"),
        licence=fields.text("licence"),
        attribution=fields.text("attribution"),
        training_data=fields.items("training_data", _dataset),
        recipe=fields.named("recipe", scalar),
        feature_statistics=fields.text("feature_statistics"),
        inputs=fields.items("inputs", _tensor),
        outputs=fields.items("outputs", _tensor),
        tokenizer=fields.optional("tokenizer", _tokenizer),
        default_variant=fields.text("default_variant"),
        variants=fields.named("variants", _variant),
        quality=fields.named("quality", scalar),
    )
    fields.done()
    if model.default_variant not in model.variants:
        raise ManifestError(f"{place}.default_variant: there is no variant '{model.default_variant}'")
    return model


def _dataset(content: object, place: str) -> Dataset:
    fields = Fields(content, place)
    dataset = Dataset(fields.text("name"), fields.text("licence"))
    fields.done()
    return dataset


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
    return tensor


def _axis(content: object, place: str) -> int | str:
    if isinstance(content, bool) or not isinstance(content, int | str):
        raise ManifestError(f"{place}: an axis is a number or a name, found {content!r}")
    return content


def _tokenizer(content: object, place: str) -> Tokenizer:
    fields = Fields(content, place)
    tokenizer = Tokenizer(_file(fields), fields.sha256("sha256"), fields.integer("bytes"), fields.integer("max_tokens"))
    fields.done()
    return tokenizer


def _variant(content: object, place: str) -> Variant:
    fields = Fields(content, place)
    variant = Variant(
        name=place.rpartition(".")[2],
        file=_file(fields),
        sha256=fields.sha256("sha256"),
        bytes=fields.integer("bytes"),
        opset=fields.integer("opset"),
        ir_version=fields.integer("ir_version"),
        shipped=fields.flag("shipped"),
        quantisation=fields.text("quantisation"),
        tolerance=fields.named("tolerance", table(number)),
        parity=fields.named("parity", table(number)),
        producers=fields.named("producers", scalar),
        benchmark=fields.optional("benchmark", table(scalar)),
    )
    fields.done()
    return variant


def _file(fields: Fields) -> str:
    name = fields.text("file")
    path = PurePosixPath(name)
    if path.is_absolute() or ".." in path.parts or "\\" in name or ":" in name:
        raise ManifestError(f"{fields.place}.file: expected a relative path with forward slashes, found {name!r}")
    return name
