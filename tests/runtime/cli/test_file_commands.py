"""``info``, ``convert`` of folders, ``trim`` and ``resample``: nothing is lost, nothing is written over."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from characters import Character, bvh_text, character
from glb_files import glb
from motions import walking

from motionrt import load_motion
from motionrt.cli import main
from motionrt.formats.gltf.container import pack_container, read_container


def checksums(folder: Path) -> dict[str, str]:
    files = [path for path in folder.rglob("*") if path.is_file()]
    return {path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def with_two_animations(path: Path) -> Path:
    walking(30).save(path)
    document, binary = read_container(path)
    document["animations"] = [{**document["animations"][0], "name": name} for name in ("Walk", "Armature|Run/2")]
    path.write_bytes(pack_container(document, binary))
    return path


def test_a_folder_is_converted_with_its_folders_and_each_animation(
    library: Path, tmp_path: Path, run_json: Callable[..., Any]
) -> None:
    with_two_animations(library / "ä" / "pack.glb")
    done = run_json("convert", library, tmp_path / "out", "--to", ".npz")
    written = sorted(Path(path).relative_to(tmp_path / "out").as_posix() for path in done["written"])
    assert written == ["long.npz", "walk.npz", "ä/kreis.npz", "ä/pack__Armature_Run_2.npz", "ä/pack__Walk.npz"]
    assert done["skipped"] == []
    assert load_motion(tmp_path / "out" / "ä" / "pack__Walk.npz").frames == 30


def test_a_folder_of_broken_files_lists_them_and_converts_the_others(
    library: Path, tmp_path: Path, run_json: Callable[..., Any]
) -> None:
    (library / "broken.bvh").write_text("HIERARCHY\nROOT", encoding="utf-8")
    done = run_json("convert", library, tmp_path / "out", code=3)
    assert (len(done["written"]), [one["path"] for one in done["skipped"]]) == (3, ["broken.bvh"])


def test_converting_a_folder_into_itself_spares_every_input(library: Path, run_json: Callable[..., Any]) -> None:
    walking(20).save(library / "walk.npz")  # walk.bvh would become this
    before = checksums(library)
    done = run_json("convert", library, library, "--to", ".npz")
    after = checksums(library)
    assert {name: after[name] for name in before} == before
    assert len(done["written"]) == len(after) - len(before) == 4


def test_results_inside_the_folder_are_no_inputs_of_the_next_time(library: Path, run_json: Callable[..., Any]) -> None:
    for _ in range(2):
        assert len(run_json("convert", library, library / "out")["written"]) == 3


@pytest.mark.parametrize("command", ["convert", "trim --end 1", "resample --fps 10"])
def test_a_file_is_not_written_over_itself(library: Path, command: str, capsys: pytest.CaptureFixture[str]) -> None:
    before = checksums(library)
    name, *options = command.split()
    assert main([name, str(library / "walk.bvh"), str(library / "ä" / ".." / "walk.bvh"), *options]) == 1
    assert "is a file that is read" in capsys.readouterr().err
    assert checksums(library) == before


@pytest.mark.parametrize("target", ["hero.glb", "walk.bvh"])
def test_neither_clip_nor_character_is_written_over(
    library: Path, target: str, capsys: pytest.CaptureFixture[str]
) -> None:
    hero = glb(character("mixamo")).save(library / "hero.glb")
    before = checksums(library)
    command = ["retarget", str(library / "walk.bvh"), "--to", str(hero), "-o", str(library / target)]
    assert main(command) == 1
    assert "is a file that is read" in capsys.readouterr().err
    assert checksums(library) == before


def test_layers_of_a_composition_are_not_written_over(library: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = checksums(library)
    files = [str(library / "walk.bvh"), str(library / "ä" / "kreis.bvh")]
    assert main(["compose", *files, "--mask-b", "left arm", "-o", files[1]]) == 1
    assert "is a file that is read" in capsys.readouterr().err
    assert checksums(library) == before


def test_trim_keeps_the_frames_between_two_times(library: Path, tmp_path: Path, run_json: Callable[..., Any]) -> None:
    done = run_json("trim", library / "walk.bvh", tmp_path / "part.bvh", "--start", 0.5, "--end", 1.5)
    whole, part = load_motion(library / "walk.bvh"), load_motion(tmp_path / "part.bvh")
    assert (done["frames"], part.frames) == (20, 20)
    assert abs(part.positions()[:, 4:6] - whole.positions()[10:30, 4:6]).max() < 1e-3


def test_trim_refuses_what_leaves_nothing(library: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for span in (["--start", "5"], ["--start", "1", "--end", "1"], ["--start", "-1"]):
        assert main(["trim", str(library / "walk.bvh"), str(tmp_path / "part.bvh"), *span]) == 1
        assert "leave nothing" in capsys.readouterr().err


def test_resample_changes_the_rate_and_source_fps_the_speed(
    library: Path, tmp_path: Path, run_json: Callable[..., Any]
) -> None:
    done = run_json("resample", library / "walk.bvh", tmp_path / "slow.bvh", "--fps", 10)
    assert (done["frames"], done["seconds"]) == (30, 3.0)
    done = run_json("convert", library / "walk.bvh", tmp_path / "fast.bvh", "--source-fps", 60)
    assert (done["frames"], done["seconds"]) == (60, 1.0)


def test_info_says_what_is_in_a_file(tmp_path: Path, run_json: Callable[..., Any]) -> None:
    path = tmp_path / "rig.bvh"
    path.write_text(bvh_text(character("mixamo")), encoding="utf-8")
    facts = run_json("info", path)
    assert (facts["kind"], facts["frames"], facts["up"], facts["mapping"]["left_knee"]) == (
        "Mixamo", 1, "y", "mixamorig:LeftLeg",
    )  # fmt: skip
    assert facts["metres_per_unit"] == pytest.approx(0.01)
    assert facts["limb_error_degrees"] < 0.1
    assert run_json("info", with_two_animations(tmp_path / "two.glb"))["animations"] == ["Walk", "Armature|Run/2"]


def test_info_of_what_is_no_person_says_why(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    person = character("mixamo", extras=False)
    count = person.roles["left_hip"]  # the legs are left out
    body = Character(person.names[:count], person.parents[:count], person.places[:count], {})
    path = tmp_path / "rig.bvh"
    path.write_text(bvh_text(body), encoding="utf-8")
    assert main(["info", str(path), "--json"]) == 1
    facts = json.loads(capsys.readouterr().out)
    assert "left_hip" in facts["reason"]
    assert (facts["height"], facts["mapping"]) == (None, {})


def test_errors_name_the_options_of_the_command(
    library: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (library / "walk.bvh").read_text(encoding="utf-8")
    (tmp_path / "still.bvh").write_text(text.replace("Frame Time: ", "Frame Time: 0 #"), encoding="utf-8")
    assert main(["convert", str(tmp_path / "still.bvh"), str(tmp_path / "o.bvh")]) == 1
    assert "--source-fps" in capsys.readouterr().err
    path = with_two_animations(tmp_path / "two.glb")
    assert main(["convert", str(path), str(tmp_path / "o.bvh")]) == 1
    err = capsys.readouterr().err
    assert "--animation" in err
    assert "animation=" not in err
    assert main(["convert", str(path), str(tmp_path / "o.bvh"), "--animation", "1"]) == 0
