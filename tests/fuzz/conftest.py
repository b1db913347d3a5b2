"""Files of strangers are mutated in forked processes: only where there is ``fork``."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))

collect_ignore = [] if hasattr(__import__("os"), "fork") else ["test_corpus.py", "test_guest.py", "test_mutated.py"]


@pytest.fixture(scope="session")
def corpus(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the corpus, with the files that some of it names beside it."""
    folder = tmp_path_factory.mktemp("hostile") / "corpus"
    shutil.copytree(HERE / "corpus", folder)
    (folder / "map.pgm").write_bytes(b"P5\n20 20\n255\n" + bytes([254]) * 400)
    (folder / "living_room.csv").write_text("x,y,z,label\n0,0,0,floor\n", encoding="utf-8")
    return folder
