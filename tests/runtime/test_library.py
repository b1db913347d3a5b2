"""Folders of clips from prompts, by tiny models."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest
from tiny_models import TINY_GENERATORS

from motionrt import Runtime, library
from motionrt.cli import main
from motionrt.errors import InvalidInputError
from motionrt.formats import load_motion


@pytest.fixture(scope="module")
def runtime() -> Runtime:
    return Runtime(TINY_GENERATORS, threads=1)


def test_clips_that_do_what_their_prompts_say_are_written_with_captions_and_events(
    runtime: Runtime, tmp_path: Path
) -> None:
    found = library.make(["walk forward", "flurb"], tmp_path, runtime=runtime, suffix=".bvh", each=2)
    assert [one.file.name for one in found if one.file] == [
        "walk_forward-1.bvh", "walk_forward-2.bvh", "flurb-1.bvh", "flurb-2.bvh",
    ]  # fmt: skip
    assert load_motion(tmp_path / "flurb-1.bvh").frames > 100
    rows = list(csv.reader((tmp_path / "captions.csv").open(encoding="utf-8")))
    assert rows[:2] == [["file", "caption"], ["walk_forward-1.bvh", "walk forward"]]
    facts = json.loads((tmp_path / "walk_forward-1.json").read_text(encoding="utf-8"))
    assert facts["prompt"] == "walk forward"
    assert facts["agreement"] >= library.ACCEPTED
    assert "contacts" in facts


def test_a_prompt_that_no_clip_does_is_left_out_and_said_why(runtime: Runtime, tmp_path: Path) -> None:
    (made,) = library.make(["do a handstand"], tmp_path, runtime=runtime, tries=2)
    assert made.file is None
    assert made.agreement < library.ACCEPTED
    assert made.reasons
    assert not list(tmp_path.glob("*.glb"))


def test_a_run_that_was_stopped_goes_on(runtime: Runtime, tmp_path: Path) -> None:
    library.make(["walk"], tmp_path, runtime=runtime)
    before = (tmp_path / "walk.glb").stat().st_mtime_ns
    found = library.make(["walk", "stroll"], tmp_path, runtime=runtime)
    assert (tmp_path / "walk.glb").stat().st_mtime_ns == before
    assert len(found) == 2


@pytest.mark.parametrize("facts", ["[" * 100_000, "{}", "no json", '{"prompt": "walk", "agreement": []}', "\xff"])
def test_a_clip_whose_facts_are_damaged_is_made_anew(runtime: Runtime, tmp_path: Path, facts: str) -> None:
    library.make(["walk"], tmp_path, runtime=runtime)
    before = (tmp_path / "walk.glb").stat().st_mtime_ns
    (tmp_path / "walk.json").write_text(facts, encoding="latin-1")
    library.make(["walk"], tmp_path, runtime=runtime)
    assert (tmp_path / "walk.glb").stat().st_mtime_ns > before
    assert json.loads((tmp_path / "walk.json").read_text(encoding="utf-8"))["prompt"] == "walk"


@pytest.mark.parametrize("given", [{"prompts": []}, {"suffix": ".fbx"}, {"accept": 2}, {"each": 0}, {"prompts": [""]}])
def test_what_cannot_be_is_refused(runtime: Runtime, tmp_path: Path, given: dict[str, object]) -> None:
    with pytest.raises(InvalidInputError):
        library.make(**{"prompts": ["walk"], "folder": tmp_path, "runtime": runtime, **given})  # type: ignore[arg-type]


def test_the_command_says_for_which_prompts_there_is_no_clip(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    prompts = tmp_path / "prompts.txt"
    prompts.write_text("# mine\nwalk\n\ndo a handstand\n", encoding="utf-8")
    arguments = ["library", str(prompts), "-o", str(tmp_path / "clips"), "--models", str(TINY_GENERATORS)]
    assert main([*arguments, "--tries", "1", "--json"]) == 3
    printed = capsys.readouterr()
    assert [row["prompt"] for row in json.loads(printed.out)] == ["walk", "do a handstand"]
    assert "no clip for 'do a handstand'" in printed.err
