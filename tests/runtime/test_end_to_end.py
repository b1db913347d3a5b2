"""The whole road in fresh processes with tiny ONNX files: a folder, a gallery, hits, BVH files."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from motions import random_motion, standing, walking

from motionrt import Runtime, load_motion
from motionrt.bench.search import motion_case
from motionrt.formats import save_motion
from motionrt.retrieval.head import sealed

MODELS = Path(__file__).parents[1] / "fixtures" / "models"


def motionrt(*arguments: object, code: int = 0) -> Any:
    """What the command prints as JSON; stderr goes into the failure message."""
    command = [sys.executable, "-m", "motionrt", *map(str, arguments), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=False)
    assert done.returncode == code, done.stderr
    return json.loads(done.stdout) if done.stdout else done.stderr


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An unseen rig, spaces, other letters, nested folders, wrong frame times, broken files."""
    folder = tmp_path_factory.mktemp("my library")
    motions = {
        "Walk Cycles/01 slow walk.bvh": walking(100, speed=0.6),
        "Walk Cycles/Größe/2 läuft.BVH": walking(240, turn=0.5),
        "idle.bvh": standing(80),
        "日本語/踊る.bvh": random_motion(90, seed=3),
        "odd time.bvh": random_motion(400, fps=30.0, seed=5),
        "packed.npz": random_motion(60, fps=120.0, seed=6),
    }
    for name, motion in motions.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        save_motion(motion, path.with_suffix(path.suffix.lower())).rename(path)
        if path.suffix.lower() == ".bvh":
            path.write_text(_strange(path.read_text(encoding="utf-8")), encoding="utf-8")
    text = (folder / "idle.bvh").read_text(encoding="utf-8")
    odd = folder / "odd time.bvh"
    odd.write_text(odd.read_text(encoding="utf-8").replace("0.033333", "0.0416667"), encoding="utf-8")
    (folder / "cut.bvh").write_text(text[: text.index("MOTION") // 2], encoding="utf-8")  # amid its joints
    (folder / "Walk Cycles" / "not a motion.bvh").write_bytes(bytes(range(256)))
    (folder / "nan.bvh").write_text(text.replace("0.0", "nan"), encoding="utf-8")
    return folder


def _strange(text: str) -> str:
    """The rig of a studio of its own: a prefix on every joint."""
    for name in ("pelvis", "left_", "right_", "spine", "neck", "head"):
        text = text.replace(f" {name}", f" studio:{name}")
    return text


@pytest.fixture(scope="module")
def built(library: Path) -> dict[str, Any]:
    found: dict[str, Any] = motionrt("gallery", "build", library, "--models", MODELS, "--jobs", 2, code=3)
    return found


def test_all_good_files_are_indexed_and_broken_ones_listed(library: Path, built: dict[str, Any]) -> None:
    assert (built["clips"], built["added"]) == (6, 6)
    assert [skipped["path"] for skipped in built["skipped"]] == [
        "Walk Cycles/not a motion.bvh", "cut.bvh", "nan.bvh",
    ]  # fmt: skip
    assert all(skipped["reason"] for skipped in built["skipped"])
    assert motionrt("gallery", "info", library)["clips"] == 6


def test_the_command_and_the_library_give_the_same_hits(library: Path, built: dict[str, Any]) -> None:
    hits = motionrt("retrieve", "a person walks", "--gallery", library, "-k", 4, "--models", MODELS)
    runtime = Runtime(MODELS, threads=1)
    expected = runtime.retrieve("a person walks", 4, library)
    assert [hit["id"] for hit in hits] == [hit.id for hit in expected]
    np.testing.assert_allclose([hit["score"] for hit in hits], [hit.score for hit in expected], atol=1e-5)
    query = runtime.embed_text("a person walks")
    best = load_motion(hits[0]["path"]).between(hits[0]["start"], hits[0]["end"])
    assert runtime.embed_motion(best) @ query == pytest.approx(hits[0]["cosine"], abs=0.02)


def test_hits_are_saved_in_their_own_rig(library: Path, built: dict[str, Any], tmp_path: Path) -> None:
    hits = motionrt("retrieve", "dance", "--gallery", library, "--models", MODELS, "--save", tmp_path / "hits")
    saved = sorted(path for path in (tmp_path / "hits").iterdir() if path.suffix != ".asf")
    assert len(saved) == len(hits) == 6
    assert load_motion(saved[0]).frames > 0


def test_another_models_gallery_is_refused(library: Path, built: dict[str, Any]) -> None:
    head_path = library / ".motionrt-gallery" / "gallery.json"
    original = head_path.read_bytes()
    head = json.loads(original)
    head["model"]["fingerprint"] = "0" * 64
    head_path.write_bytes(sealed({name: value for name, value in head.items() if name != "checksum"}))
    try:
        message = motionrt("retrieve", "dance", "--gallery", library, "--models", MODELS, code=1)
    finally:
        head_path.write_bytes(original)
    assert message.startswith("motionrt: error: the gallery ")
    assert "build it again: motionrt gallery build" in message


def test_models_are_listed_and_verified() -> None:
    assert [model["name"] for model in motionrt("models", "list", "--models", MODELS)] == [
        "tmr_text", "tmr_student", "tmr_motion", "tmr_decoder",
    ]  # fmt: skip
    reports = motionrt("models", "verify", "--models", MODELS)
    assert {report["state"] for report in reports} == {"ok", "not built"}


def test_a_damaged_model_fails_the_verification(tmp_path: Path) -> None:
    for path in MODELS.rglob("*"):
        if path.is_file():
            target = tmp_path / path.relative_to(MODELS)
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(path.read_bytes())
    (tmp_path / "models" / "tmr_text.tiny.onnx").write_bytes(b"broken")
    reports = motionrt("models", "verify", "--models", tmp_path, code=1)
    assert [report["model"] for report in reports if report["state"] == "damaged"] == ["tmr_text"]


def test_a_missing_manifest_is_one_line(tmp_path: Path) -> None:
    message = motionrt("models", "list", "--models", tmp_path, code=1)
    assert message.count("\n") == 1
    assert os.fspath(tmp_path) in message


def test_the_benchmark_runs_in_processes_of_its_own() -> None:
    found = motionrt("bench", "--quick", "--threads", 1, "--models", MODELS)
    assert [run["threads"] for run in found["runs"]] == [1]
    run = found["runs"][0]
    names = {case["case"] for case in run["cases"]}
    assert {"text encoding", motion_case(1), "search 10,000", "body parts of a text"} <= names
    assert all(0 < case["p50_ms"] <= case["p95_ms"] for case in run["cases"])
    assert run["cold_start"]["seconds"] > 0
    assert {"processor", "cores", "system"} <= set(found["machine"])
