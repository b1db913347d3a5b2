"""The manifest is read strictly: what is unknown, missing or of another type is named, with the remedy."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tiny_models import TINY, edited

from motionrt.errors import ManifestError, ModelNotFoundError
from motionrt.models import load_manifest

MANIFEST = TINY / "models_manifest.yaml"
Content = dict[str, Any]


def text_model(content: Content) -> Content:
    model: Content = content["models"]["tmr_text"]
    return model


def test_every_field_of_a_model_is_read() -> None:
    model = load_manifest(MANIFEST).model("sentence_encoder")
    assert model.default_variant == "tiny"
    assert [tensor.name for tensor in model.outputs] == ["token_features", "sentence_embedding"]
    assert model.inputs[0].dtype == "int64"
    assert model.outputs[0].shape == ("batch", "tokens", 384)
    assert model.tokenizer is not None
    assert model.tokenizer.max_tokens == 128
    assert model.variant().opset == 18
    assert not model.variant("fp32").shipped
    assert model.training_data[0].licence == "none"


def test_files_are_found_beside_the_manifest() -> None:
    manifest = load_manifest(MANIFEST)
    assert manifest.locate("models/tokenizer.json") == TINY / "models" / "tokenizer.json"


def test_values_are_frozen() -> None:
    model = load_manifest(MANIFEST).model("tmr_text")
    with pytest.raises(dataclasses.FrozenInstanceError):
        model.licence = "mine"  # type: ignore[misc]


def test_an_unknown_model_lists_the_known_ones() -> None:
    with pytest.raises(ModelNotFoundError, match=r"no model 'walknet'.*tmr_decoder.*tmr_text"):
        load_manifest(MANIFEST).model("walknet")


def test_an_unknown_variant_lists_the_known_ones() -> None:
    with pytest.raises(ModelNotFoundError, match="no variant 'int4'; choose one of: fp32, tiny"):
        load_manifest(MANIFEST).model("tmr_text").variant("int4")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda c: c.update(schema=2), r"schema version 2 is not known.*pip install --upgrade motionrt"),
        (lambda c: c.update(schema=0), r"schema version 0 is not known.*export the models again"),
        (lambda c: c.update(schema=True), r"schema: expected int, found True"),
        (lambda c: c.pop("schema"), r"'schema' is missing"),
        (lambda c: c.update(colour="red"), r"models_manifest.yaml: unknown key colour"),
        (lambda c: text_model(c).update(speed=3), r"models.tmr_text: unknown key speed.*upgrade"),
        (lambda c: text_model(c).pop("licence"), r"models.tmr_text: 'licence' is missing"),
        (lambda c: text_model(c).update(licence=3), r"tmr_text.licence: expected str, found 3"),
        (lambda c: text_model(c).update(default_variant="x"), r"there is no variant 'x'"),
        (lambda c: text_model(c).update(variants=[]), r"variants: expected dict, found \[\]"),
        (
            lambda c: text_model(c)["variants"]["tiny"].update(sha256="abc"),
            r"64 hexadecimal digits|64 lower-case",
        ),
        (lambda c: text_model(c)["variants"]["tiny"].update(file="/etc/passwd"), r"expected a relative path"),
        (lambda c: text_model(c)["variants"]["tiny"].update(file="../x.onnx"), r"expected a relative path"),
        (lambda c: text_model(c)["variants"]["tiny"].update(file="C:\\x.onnx"), r"expected a relative path"),
        (lambda c: text_model(c)["variants"]["tiny"].update(shipped="yes"), r"tiny.shipped: expected bool"),
        (lambda c: text_model(c)["inputs"][0].update(shape=[1.5]), r"inputs\[0\].shape\[0\]: an axis is"),
        (
            lambda c: text_model(c)["variants"]["tiny"].update(tolerance={"a": {"b": "x"}}),
            r"a.b: expected a number",
        ),
        (lambda c: text_model(c)["recipe"].update(x=[1]), r"recipe.x: expected a string, a number"),
        (lambda c: c["models"].update(tmr_text="none"), r"tmr_text: expected a mapping"),
    ],
)
def test_a_wrong_entry_is_named(tmp_path: Path, change: Callable[[Content], object], message: str) -> None:
    with pytest.raises(ManifestError, match=message):
        load_manifest(edited(tmp_path, change))


def test_a_file_that_is_no_yaml_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "models_manifest.yaml"
    path.write_text("models: [", encoding="utf-8")
    with pytest.raises(ManifestError, match="is not a YAML file"):
        load_manifest(path)


def test_a_yaml_tag_creates_no_object(tmp_path: Path) -> None:
    path = tmp_path / "models_manifest.yaml"
    path.write_text("!!python/object/apply:os.getcwd []", encoding="utf-8")
    with pytest.raises(ManifestError, match="is not a YAML file"):
        load_manifest(path)


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ManifestError, match=r"cannot read .*No such file"):
        load_manifest(tmp_path / "models_manifest.yaml")
