"""``motionrt retrieve``: the table, the JSON that programs rely on, and the saved hits."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from motionrt import load_motion
from motionrt.cli import main


def test_json_is_a_list_of_hits_with_the_promised_keys(gallery: Path, run_json: Callable[..., Any]) -> None:
    hits = run_json("retrieve", "a person walks", "--gallery", gallery, "-k", 2)
    assert [hit["rank"] for hit in hits] == [1, 2]
    for hit in hits:
        assert list(hit) == ["rank", "score", "id", "path", "start", "end", "text", "cosine", "agreement"]
        assert Path(hit["path"]) == gallery / hit["id"]
        assert 0 <= hit["start"] < hit["end"]
        assert -1 <= hit["score"] <= 1
    assert hits[0]["score"] >= hits[1]["score"]


def test_the_table_has_a_line_for_every_hit(gallery: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["retrieve", "a person walks", "--gallery", str(gallery / ".motionrt-gallery")]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split() == ["rank", "score", "fits", "start", "end", "clip"]
    assert sorted(line.split()[-1] for line in lines[1:]) == ["long.npz", "walk.bvh", "ä/kreis.bvh"]


def test_windows_gives_every_span_of_a_long_clip(gallery: Path, run_json: Callable[..., Any]) -> None:
    hits = run_json("retrieve", "walks", "--gallery", gallery, "--windows")
    assert sorted((hit["start"], hit["end"]) for hit in hits if hit["id"] == "long.npz") == [(0, 10), (5, 15)]


def test_saved_hits_keep_their_kind_and_are_cut_to_the_found_spans(
    gallery: Path, tmp_path: Path, run_json: Callable[..., Any]
) -> None:
    hits = run_json("retrieve", "walks", "--gallery", gallery, "--save", tmp_path / "new" / "hits")
    saved = sorted((tmp_path / "new" / "hits").iterdir())
    assert [path.name[:3] for path in saved] == ["001", "002", "003"]
    assert [path.suffix for path in saved] == [Path(hit["id"]).suffix for hit in hits]
    for path, hit in zip(saved, hits, strict=True):
        assert load_motion(path, keep_first_frame=True).duration == pytest.approx(hit["end"] - hit["start"], abs=0.06)


def test_no_gallery_there_names_the_command_to_build_one(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["retrieve", "walks", "--gallery", str(tmp_path)]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert f'motionrt gallery build "{tmp_path}"' in err


def test_k_of_nothing_is_an_error(gallery: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["retrieve", "walks", "--gallery", str(gallery), "-k", "0"]) == 1
    assert "k must be at least 1" in capsys.readouterr().err


def test_the_folder_for_hits_may_not_be_a_file(gallery: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = gallery / "walk.bvh"
    assert main(["retrieve", "walks", "--gallery", str(gallery), "--save", str(path)]) == 1
    assert "cannot make the folder" in capsys.readouterr().err


def test_approximate_answers_a_small_gallery_exactly(gallery: Path, run_json: Callable[..., Any]) -> None:
    asked = ("retrieve", "a person walks", "--gallery", gallery, "--windows")
    assert run_json(*asked, "--approximate") == run_json(*asked)


def test_conditions_leave_clips_out(gallery: Path, run_json: Callable[..., Any]) -> None:
    asked = ("retrieve", "walks", "--gallery", gallery)
    assert {hit["id"] for hit in run_json(*asked, "--where", "duration > 5")} == {"long.npz"}
    assert {hit["id"] for hit in run_json(*asked, "--max-seconds", "5", "--folder", "ä")} == {"ä/kreis.bvh"}
    assert run_json(*asked, "--where", "duration > 50") == []


def test_a_condition_on_what_is_no_attribute_lists_those_that_are(
    gallery: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["retrieve", "walks", "--gallery", str(gallery), "--where", "sped > 1"]) == 1
    error = capsys.readouterr().err
    assert "sped" in error
    assert "speed" in error


def test_a_query_of_unknown_words_says_so_instead_of_answering(
    gallery: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["retrieve", "quantum chromodynamics", "--gallery", str(gallery)]) == 0
    out, err = capsys.readouterr()
    assert "walk.bvh" not in out
    assert "quantum" in err
    assert main(["retrieve", "quantum chromodynamics", "--gallery", str(gallery), "--anyway"]) == 0
    assert "walk.bvh" in capsys.readouterr().out


def test_a_search_without_hits_writes_nothing_and_its_exit_code_says_so(
    gallery: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    command = ["retrieve", "walks", "--gallery", str(gallery), "--min-seconds", "999"]
    assert main(command) == 0
    out, err = capsys.readouterr()
    assert out == ""
    assert "no clip of the gallery fulfils the conditions" in err
    folder, picture = tmp_path / "hits", tmp_path / "hits.png"
    assert main([*command, "--save", str(folder), "--pictures", str(picture)]) == 1
    assert f"nothing is written for --save {folder} and --pictures {picture}" in capsys.readouterr().err
    assert not folder.exists()
    assert not picture.exists()


def test_similar_leaves_the_clip_itself_out(gallery: Path, run_json: Callable[..., Any]) -> None:
    hits = run_json("similar", "walk.bvh", "--gallery", gallery, "-k", 5)
    assert [hit["rank"] for hit in hits] == [1, 2]
    assert "walk.bvh" not in {hit["id"] for hit in hits}
    with_file = run_json("similar", gallery / "walk.bvh", "--gallery", gallery)
    assert with_file[0]["id"] == "walk.bvh"  # a file is any file, and this one is in the gallery
    assert with_file[0]["score"] > 0.99


def test_equal_files_are_duplicates(
    gallery: Path, run_json: Callable[..., Any], capsys: pytest.CaptureFixture[str]
) -> None:
    (gallery / "copy.bvh").write_bytes((gallery / "walk.bvh").read_bytes())
    assert main(["gallery", "update", str(gallery), "--jobs", "1"]) == 0
    capsys.readouterr()
    groups = run_json("gallery", "duplicates", gallery)
    assert [(group["ids"], group["identical"]) for group in groups] == [(["copy.bvh", "walk.bvh"], True)]


def test_pictures_of_hits_are_drawn(gallery: Path, tmp_path: Path) -> None:
    pytest.importorskip("PIL")
    out = tmp_path / "hits.png"
    assert main(["retrieve", "walks", "--gallery", str(gallery), "-k", "2", "--pictures", str(out)]) == 0
    assert out.read_bytes().startswith(b"\x89PNG")
