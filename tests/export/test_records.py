"""Licence and data of the manifest are those that the checkpoint states; what it does not state is not made up."""

from __future__ import annotations

import hashlib
import json
from dataclasses import replace
from pathlib import Path

import pytest
import yaml

pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")
pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")

from tiny_nets import tiny_pose_prior, tiny_sources

from motionrt.models import load_manifest
from motionrt_export.cards import CARDS
from motionrt_export.records import KNOWN, is_known, terms_of
from motionrt_export.sources import MissingCheckpointsError, Release, Source, Sources
from motionrt_training.checkpoint import release, save_atomically

MINE = [{"source": "babel", "licence": "for research alone", "origin": "the Institute", "recordings": 12}]


def pose_prior(tmp_path: Path, **notes: str) -> Source:
    source = tiny_sources(tmp_path).source("pose_prior")
    assert source.release is not None
    return replace(source, release=replace(source.release, notes=notes))


def test_a_record_becomes_licence_and_data(tmp_path: Path) -> None:
    terms = terms_of(pose_prior(tmp_path, licence="CC-BY-NC-4.0", data=json.dumps(MINE)))
    assert terms.licence == "CC-BY-NC-4.0"
    assert terms.training_data == (("babel of the Institute, 12 recordings", "for research alone"),)


def test_what_nobody_stated_is_not_stated_and_never_the_project_s(tmp_path: Path) -> None:
    for notes in ({}, {"licence": "not stated", "data": "[]"}):
        terms = terms_of(pose_prior(tmp_path, **notes))
        assert (terms.licence, terms.training_data) == ("not stated", (("not stated", "not stated"),))


def test_a_text_encoder_also_names_what_it_was_derived_from(tmp_path: Path) -> None:
    source = tiny_sources(tmp_path).source("tmr_text")
    assert source.release is not None
    named = replace(source, release=replace(source.release, notes={"licence": "mine", "data": json.dumps(MINE)}))
    assert next(name for name, _ in terms_of(named).training_data).startswith("babel")
    assert terms_of(named).training_data[1] == CARDS["tmr_text"].training_data[-1]


def test_the_project_s_own_checkpoints_are_known_by_their_bytes(tmp_path: Path) -> None:
    file = tmp_path / "pose_prior.safetensors"
    file.write_bytes(b"the bytes of a release")
    known = tmp_path / "records.yaml"
    digest = "d9a0d2e6c5c7e0b8" * 4
    known.write_text(f"checkpoints:\n  - {digest}\n", encoding="utf-8")
    mine = Release(None, {}, file)
    assert not is_known(mine, known)
    known.write_text(f"checkpoints: [{hashlib.sha256(file.read_bytes()).hexdigest()}]\n", encoding="utf-8")
    assert is_known(mine, known)
    assert not is_known(mine, tmp_path / "absent.yaml")


def test_every_shipped_checkpoint_has_a_licence() -> None:
    manifest = load_manifest(KNOWN.parents[1] / "models_manifest.yaml")
    assert {model.licence for model in manifest.models.values()} == {"Apache-2.0"}
    rows = yaml.safe_load(KNOWN.read_text(encoding="utf-8"))["checkpoints"]
    assert all(len(row) == 64 for row in rows)


def test_the_record_travels_from_the_trainer_to_the_release(tmp_path: Path) -> None:
    from safetensors import safe_open

    model = tiny_pose_prior()
    state = {"model": model.state_dict(), "notes": {"network": model.config}, "step": 4, "elapsed": 60.0, "data": MINE}
    save_atomically(state, tmp_path / "best.pt")
    for licence, stated in (("MIT", "MIT"), (None, "not stated")):
        release(tmp_path / "best.pt", tmp_path / "pose_prior.safetensors", "pose_prior", licence=licence)
        with safe_open(tmp_path / "pose_prior.safetensors", framework="pt") as file:
            metadata = file.metadata()
        assert (metadata["licence"], json.loads(metadata["data"])) == (stated, MINE)


def test_one_network_is_exported_with_the_project_s_others_to_try_it(tmp_path: Path) -> None:
    mine, helpers = tmp_path / "mine", tmp_path / "project"
    for folder, names in ((mine, ["transnet"]), (helpers, ["walknet", "pose_prior"])):
        folder.mkdir()
        for name in names:
            (folder / f"{name}.safetensors").touch()
    sources = Sources(mine, helpers)
    sources.check(["transnet"])
    from motionrt_training.networks.walknet import WalkNet

    assert sources.checkpoint(WalkNet) == helpers / "walknet.safetensors"
    with pytest.raises(MissingCheckpointsError, match=r"mine/walknet\.safetensors"):
        sources.check(["walknet"])
    with pytest.raises(MissingCheckpointsError, match=r"mine/tmr\.safetensors"):
        sources.check()
