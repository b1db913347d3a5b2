"""Names of files that every system takes; what Windows takes is asked of the standard library's own rules."""

from __future__ import annotations

import ntpath
from pathlib import PurePosixPath, PureWindowsPath

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from motionrt.studio.project import plain_name
from motionrt.studio.workshop import file_name
from motionrt.untrusted.names import plain_stem

TRICKY = ["con", "AUX.walk", "nul.", "com1", "lpt³.x", "a" * 300, "日本" * 60, ". ."]
WORDS = st.text(max_size=200) | st.sampled_from(TRICKY)


def reserved(name: str) -> bool:
    if hasattr(ntpath, "isreserved"):  # from Python 3.13 on
        return bool(ntpath.isreserved(name))
    return PureWindowsPath(name).is_reserved() or name != name.rstrip(". ")


def is_one_name(name: str) -> bool:
    """Whether a name names a file in the folder that it is put into, on Windows as elsewhere, and is not too long."""
    one = all(kind("folder", name).parent == kind("folder") for kind in (PurePosixPath, PureWindowsPath))
    return one and not set('<>:"/\\|?*') & set(name) and name.isprintable() and len(name.encode()) < 256


@given(WORDS)
@example("CON")
@example("\udce9con")
def test_a_stem_of_any_words_makes_a_name_that_windows_takes(text: str) -> None:
    stem = plain_stem(text)
    assert len(stem.encode()) <= 81
    if stem:
        for name in (stem, f"{stem}.bvh"):
            assert not reserved(name)
            assert is_one_name(name)


@given(WORDS)
def test_exports_and_uploads_of_the_studio_have_such_names(text: str) -> None:
    for name in (file_name(text, "bvh"), plain_name(f"{text}.bvh")):
        assert not reserved(name)
        assert is_one_name(name)


@pytest.mark.parametrize(("text", "stem"), [("a person walks", "a_person_walks"), ("ü.bvh", "ü.bvh"), ("../x", "x")])
def test_what_is_harmless_stays(text: str, stem: str) -> None:
    assert plain_stem(text) == stem
