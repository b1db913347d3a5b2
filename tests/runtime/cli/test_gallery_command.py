"""``motionrt gallery`` as a shell user meets it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from motions import standing

from motionrt.cli import main


def test_build_prints_where_and_how_much(library: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["gallery", "build", str(library), "--jobs", "1"]) == 0
    out, err = capsys.readouterr()
    assert out.startswith(f"{library / '.motionrt-gallery'}: 3 clips, 4 windows")
    assert err == ""  # no progress line without a terminal


def test_info_counts_the_clips(gallery: Path, run_json: Callable[..., Any]) -> None:
    info = run_json("gallery", "info", gallery)
    assert (info["clips"], info["windows"], info["skipped"]) == (3, 4, [])
    assert info["source"] == str(gallery)
    assert info["model"] == {"name": "fake", "fingerprint": "f" * 64}
    assert info["hours"] == pytest.approx((3 + 3 + 15) / 3600, abs=1e-4)


def test_info_for_people_names_the_model(gallery: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["gallery", "info", str(gallery)]) == 0
    assert "clips    3" in capsys.readouterr().out


def test_skipped_files_are_listed_and_the_exit_code_says_so(
    library: Path, run_json: Callable[..., Any], capsys: pytest.CaptureFixture[str]
) -> None:
    (library / "bröken.bvh").write_text("HIERARCHY\nROOT", encoding="utf-8")
    done = run_json("gallery", "build", library, "--jobs", 1, code=3)
    assert done["clips"] == 3
    assert [skipped["path"] for skipped in done["skipped"]] == ["bröken.bvh"]
    assert main(["gallery", "build", str(library), "--jobs", "1"]) == 3
    err = capsys.readouterr().err
    assert "skipped bröken.bvh: line " in err
    assert "1 file was skipped" in err


def test_hundreds_of_skipped_files_are_counted_by_reason(
    library: Path, run_json: Callable[..., Any], capsys: pytest.CaptureFixture[str]
) -> None:
    for number in range(120):
        (library / f"short {number}.bvh").write_text("HIERARCHY\nROOT", encoding="utf-8")
        (library / f"foreign {number}.npz").write_bytes(b"nothing")
    assert main(["gallery", "build", str(library), "--jobs", "1"]) == 3
    lines = capsys.readouterr().err.splitlines()
    assert len([line for line in lines if line.startswith("skipped foreign")]) == 20
    assert len(lines) < 26
    assert "skipped 220 more" in lines[20]
    assert [line.split()[0] for line in lines[21:-1]] == ["120", "120"]
    assert lines[-1] == "motionrt: 240 files were skipped"
    assert len(run_json("gallery", "info", library)["skipped"]) == 240
    assert main(["gallery", "info", str(library)]) == 0
    assert "and 119 more" in capsys.readouterr().out


def test_reading_options_hold_for_every_file_and_are_kept(library: Path, run_json: Callable[..., Any]) -> None:
    built = run_json("gallery", "build", library, "--jobs", 1, "--source-fps", 60, "--up", "y")
    assert built["hours"] == pytest.approx((1 + 1 + 5) / 3600, abs=1e-4)
    assert run_json("gallery", "update", library, "--jobs", 1)["hours"] == built["hours"]


def test_update_counts_what_changed(gallery: Path, run_json: Callable[..., Any]) -> None:
    standing(20).save(gallery / "stand.bvh")
    (gallery / "walk.bvh").unlink()
    done = run_json("gallery", "update", gallery, "--jobs", 1)
    assert {name: done[name] for name in ("added", "changed", "unchanged", "removed")} == {
        "added": 1, "changed": 0, "unchanged": 2, "removed": 1,
    }  # fmt: skip


def test_a_gallery_can_be_built_elsewhere(library: Path, tmp_path: Path, run_json: Callable[..., Any]) -> None:
    run_json("gallery", "build", library, "-o", tmp_path / "gal", "--jobs", 1)
    assert run_json("gallery", "info", tmp_path / "gal")["clips"] == 3
    assert not (library / ".motionrt-gallery").exists()


def test_a_damaged_gallery_is_one_line_and_exit_code_one(gallery: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = next((gallery / ".motionrt-gallery").glob("embeddings-*"))
    content = bytearray(path.read_bytes())
    content[-1] ^= 1
    path.write_bytes(content)
    assert main(["gallery", "info", str(gallery)]) == 1
    err = capsys.readouterr().err
    assert err.startswith("motionrt: error: ")
    assert "damaged" in err
    assert err.count("\n") == 1


def test_a_mapping_file_is_used_and_checked(library: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mapping = tmp_path / "mapping.json"
    command = ["gallery", "build", str(library), "--mapping", str(mapping), "--jobs", "1"]
    mapping.write_text('{"left_knee": "left_knee"}', encoding="utf-8")
    assert main(command) == 0
    mapping.write_text('{"left_knee": "no such joint"}', encoding="utf-8")
    assert main(command) == 1
    assert "no such joint" in capsys.readouterr().err
    mapping.write_text("[1]", encoding="utf-8")
    assert main(command) == 1
    assert "must map joint names" in capsys.readouterr().err


def test_a_contact_sheet_shows_every_clip_and_survives_files_that_are_gone(
    gallery: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "sheet.html"
    assert main(["gallery", "sheet", str(gallery), "-o", str(out)]) == 0
    assert "3 clips" in capsys.readouterr().out
    assert out.read_text(encoding="utf-8").count("<svg") == 3
    (gallery / "walk.bvh").unlink()
    assert main(["gallery", "sheet", str(gallery), "-o", str(out)]) == 0
    assert out.read_text(encoding="utf-8").count("<svg") == 2
