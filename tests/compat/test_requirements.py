"""What the script that tests old and new dependencies reads from pyproject.toml."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("tomllib", reason="the script needs Python 3.11")
from run import ROOT, requirements


def test_the_lowest_versions_are_those_behind_the_signs(tmp_path: Path) -> None:
    text = '[project]\ndependencies = ["NumPy>=1.26", "a-b >= 2.0.1"]\n[project.optional-dependencies]\nx = ["c>=3"]\n'
    (tmp_path / "pyproject.toml").write_text(text, encoding="utf-8")
    assert requirements(tmp_path / "pyproject.toml") == {"numpy": "1.26", "a-b": "2.0.1"}
    assert requirements(tmp_path / "pyproject.toml", ["x"]) == {"numpy": "1.26", "a-b": "2.0.1", "c": "3"}


def test_releases_that_are_excluded_do_not_hide_the_lowest(tmp_path: Path) -> None:
    text = '[project]\ndependencies = ["a>=1.2,!=1.4.1, != 1.9.0"]\n[project.optional-dependencies]\n'
    (tmp_path / "pyproject.toml").write_text(text, encoding="utf-8")
    assert requirements(tmp_path / "pyproject.toml") == {"a": "1.2"}


def test_a_dependency_without_a_lowest_version_is_refused(tmp_path: Path) -> None:
    text = '[project]\ndependencies = ["numpy"]\n[project.optional-dependencies]\n'
    (tmp_path / "pyproject.toml").write_text(text, encoding="utf-8")
    with pytest.raises(SystemExit, match="numpy"):
        requirements(tmp_path / "pyproject.toml")


def test_every_dependency_of_the_project_has_a_lowest_version() -> None:
    assert "numpy" in requirements(ROOT / "pyproject.toml", ["scene", "render"])
