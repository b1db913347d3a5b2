"""Where the models are looked for, in which order, and what is said when they are nowhere."""

from __future__ import annotations

from pathlib import Path

import pytest
from tiny_models import TINY

from motionrt.errors import ModelFileError
from motionrt.models import find_manifest, locate


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A checkout without models, whose package folder is <tmp>/runtime/motionrt."""
    folder = tmp_path / "runtime" / "motionrt"
    folder.mkdir(parents=True)
    monkeypatch.setattr(locate, "_PACKAGE", folder)
    return folder


def test_a_folder_is_taken_at_its_word() -> None:
    assert find_manifest(TINY) == TINY / "models_manifest.yaml"
    assert find_manifest(str(TINY)) == TINY / "models_manifest.yaml"


def test_a_manifest_is_taken_at_its_word() -> None:
    assert find_manifest(TINY / "models_manifest.yaml") == TINY / "models_manifest.yaml"


def test_a_folder_without_a_manifest_does_not_fall_back(tmp_path: Path) -> None:
    with pytest.raises(ModelFileError, match=r"no models_manifest\.yaml: looked for .*give a folder"):
        find_manifest(tmp_path)


def test_the_package_comes_before_the_checkout(package: Path, tmp_path: Path) -> None:
    checkout = tmp_path / "models_manifest.yaml"
    checkout.write_text("", encoding="utf-8")
    assert find_manifest() == checkout
    installed = package / "_assets" / "models_manifest.yaml"
    installed.parent.mkdir()
    installed.write_text("", encoding="utf-8")
    assert find_manifest() == installed


def test_nothing_anywhere_names_both_places(package: Path) -> None:
    with pytest.raises(ModelFileError, match=r"_assets.* and .*install motionrt again"):
        find_manifest()
