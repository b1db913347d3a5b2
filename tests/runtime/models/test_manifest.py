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


def tiny(content: Content) -> Content:
    variant: Content = text_model(content)["variants"]["tiny"]
    return variant


def test_every_field_of_a_model_is_read() -> None:
    model = load_manifest(MANIFEST).model("tmr_text")
    assert model.default_variant == "tiny"
    assert [tensor.name for tensor in model.outputs] == ["embedding", "latent", "token_features", "sentence_embedding"]
    assert model.inputs[0].dtype == "int64"
    assert model.outputs[2].shape == ("batch", "tokens", 384)
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
        (lambda c: c.update(schema=True), r"schema: expected a whole number from 0, found True"),
        (lambda c: c.update(models={}), r"models: expected at least one entry"),
        (lambda c: c["models"].update({"Tmr.text": {}}), r"models: a name has lower-case letters.*'Tmr.text'"),
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
        (
            lambda c: text_model(c)["inputs"][0].update(shape=[1.5]),
            r"shape\[0\]: expected a whole number from 1, found 1.5",
        ),
        (
            lambda c: text_model(c)["inputs"][0].update(shape=[True]),
            r"inputs\[0\].shape\[0\]: an axis is a number or a name",
        ),
        (
            lambda c: text_model(c)["inputs"][0].update(dtype="float31"),
            r"inputs\[0\].dtype: expected one of bool, float16",
        ),
        (
            lambda c: text_model(c)["inputs"][0].update(name="latent"),
            r"inputs and outputs: 'latent' stands there twice",
        ),
        (lambda c: tiny(c).update(bytes=-5), r"tiny.bytes: expected a whole number from 1, found -5"),
        (lambda c: tiny(c).update(bytes=float("nan")), r"tiny.bytes: expected a whole number from 1, found nan"),
        (lambda c: tiny(c).update(bytes="5 MB"), r"tiny.bytes: expected a whole number from 1, found '5 MB'"),
        (lambda c: tiny(c).update(opset=0), r"tiny.opset: expected a whole number from 1, found 0"),
        (
            lambda c: tiny(c)["tolerance"].update(latent={"max_abs_error": float("nan")}),
            r"expected a number, and a finite",
        ),
        (
            lambda c: tiny(c)["parity"].update(latent={"max_abs_error": float("inf")}),
            r"expected a number, and a finite",
        ),
        (
            lambda c: tiny(c).update(quality={"R1": float("-inf")}),
            r"tiny.quality.R1: expected a string, a finite number",
        ),
        (
            lambda c: tiny(c).update(file="build/tmr_text.fp32.onnx"),
            r"tiny.file: .* is the file of .*fp32; each needs one",
        ),
        (
            lambda c: tiny(c).update(file="MODELS/TMR_MOTION.TINY.ONNX"),
            r"is the file of .*tmr_text.variants.tiny; each needs",
        ),
        (lambda c: tiny(c).update(file="models/../../x.onnx"), r"expected a relative path .* stays beneath"),
        (lambda c: tiny(c).update(file=""), r"tiny.file: expected a relative path"),
        (lambda c: tiny(c).update(file="models/x.onnx\n"), r"tiny.file: expected a relative path"),
        (lambda c: tiny(c).update(file="./x.onnx"), r"tiny.file: expected a relative path"),
        (lambda c: tiny(c).update(sha256="a" * 64 + "\n"), r"64 lower-case"),
        (lambda c: text_model(c).update(description=" "), r"tmr_text.description: expected a text"),
        (lambda c: text_model(c).update(statistics=[{"name": "mean"}]), r"statistics\[0\]: 'shape' is missing"),
        (lambda c: text_model(c).update(statistics={}), r"statistics: expected a list"),
        (
            lambda c: text_model(c)["variants"]["tiny"].update(tolerance={"a": {"b": "x"}}),
            r"a.b: expected a number",
        ),
        (lambda c: text_model(c)["recipe"].update(x=[1]), r"recipe.x: expected a string, a finite number"),
        (lambda c: c["models"].update(tmr_text="none"), r"tmr_text: expected a mapping"),
    ],
)
def test_a_wrong_entry_is_named(tmp_path: Path, change: Callable[[Content], object], message: str) -> None:
    with pytest.raises(ManifestError, match=message):
        load_manifest(edited(tmp_path, change))


def test_a_file_that_is_no_yaml_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "models_manifest.yaml"
    path.write_text("models: [", encoding="utf-8")
    with pytest.raises(ManifestError, match="is not YAML"):
        load_manifest(path)


def test_a_key_that_stands_there_twice_is_named_with_its_line(tmp_path: Path) -> None:
    manifest = edited(tmp_path, lambda c: c)
    lines = manifest.read_text(encoding="utf-8").splitlines()
    at = next(i for i, line in enumerate(lines) if "licence:" in line)
    manifest.write_text("\n".join([*lines[: at + 1], lines[at], *lines[at + 1 :]]), encoding="utf-8")
    with pytest.raises(ManifestError, match=rf"yaml:{at + 2}: .*the key 'licence' stands there twice"):
        load_manifest(manifest)


def test_a_variant_that_others_have_is_the_default_of_a_model_that_lacks_it(tmp_path: Path) -> None:
    manifest = load_manifest(edited(tmp_path, lambda c: text_model(c)["variants"].pop("fp32")))
    assert manifest.variant("tmr_motion", "fp32").name == "fp32"
    assert manifest.variant("tmr_text", "fp32").name == "tiny"
    assert manifest.variant("tmr_text").name == "tiny"
    with pytest.raises(ModelNotFoundError, match="'tmr_text' has no variant 'int9'; choose one of: tiny"):
        manifest.variant("tmr_text", "int9")
    with pytest.raises(ModelNotFoundError, match="no variant 'fp32'"):
        manifest.model("tmr_text").variant("fp32")


def test_statistics_benchmarks_and_quality_are_read(tmp_path: Path) -> None:
    statistic = {"name": "mean", "shape": [263], "sha256": "0" * 64, "source": "models/tmr.safetensors"}

    def add(content: Content) -> None:
        text_model(content)["statistics"] = [statistic]
        tiny(content).update(benchmark={"p50_ms": 1.5, "threads": 1}, quality={"R1": 59.5})

    model = load_manifest(edited(tmp_path, add)).model("tmr_text")
    assert dataclasses.asdict(model.statistics[0]) == {**statistic, "shape": (263,)}
    assert model.variant().benchmark == {"p50_ms": 1.5, "threads": 1}
    assert model.variant().quality == {"R1": 59.5}
    assert model.variant("fp32").quality == {}


def test_a_yaml_tag_creates_no_object(tmp_path: Path) -> None:
    path = tmp_path / "models_manifest.yaml"
    path.write_text("!!python/object/apply:os.getcwd []", encoding="utf-8")
    with pytest.raises(ManifestError, match="is not YAML"):
        load_manifest(path)


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ManifestError, match=r"cannot read .*No such file"):
        load_manifest(tmp_path / "models_manifest.yaml")
