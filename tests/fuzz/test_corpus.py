"""One input of every class of untyped error, hang or memory blow-up that was ever found: what each is now."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from doors import door_of
from measured import measured, warm

HERE = Path(__file__).parent
EXPECTED: dict[str, str] = json.loads((HERE / "expected.json").read_text(encoding="utf-8"))
HELPERS = {"bomb9000.png"}  # named by png9000.yaml


@pytest.fixture(scope="module", autouse=True)
def imports() -> None:
    warm()


def test_every_file_of_the_corpus_has_its_error() -> None:
    assert {path.name for path in (HERE / "corpus").iterdir()} - HELPERS == set(EXPECTED)


@pytest.mark.parametrize("name", sorted(EXPECTED))
def test_a_hostile_file_is_refused_by_its_type_or_read_at_little_cost(corpus: Path, name: str) -> None:
    if name.startswith(("mesh-", "png")):
        pytest.importorskip("trimesh", reason="meshes and images need the extra 'scene'")
    outcome = measured(door_of(name), corpus / name)
    assert (outcome.error or outcome.kind) == EXPECTED[name], outcome
    assert outcome.good, outcome
