"""The starter gallery is decoded from prompts, deterministically, and answers with them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tiny_models import TINY

from motionrt import Runtime
from motionrt_export import starter


@pytest.fixture
def prompts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    path = tmp_path / "prompts.txt"
    path.write_text("# seconds | prompt\n2 | a person walks\n\n1.5 | a person waves\n", encoding="utf-8")
    monkeypatch.setattr(starter, "PROMPTS", path)
    return path


def test_prompts_are_read_with_their_seconds_and_without_comments(prompts: Path) -> None:
    assert list(starter.read_prompts(prompts)) == [(2.0, "a person walks"), (1.5, "a person waves")]


def test_the_gallery_holds_a_motion_for_each_prompt_and_its_text(prompts: Path, tmp_path: Path) -> None:
    runtime = Runtime(TINY)
    gallery = starter.build_starter(runtime, tmp_path / "starter")
    hits = {hit.id: hit for hit in runtime.retrieve("a person walks", 5, gallery)}
    assert {name: hit.text for name, hit in hits.items()} == {
        "a-person-walks": "a person walks",
        "a-person-waves": "a person waves",
    }
    assert gallery.motion("a-person-waves").frames == 30
    again = starter.build_starter(Runtime(TINY), tmp_path / "again")
    np.testing.assert_array_equal(gallery.motion("a-person-walks").root, again.motion("a-person-walks").root)


def test_every_shipped_prompt_is_readable_and_different() -> None:
    shipped = list(starter.read_prompts(Path(starter.__file__).with_name("starter_prompts.txt")))
    assert len({text for _, text in shipped}) == len(shipped) >= 60
    assert all(2 <= seconds <= 10 for seconds, _ in shipped)
