"""A tampered, truncated, swapped or missing file is refused with its name, expected and found checksum."""

from __future__ import annotations

import hashlib
from pathlib import Path

import pytest
from tiny_models import TINY, copy_tiny, edited

from motionrt.errors import ChecksumError, ModelFileError, ModelNotFoundError
from motionrt.models import Sessions, TextMotionModel, load_manifest, verify

TEXT, MOTION = "models/tmr_text.tiny.onnx", "models/tmr_motion.tiny.onnx"
TINY_MODELS = ("tmr_text", "tmr_student", "tmr_motion", "tmr_decoder")
EXPECTED = hashlib.sha256((TINY / TEXT).read_bytes()).hexdigest()


def tampered(folder: Path) -> None:
    content = bytearray((folder / TEXT).read_bytes())
    content[len(content) // 2] ^= 1
    (folder / TEXT).write_bytes(content)


def truncated(folder: Path) -> None:
    (folder / TEXT).write_bytes((folder / TEXT).read_bytes()[:-1])


def swapped(folder: Path) -> None:
    (folder / TEXT).write_bytes((folder / MOTION).read_bytes())


def emptied(folder: Path) -> None:
    (folder / TEXT).write_bytes(b"")


@pytest.mark.parametrize("damage", [tampered, truncated, swapped, emptied])
def test_a_damaged_model_is_refused_before_it_is_opened(tmp_path: Path, damage) -> None:
    folder = copy_tiny(tmp_path)
    damage(folder)
    found = hashlib.sha256((folder / TEXT).read_bytes()).hexdigest()
    with pytest.raises(ChecksumError) as caught:
        Sessions(folder).session("tmr_text")
    for part in (str(folder / TEXT), EXPECTED, found, "install motionrt again"):
        assert part in str(caught.value)


@pytest.mark.parametrize(
    ("damage", "guess"),
    [
        (tampered, "is damaged or was exchanged; install motionrt again"),
        (truncated, "is cut short"),
        (swapped, "this is the tiny file of tmr_motion, under another name"),
        (emptied, r"found [0-9a-f]{64} \(0 bytes\): the file is cut short"),
    ],
)
def test_the_message_says_what_probably_happened(tmp_path: Path, damage, guess: str) -> None:
    folder = copy_tiny(tmp_path)
    damage(folder)
    with pytest.raises(ChecksumError, match=guess):
        Sessions(folder).session("tmr_text")


def test_a_whole_file_of_another_size_than_told_is_refused(tmp_path: Path) -> None:
    manifest = edited(tmp_path, lambda c: c["models"]["tmr_text"]["variants"]["tiny"].update(bytes=7))
    with pytest.raises(ChecksumError, match=rf"expected {EXPECTED} \(7 bytes\), found {EXPECTED} .*the manifest was"):
        Sessions(manifest).session("tmr_text")


def test_a_folder_in_the_place_of_a_file_is_refused(tmp_path: Path) -> None:
    folder = copy_tiny(tmp_path)
    (folder / TEXT).unlink()
    (folder / TEXT).mkdir()
    with pytest.raises(ModelFileError, match=r"cannot read .*tmr_text\.tiny\.onnx"):
        Sessions(folder).session("tmr_text")


def test_a_damaged_file_that_is_not_shipped_is_built_again(tmp_path: Path) -> None:
    folder = copy_tiny(tmp_path)
    (folder / "build").mkdir()
    (folder / "build" / "tmr_text.fp32.onnx").write_bytes(b"x")
    with pytest.raises(
        ChecksumError, match=r"\(1 bytes\).*build it again, in a checkout: python -m motionrt_export all"
    ):
        Sessions(folder).session("tmr_text", "fp32")


def test_a_variant_that_only_others_have_opens_the_default(tmp_path: Path) -> None:
    sessions = Sessions(edited(tmp_path, lambda c: c["models"]["tmr_motion"]["variants"].pop("fp32")))
    assert sessions.session("tmr_motion", "fp32") is sessions.session("tmr_motion")
    with pytest.raises(ModelNotFoundError, match="no variant 'int9'"):
        sessions.session("tmr_motion", "int9")


def test_a_fingerprint_is_that_of_the_files_that_are_opened(tmp_path: Path) -> None:
    manifest = edited(tmp_path, lambda c: c["models"]["tmr_motion"]["variants"].pop("fp32"))
    prints = {variant: TextMotionModel(manifest, variant=variant).fingerprint for variant in (None, "tiny", "fp32")}
    assert prints[None] == prints["tiny"] != prints["fp32"]


def test_other_models_of_the_folder_still_open(tmp_path: Path) -> None:
    folder = copy_tiny(tmp_path)
    tampered(folder)
    assert Sessions(folder).session("tmr_motion").get_inputs()[0].name == "motion"


def test_a_damaged_tokenizer_is_refused(tmp_path: Path) -> None:
    folder = copy_tiny(tmp_path)
    path = folder / "models" / "tokenizer.json"
    path.write_bytes(path.read_bytes() + b" ")
    with pytest.raises(ChecksumError, match=r"tokenizer\.json"):
        TextMotionModel(folder).embed_text(["walk"])


def test_a_missing_model_is_refused_with_its_path(tmp_path: Path) -> None:
    folder = copy_tiny(tmp_path)
    (folder / TEXT).unlink()
    with pytest.raises(ModelFileError, match=r"cannot read .*tmr_text\.tiny\.onnx.*install motionrt again"):
        Sessions(folder).session("tmr_text")


def test_a_variant_that_is_not_shipped_says_how_to_build_it() -> None:
    with pytest.raises(ModelFileError, match=r"not shipped.*python -m motionrt_export all"):
        Sessions(TINY).session("tmr_text", "fp32")


def test_verify_finds_the_shipped_files_whole_and_the_others_not_built() -> None:
    reports = verify(load_manifest(TINY / "models_manifest.yaml"))
    assert {(r.model, r.variant): r.state for r in reports} == {
        **{(m, "tiny"): "ok" for m in TINY_MODELS},
        **{(m, "fp32"): "not built" for m in TINY_MODELS},
        **{(m, "tokenizer"): "ok" for m in ("tmr_text", "tmr_student")},
    }
    assert all(report.ok for report in reports)


def test_verify_tells_damaged_from_missing(tmp_path: Path) -> None:
    folder = copy_tiny(tmp_path)
    truncated(folder)
    (folder / MOTION).unlink()
    bad = {r.model: r for r in verify(load_manifest(folder / "models_manifest.yaml")) if not r.ok}
    assert {name: report.state for name, report in bad.items()} == {
        "tmr_text": "damaged",
        "tmr_motion": "missing",
    }
    assert bad["tmr_text"].expected == EXPECTED
    assert bad["tmr_text"].found == hashlib.sha256((folder / TEXT).read_bytes()).hexdigest()
    assert bad["tmr_motion"].found is None
    size = (TINY / TEXT).stat().st_size
    assert (bad["tmr_text"].expected_bytes, bad["tmr_text"].bytes) == (size, size - 1)
    assert "is cut short" in bad["tmr_text"].problem
    assert bad["tmr_motion"].bytes is None
    assert "cannot read" in bad["tmr_motion"].problem
