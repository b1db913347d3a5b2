"""Pages in a real browser; skipped, with the reason, where viser or Chromium are not installed."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterator
from pathlib import Path

import pytest
from chromium import Browser, browser, find_chromium


@pytest.fixture(scope="session")
def viser() -> None:
    if importlib.util.find_spec("viser") is None:
        pytest.skip('viser is not installed (pip install "motionrt[studio]")')


@pytest.fixture(scope="session")
def chromium(viser: None, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    if find_chromium() is None:
        pytest.skip("no Chromium on this machine (Debian: apt install chromium)")
    with browser(tmp_path_factory.mktemp("chromium")) as opened:
        yield opened


@pytest.fixture(scope="session")
def walk_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    from motions import walking

    return walking(90, fps=30).grounded().save(tmp_path_factory.mktemp("clips") / "my walk.bvh")
