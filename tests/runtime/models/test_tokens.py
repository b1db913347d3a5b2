"""Token ids from the head of the vocabulary are those of all of it; any text that needs more gets more."""

from __future__ import annotations

import json
import string
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tiny_models import TINY, edited

from motionrt.errors import ManifestError, ModelFileError
from motionrt.models import Sessions, find_manifest, load_manifest, tokens
from motionrt.models.tokens import Tokens, head_of
from motionrt.retrieval import read_captions
from motionrt.services.search import DEFAULT_CAPTIONS

FILE = TINY / "models" / "tokenizer.json"
CONTENT = FILE.read_text(encoding="utf-8")
VOCABULARY = list(json.loads(CONTENT)["model"]["vocab"])
WORDS = [word for word in VOCABULARY if word.isalpha() and len(word) > 1]
LENGTH = CONTENT.index('"forward":') - CONTENT.index('"vocab":{')  # the first half of the words


@pytest.fixture(autouse=True)
def short_head(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tokens, "HEAD", LENGTH)


def opened() -> Tokens:
    return Tokens(Sessions(TINY, threads=1), "tmr_text")


def is_whole(reader: Tokens) -> bool:
    return "whole" in reader.__dict__


pieces = st.one_of(st.sampled_from(WORDS), st.text(alphabet=string.ascii_letters + "'-,. é#\u3000[]", max_size=9))


@given(st.lists(pieces, max_size=30).map(" ".join))
def test_every_text_has_the_ids_of_the_whole_vocabulary(text: str) -> None:
    reader = opened()
    assert reader.ids(text) == reader.whole.encode(text).ids


def test_words_of_the_head_are_read_without_the_rest() -> None:
    reader = opened()
    assert reader.ids("A man walks") == [2, *(VOCABULARY.index(word) for word in ("a", "man", "walks")), 3]
    assert not is_whole(reader)


@pytest.mark.parametrize("text", ["a man and his dog", "walkwalk", "[UNK]", "ß", "walk slowly"])
def test_another_word_opens_the_whole_vocabulary(text: str) -> None:
    reader = opened()
    assert reader.ids(text) == reader.whole.encode(text).ids
    reader = opened()
    reader.ids(text)
    assert is_whole(reader)


def test_long_texts_are_cut_alike() -> None:
    reader = opened()
    text = "walk a man " * 100
    assert len(reader.ids(text)) == 128
    assert not is_whole(reader)
    assert reader.ids(text) == reader.whole.encode(text).ids
    late = "walk " * 200 + "slowly"  # beyond the cut nothing counts
    assert reader.ids(late) == reader.whole.encode(late).ids


def test_a_head_is_a_file_of_the_first_entries() -> None:
    head = head_of(CONTENT)
    assert head is not None
    found = list(json.loads(head)["model"]["vocab"])
    assert found == VOCABULARY[: len(found)]
    assert len(WORDS) // 4 < sum(word in WORDS for word in found) < len(WORDS)


@pytest.mark.parametrize("change", [lambda c: json.dumps(json.loads(c), indent=1), lambda c: c + "x", lambda c: ""])
def test_files_that_are_written_otherwise_have_no_head(change) -> None:
    assert head_of(change(CONTENT)) is None


def test_a_short_vocabulary_has_no_head(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tokens, "HEAD", len(CONTENT))
    assert head_of(CONTENT) is None
    assert opened().ids("walk") == opened().whole.encode("walk").ids


def test_a_model_that_names_no_tokenizer_is_refused() -> None:
    with pytest.raises(ManifestError, match="'tmr_motion' names no tokenizer"):
        Tokens(Sessions(TINY), "tmr_motion")


def test_a_limit_of_the_manifest_counts(tmp_path: Path) -> None:
    manifest = edited(tmp_path, lambda c: c["models"]["tmr_text"]["tokenizer"].update(max_tokens=4))
    assert len(Tokens(Sessions(manifest), "tmr_text").ids("walk walk walk walk")) == 4


def test_captions_are_read_alike_by_the_tokenizer_that_ships(monkeypatch: pytest.MonkeyPatch) -> None:
    try:
        sessions = Sessions(load_manifest(find_manifest()).path)
    except ModelFileError as error:
        pytest.skip(f"no models here: {error}")
    monkeypatch.setattr(tokens, "HEAD", 48_000)
    reader = Tokens(sessions, "tmr_text")
    texts = read_captions(DEFAULT_CAPTIONS)
    assert [reader.ids(text) for text in texts] == [reader.whole.encode(text).ids for text in texts]
