"""Names that moved still work where they were, and say where they are now."""

from __future__ import annotations

import importlib

import pytest
from fake_character_models import FakeCharacterModels

import motionrt
from motionrt.rigs import RigClip


def test_the_clip_of_a_rig_is_found_where_it_was_with_a_warning() -> None:
    with pytest.warns(DeprecationWarning, match=r"motionrt\.motion\.RigClip is now motionrt\.rigs\.RigClip"):
        assert importlib.import_module("motionrt.motion").RigClip is RigClip


def test_the_models_of_characters_are_found_by_their_old_name_with_a_warning(monkeypatch: pytest.MonkeyPatch) -> None:
    models = FakeCharacterModels()
    monkeypatch.setattr(motionrt.Runtime, "character_models", models)
    with pytest.warns(DeprecationWarning, match=r"Runtime\.character_models"):
        assert motionrt.Runtime().players is models


def test_a_name_that_never_was_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'RigFilm'"):
        importlib.import_module("motionrt.motion").RigFilm  # noqa: B018
