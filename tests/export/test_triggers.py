"""The file of triggers: what it says holds for every pattern, and it is that of the lexicon."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from motionrt.text.patterns import TRIGGERS_FILE, compiled, key
from motionrt_export.triggers import made, patterns, triggers

TABLE = Path(__file__).parents[1] / "runtime" / "text" / "query_table.py"


def test_the_packaged_file_is_that_of_the_lexicon() -> None:
    assert json.loads(TRIGGERS_FILE.read_text()) == made(), "run: python -m motionrt_export.triggers"


@pytest.mark.parametrize(
    ("pattern", "expected"),
    [
        (r"walk", {"walk"}),
        (r"\bwalk\w*|\bstroll\w*", {"walk", "stroll"}),
        (r"runn?ing", {"run", "ing"}),
        (r"(?:left|right) hand", {" hand"}),
        (r"\b(?:lie|lies)\b(?! down)", {"lie", "lies"}),
        (r"(?:the )?toes", {"toes"}),
        (r"\w+", None),
        (r"jump|\d+", None),
        (r"{limb}s? up", {"arm", "leg", " up"}),
    ],
)
def test_every_match_holds_a_trigger(pattern: str, expected: set[str] | None) -> None:
    found = triggers(pattern, {"limb": "(?:arm|leg)"})
    assert found is None if expected is None else found is not None and found <= expected


def test_no_pattern_matches_a_text_without_its_triggers() -> None:
    table = json.loads(TRIGGERS_FILE.read_text())
    rows = TABLE.read_text(encoding="utf-8").splitlines()
    texts = [row.split(" | ")[0].lower().replace("-", " ") for row in rows if " | " in row]
    for pattern in patterns():
        needed = table.get(key(pattern))
        for text in texts if needed is not None else ():
            assert any(letters in text for letters in needed) or not compiled(pattern).search(text), (pattern, text)
