"""``motionrt models``: everything that the manifest says, and files that are not what it says."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

import pytest
from tiny_models import TINY, copy_tiny, edited

from motionrt.cli import main

TEXT = "models/tmr_text.tiny.onnx"


def enriched(folder: Path) -> Path:
    """The tiny manifest with everything that a model can have."""

    def add(content: dict[str, Any]) -> None:
        model = content["models"]["tmr_text"]
        model["statistics"] = [{"name": "mean", "shape": [263], "sha256": "a" * 64, "source": "models/tmr.safetensors"}]
        model["quality"] = {"test_R1": 32.0}
        variant = model["variants"]["tiny"]
        variant.update(benchmark={"p50_ms": 1.25, "threads": 1}, quality={"R3": 64.5})
        variant["tolerance"]["embedding"], variant["parity"]["embedding"] = (
            {"cosine_min": 0.995},
            {"cosine_min": 0.9991},
        )

    return edited(folder, add)


@pytest.mark.parametrize(
    "told",
    [
        "tmr_text: a tiny stand-in for tmr_text",
        "licence        Apache-2.0",
        "training data  none (none)",
        "recipe         command: python tests/fixtures/make_tiny_models.py",
        "mean (263), in models/tmr.safetensors",
        "test_R1: 32.0",
        "token_features  float32  (batch, tokens, 384)  1",
        "latent divided by its length",
        "variant tiny (taken by default)",
        "variant fp32 (not shipped: python -m motionrt_export all)",
        "embedding    cosine_min     >= 0.995  0.9991",
        "latent       max_abs_error      <= 0       0",
        "p50_ms: 1.25",
        "R3: 64.5",
        "ONNX opset 18, IR version 8",
    ],
)
def test_show_tells_everything(tmp_path: Path, capsys: pytest.CaptureFixture[str], told: str) -> None:
    assert main(["models", "show", "tmr_text", "--models", str(enriched(tmp_path))]) == 0
    shown = capsys.readouterr().out
    assert " ".join(told.split()) in " ".join(shown.split())
    assert max(map(len, shown.splitlines())) < 200


def test_show_tells_of_one_variant_where_one_is_asked_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["models", "show", "tmr_text", "--variant", "fp32", "--models", str(TINY)]) == 0
    shown = capsys.readouterr().out
    assert "variant fp32" in shown
    assert "variant tiny" not in shown
    assert "tokenizer.json, at most 128 tokens" in shown


def test_show_gives_programs_the_fields_of_the_manifest(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["models", "show", "tmr_text", "--variant", "tiny", "--json", "--models", str(enriched(tmp_path))]) == 0
    found = json.loads(capsys.readouterr().out)
    assert list(found["variants"]) == ["tiny"]
    assert found["variants"]["tiny"]["sha256"] == hashlib.sha256((TINY / TEXT).read_bytes()).hexdigest()
    assert found["variants"]["tiny"]["quality"] == {"R3": 64.5}
    assert found["statistics"][0]["shape"] == [263]
    assert found["inputs"][0]["unit"] == "1"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["walknet"], "has no model 'walknet'; it has: tmr_decoder, tmr_motion, tmr_student, tmr_text"),
        (["tmr_text", "--variant", "int9"], "model 'tmr_text' has no variant 'int9'; choose one of: fp32, tiny"),
    ],
)
def test_show_names_what_there_is(capsys: pytest.CaptureFixture[str], arguments: list[str], message: str) -> None:
    assert main(["models", "show", *arguments, "--models", str(TINY)]) == 1
    assert message in capsys.readouterr().err


def test_verify_names_file_checksums_and_sizes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = copy_tiny(tmp_path)
    whole = (folder / TEXT).read_bytes()
    (folder / TEXT).write_bytes(whole[:100])
    (folder / "models" / "tmr_motion.tiny.onnx").unlink()
    assert main(["models", "verify", "--models", str(folder)]) == 1
    error = capsys.readouterr().err
    expected, found = hashlib.sha256(whole).hexdigest(), hashlib.sha256(whole[:100]).hexdigest()
    assert f"{folder / TEXT}: sha256 expected {expected} ({len(whole)} bytes), found {found} (100 bytes)" in error
    assert "the file is cut short; install motionrt again" in error
    assert f"cannot read {folder / 'models' / 'tmr_motion.tiny.onnx'}" in error
    assert "2 of 10 files" in error


def test_verify_gives_programs_both_sizes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = copy_tiny(tmp_path)
    (folder / TEXT).write_bytes(b"x")
    assert main(["models", "verify", "--json", "--models", str(folder)]) == 1
    report = next(row for row in json.loads(capsys.readouterr().out) if row["state"] == "damaged")
    assert (report["model"], report["bytes"]) == ("tmr_text", 1)
    assert report["expected_bytes"] == (TINY / TEXT).stat().st_size
    assert "found" in report["problem"]


def test_a_whole_folder_verifies(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["models", "verify", "--models", str(TINY)]) == 0
    assert capsys.readouterr().err == ""
