"""What the parser reads in short queries and sentences; the expected values were written by hand."""

from __future__ import annotations

import time

import pytest
from query_table import TABLE

from motionrt.errors import InvalidInputError
from motionrt.text import parse_query
from motionrt.text.parsing import _parsed

ROWS = [line.split(" | ") for line in TABLE.strip().splitlines()]


def _value(word: str) -> object:
    if word in ("True", "False", "-"):
        return {"True": True, "False": False, "-": None}[word]
    return int(word) if word.lstrip("-").isdigit() else word


def _expected(said: str) -> dict[str, object]:
    found: dict[str, object] = {}
    name = ""
    for word in said.split():
        if "=" in word:
            name, value = word.split("=")
            found[name] = _value(value)
        else:  # a value of two words
            found[name] = f"{found[name]} {word}"
    return found


def test_the_table_is_long_enough() -> None:
    assert len({text for text, _ in ROWS}) == len(ROWS) >= 150


@pytest.mark.parametrize(("text", "said"), ROWS, ids=[text for text, _ in ROWS])
def test_a_text_says(text: str, said: str) -> None:
    parsed, expected = parse_query(text), _expected(said)
    assert {name: getattr(parsed, name) for name in expected} == expected


def test_a_text_with_sides_exchanged_says_the_mirror_image() -> None:
    for text, _ in ROWS:
        if (
            "clockwise" in text
            or " right a" in text
            or "right there" in text
            or "all right" in text
            or "has left" in text
        ):
            continue
        swapped = text.replace("left", "@").replace("right", "left").replace("@", "right")
        mirrored = parse_query(text).mirrored()
        assert parse_query(swapped).said == mirrored.said, text


def test_text_without_any_known_word_is_empty() -> None:
    assert parse_query("quantum chromodynamics").empty
    assert parse_query("").empty
    assert not parse_query("turn left").empty


def test_a_query_must_be_text() -> None:
    with pytest.raises(InvalidInputError, match="int"):
        parse_query(3)  # type: ignore[arg-type]


def test_very_long_text_is_read_quickly() -> None:
    started = time.perf_counter()
    parse_query("walk to the left and " * 5000)
    assert time.perf_counter() - started < 1.0


def test_parsing_takes_about_a_millisecond() -> None:
    texts = [text for text, _ in ROWS]
    for text in texts:
        parse_query(text)  # patterns are compiled at first use
    best = 1.0
    for _ in range(3):
        _parsed.cache_clear()
        started = time.process_time()
        for text in texts:
            parse_query(text)
        best = min(best, (time.process_time() - started) / len(texts))
    assert best < 3e-3  # 0.2 ms on an idle core
