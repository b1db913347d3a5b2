"""Short runs of the soak (tests/fuzz/soak.py): flat memory, and threads that agree."""

from __future__ import annotations

from pathlib import Path

import pytest
from soak import GROWTH_MB, differing, growth, verbs


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="memory is read from /proc")
def test_memory_is_flat_over_many_calls(tmp_path: Path) -> None:
    made = verbs(tmp_path)
    grown = {name: growth(made[name], 300, None)[1] for name in ("load", "search", "mirror")}
    assert max(grown.values()) < GROWTH_MB, grown


def test_threads_answer_as_one_does(tmp_path: Path) -> None:
    assert differing(verbs(tmp_path), threads=16, rounds=3) == []
