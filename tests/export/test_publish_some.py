"""Some of the models exported alone: the others' files and entries stay as they are."""

from __future__ import annotations

import hashlib
import json
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import cast

import numpy as np
import pytest
import yaml

pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")
pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")

from tiny_nets import TOKENIZER, TinySources, tiny_sources, tiny_walknet

from motionrt.errors import ManifestError
from motionrt.models import Sessions, load_manifest, verify
from motionrt.models.walknet import WalkModel
from motionrt_export.layout import Layout
from motionrt_export.measured import Measured
from motionrt_export.measures import Figures
from motionrt_export.proving import subject_of
from motionrt_export.publish import Proof, publish
from motionrt_export.sources import MissingCheckpointsError
from motionrt_export.validate import validate
from motionrt_export.walks import random_wishes
from motionrt_training.checkpoint import Network
from motionrt_training.networks.walknet import WalkNet

BOTH = ("tmr_student", "pose_prior")


class WithWishes(TinySources):
    """A WalkNet that knows wishes among the tiny networks."""

    def load(self, network: type[Network]) -> tuple[Network, Mapping[str, str]]:
        model, notes = super().load(network)
        return (cast("Network", tiny_walknet(wishes=True)) if network is WalkNet else model), notes


def exported(root: Path, *names: str, sources: TinySources | None = None) -> None:
    """Export these models of tiny networks into a folder."""
    made = sources or tiny_sources(root / "models")
    layout = Layout(root / "models_manifest.yaml", root / "models", root / "build" / "models")

    def file(model: str, variant: str, path: Path, exact: Path | None) -> Figures:
        return validate(subject_of(made, model, variant, path, exact, lengths=(1, 9), batches=(1, 2)))

    def pipeline(name: str, manifest: Path) -> dict[str, Figures]:
        raise AssertionError(f"{name} belongs to none of these models")

    publish(made, layout, Proof(file, pipeline), Measured(), lambda _: None, names)


def few_sources(root: Path) -> TinySources:
    sources = tiny_sources(root / "models")
    sources.every = 100
    return sources


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory) -> Path:
    root = tmp_path_factory.mktemp("both")
    exported(root, *BOTH, sources=few_sources(root))
    return root


@pytest.fixture
def copy(both: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(both, tmp_path, dirs_exist_ok=True))


def entries(root: Path) -> dict[str, object]:
    found: dict[str, object] = yaml.safe_load((root / "models_manifest.yaml").read_text(encoding="utf-8"))["models"]
    return found


def digests(root: Path) -> dict[str, str]:
    files = sorted(path for path in root.rglob("*") if path.is_file())
    return {path.relative_to(root).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def test_only_the_named_model_changes(copy: Path) -> None:
    before, files, sources = entries(copy), digests(copy), few_sources(copy)
    sources.text_student.model.leave.bias.data += 0.1
    (copy / "models" / "pose_prior.safetensors").unlink()  # not needed
    exported(copy, "tmr_student", sources=sources)
    after = entries(copy)
    assert [*after] == [*before] == [*BOTH]
    assert [name for name in before if before[name] != after[name]] == ["tmr_student"]
    assert {name for name, digest in digests(copy).items() if files[name] != digest} == {
        "models_manifest.yaml",
        "models/tmr_student.int8.onnx",
        "build/models/tmr_student.fp32.onnx",
        "build/models/tmr_student.fp16.onnx",
    }
    assert {report.state for report in verify(load_manifest(copy / "models_manifest.yaml"))} == {"ok"}


def test_a_model_that_the_manifest_lacked_takes_its_place(copy: Path) -> None:
    manifest = copy / "models_manifest.yaml"
    whole, content = manifest.read_bytes(), yaml.safe_load(manifest.read_text(encoding="utf-8"))
    del content["models"]["tmr_student"]
    manifest.write_text(yaml.safe_dump(content, sort_keys=False), encoding="utf-8")
    exported(copy, "tmr_student", sources=few_sources(copy))
    assert manifest.read_bytes() == whole


def test_a_walknet_that_knows_wishes_is_exported_with_them_and_the_runtime_asks_for_them(tmp_path: Path) -> None:
    tiny_sources(tmp_path / "models")
    exported(tmp_path, "walknet", sources=WithWishes(tmp_path / "models"))
    model = WalkModel(Sessions(tmp_path / "models_manifest.yaml"))
    assert model.wishes
    frames, speed = np.zeros((2, 30, 219), np.float32), np.ones(2, np.float32)
    frames[..., :216] = np.tile(np.eye(3, dtype=np.float32).ravel(), 24)
    wish = random_wishes(2, np.random.default_rng(0)).astype(np.float32)
    assert model(frames, speed).shape == model(frames, speed, wish).shape == (2, 219)


def test_a_name_that_is_no_model_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="there is no model tmr_poet; there are tmr_text, tmr_student"):
        exported(tmp_path, "tmr_poet")
    assert not (tmp_path / "models_manifest.yaml").exists()


def test_only_the_checkpoints_of_the_named_models_are_needed(tmp_path: Path) -> None:
    sources = tiny_sources(tmp_path / "models")
    (tmp_path / "models" / "text_student.safetensors").unlink()
    with pytest.raises(MissingCheckpointsError, match=r"no released model at \S*text_student\.safetensors; train"):
        exported(tmp_path, "tmr_student", sources=sources)


def test_a_damaged_manifest_is_not_written_over(copy: Path) -> None:
    manifest = copy / "models_manifest.yaml"
    manifest.write_text("schema: 1\nmodels: {walknet: 3}\n", encoding="utf-8")
    with pytest.raises(ManifestError, match="walknet"):
        exported(copy, "tmr_student")
    assert "walknet: 3" in manifest.read_text(encoding="utf-8")


def test_models_that_are_kept_keep_their_tokenizer(copy: Path) -> None:
    manifest, path = copy / "models_manifest.yaml", copy / "models" / "tokenizer.json"
    content = yaml.safe_load(manifest.read_text(encoding="utf-8"))
    content["models"]["pose_prior"]["tokenizer"] = content["models"]["tmr_student"]["tokenizer"]
    manifest.write_text(yaml.safe_dump(content, sort_keys=False), encoding="utf-8")
    words = json.loads(path.read_text(encoding="utf-8"))
    path.write_text(json.dumps(words, indent=1), encoding="utf-8")  # the same words, other bytes
    exported(copy, "tmr_student", sources=few_sources(copy))
    assert {report.state for report in verify(load_manifest(manifest))} == {"ok"}
    words["normalizer"]["lowercase"] = False
    path.write_text(json.dumps(words), encoding="utf-8")
    before = digests(copy)
    with pytest.raises(ValueError, match=r"tokenizer\.json is another one; export pose_prior as well"):
        exported(copy, "tmr_student")
    assert digests(copy) == before


def test_common_words_come_first_in_the_tokenizer(both: Path) -> None:
    found, given = (
        json.loads(path.read_text(encoding="utf-8")) for path in (both / "models" / "tokenizer.json", TOKENIZER)
    )
    assert found == given  # but for the order
    vocabulary = list(found["model"]["vocab"])
    assert vocabulary.index("[SEP]") < vocabulary.index("a") < vocabulary.index("walks") < vocabulary.index("##a")
