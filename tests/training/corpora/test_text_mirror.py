"""Left and right in captions change places with the mirrored motion."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from motionrt_training.corpora.text_mirror import mirror_text

CAPTIONS = Path(__file__).parents[3].parent / "shared/data/mocap/cmu/captions.jsonl"


@pytest.mark.parametrize(
    ("text", "mirrored"),
    [
        ("He raises the left hand, then the right.", "He raises the right hand, then the left."),
        ("Left-handed dribble, veering rightward", "Right-handed dribble, veering leftward"),
        ("spins clockwise", "spins counterclockwise"),
        ("turning counter-clockwise and anticlockwise", "turning clockwise and clockwise"),
        ("turns right at a right angle and goes right away", "turns left at a right angle and goes right away"),
        ("stands upright in bright light", "stands upright in bright light"),
        ("he left the room", "he left the room"),
        ("rotating left the entire time", "rotating right the entire time"),
    ],
)
def test_sides_and_senses_of_rotation_are_swapped_and_idioms_are_not(text: str, mirrored: str) -> None:
    assert mirror_text(text) == mirrored


def test_mirroring_every_caption_twice_gives_it_back() -> None:
    if not CAPTIONS.is_file():
        pytest.skip("../shared/data/mocap/cmu/captions.jsonl is not on this machine")
    rows = map(json.loads, CAPTIONS.read_text(encoding="utf-8").splitlines())
    captions = [text for row in rows for text in row["captions"]]
    for text in captions:
        plain = re.sub(r"\b(counter|anti)-?clockwise", "counterclockwise", text, flags=re.IGNORECASE)
        assert mirror_text(mirror_text(plain)).lower() == plain.lower()
