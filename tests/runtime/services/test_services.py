"""Services stand alone: walking opens nothing of search, generating nothing of walking."""

from __future__ import annotations

import subprocess
import sys

import pytest

WALK = """
import sys
sys.path[:0] = {paths!r}
from fake_character_models import FakeCharacterModels
from motionrt.services import Locomotion
rt = Locomotion()
rt.character_models = FakeCharacterModels()
assert rt.walk((0, 3)).motion.frames > 30
"""
GENERATE = """
import sys
sys.path[:0] = {paths!r}
from tiny_models import TINY_GENERATORS
from motionrt.services import Synthesis
assert len(Synthesis(TINY_GENERATORS, variant="tiny").generate("walk", 1.0, n=2, seed=1)) == 2
"""
TOLD = """
print(*sorted(name for name in sys.modules if name.startswith({unwanted!r})))
"""


@pytest.mark.parametrize(
    ("code", "unwanted"),
    [
        (WALK, ("motionrt.retrieval", "motionrt.synthesis", "tokenizers", "onnxruntime")),
        (GENERATE, ("motionrt.retrieval", "motionrt.locomotion")),
    ],
    ids=["walking", "generating"],
)
def test_a_service_alone_loads_none_of_the_others(code: str, unwanted: tuple[str, ...]) -> None:
    script = (code + TOLD).format(paths=sys.path, unwanted=unwanted)
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == []
