"""The latent denoiser: what an untrained one says, guidance, unseen text, the cache of latents, and that it learns."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
import torch

from motionrt.synthesis.diffusion import schedule
from motionrt_training.latent_cache import Latents, cached_latents, encode_views
from motionrt_training.networks.latent_denoiser import LatentDenoiser, draw_latents
from motionrt_training.networks.temos import Temos
from motionrt_training.recipes.latent_diffusion import DenoiserSettings, LatentDiffusionTask, nearness
from motionrt_training.trainer import Schedule, Trainer

SMALL = DenoiserSettings(layers=3, heads=2, ff=32, d=32, dropout=0.0, batch=32, text_noise=0.0, snr_cap=2.0)


def denoiser(**changes: float) -> LatentDenoiser:
    """A small one that has something to say."""
    torch.manual_seed(0)
    model = LatentDenoiser(**{"text_dim": 12, "latent": 8, "d": 16, "layers": 5, "heads": 2, "ff": 32, **changes})
    model.out.weight.data.normal_(0.0, 0.2)
    model.latent_mean.normal_()
    model.latent_std.uniform_(0.5, 2.0)
    return model.eval().requires_grad_(False)


def inputs(batch: int = 3, words: int = 5) -> tuple[torch.Tensor, ...]:
    source = torch.Generator().manual_seed(1)
    latent = torch.randn(batch, 8, generator=source)
    tokens = torch.randn(batch, words, 12, generator=source)
    return latent, torch.arange(batch) * 400, tokens, torch.ones(batch, words, dtype=torch.int64)


def speak(texts: tuple[str, ...]) -> npt.NDArray[np.float32]:
    """Features that differ with the word and length with it."""
    length = len(texts[0])
    return np.tile(np.float32([texts[0] == "left", texts[0] == "right", 1.0]), (length, 1))


def clusters(count: int, seed: int) -> Latents:
    """Latents about +2 where the text is "left", -2 where it is "right"; a narrow posterior."""
    rng = np.random.default_rng(seed)
    side = np.where(rng.random(count) < 0.5, 1.0, -1.0)
    mu = (10.0 + 2.0 * side[:, None] + 0.1 * rng.standard_normal((count, 4))).astype(np.float32)
    texts = tuple(("left",) if s > 0 else ("right",) for s in side)
    return Latents(mu, np.full((count, 4), -4.0, np.float32), texts)


def test_an_untrained_network_gives_the_best_guess_that_knows_no_more_than_the_variance() -> None:
    """E[z_0 | z_t] = sqrt(a_t) z_t for standard normal z_0."""
    latent, time, tokens, mask = inputs()
    found = LatentDenoiser(text_dim=12, latent=8, d=16, heads=2, ff=32).eval()(latent, time, tokens, mask)
    expected = torch.from_numpy(schedule()[time.numpy()] ** 0.5)[:, None] * latent
    torch.testing.assert_close(found, expected.float(), atol=1e-6, rtol=1e-5)


def test_noise_is_mixed_in_as_the_schedule_says() -> None:
    clean, noise = torch.randn(2, 3, 8, generator=torch.Generator().manual_seed(2))
    time = torch.tensor([0, 500, 999])
    signal = torch.from_numpy(schedule()[time.numpy()])[:, None]
    expected = signal.sqrt() * clean + (1 - signal).sqrt() * noise
    torch.testing.assert_close(denoiser().noised(clean, time, noise), expected.float(), atol=1e-6, rtol=1e-5)


def test_guidance_lies_on_the_line_through_the_answers_with_and_without_text() -> None:
    model, (latent, time, tokens, mask) = denoiser(), inputs()
    with_text, without = model(latent, time, tokens, mask), model(latent, time, tokens, torch.zeros_like(mask))
    assert (with_text - without).abs().max() > 0.05
    clean, raw = model.guided(latent, time, tokens, mask, torch.tensor([0.0, 1.0, 3.5]))
    torch.testing.assert_close(clean[0], without[0])
    torch.testing.assert_close(clean[1], with_text[1])
    torch.testing.assert_close(clean[2], 3.5 * with_text[2] - 2.5 * without[2])
    torch.testing.assert_close(raw, clean * model.latent_std + model.latent_mean)


def test_hidden_tokens_change_nothing() -> None:
    model, (latent, time, tokens, mask) = denoiser(), inputs()
    mask[:, 3:] = 0
    other = tokens.clone()
    other[:, 3:] = 99.0
    torch.testing.assert_close(model(latent, time, tokens, mask), model(latent, time, other, mask))
    short = model(latent, time, tokens[:, :3], mask[:, :3])
    torch.testing.assert_close(model(latent, time, tokens, mask), short)
    silent = torch.zeros_like(mask)
    torch.testing.assert_close(model(latent, time, tokens, silent), model(latent, time, -tokens, silent))


def test_order_of_words_and_time_matter() -> None:
    model, (latent, time, tokens, mask) = denoiser(), inputs()
    found = model(latent, time, tokens, mask)
    assert (found - model(latent, time, tokens.flip(1), mask)).abs().max() > 1e-3
    assert (model.angle.cos().square() - torch.from_numpy(schedule())).abs().max() < 1e-6


def test_every_layer_and_skip_is_used() -> None:
    model = denoiser().train().requires_grad_(True)
    model(*inputs()).square().sum().backward()
    assert len(model.skips) == 2
    assert all(p.grad is not None and p.grad.abs().max() > 0 for p in model.parameters())


@pytest.mark.parametrize("layers", [1, 3, 5])
def test_training_computes_the_same_with_less_work(layers: int) -> None:
    model, (latent, time, tokens, mask) = denoiser(layers=layers, dropout=0.0), inputs()
    mask[1, 2:] = 0
    expected = model(latent, time, tokens, mask)
    torch.testing.assert_close(model.train()(latent, time, tokens, mask), expected)


def test_an_even_number_of_layers_has_no_middle() -> None:
    with pytest.raises(ValueError, match="odd, not 4"):
        LatentDenoiser(layers=4)


def test_statistics_are_those_of_samples_of_the_posteriors() -> None:
    rng = np.random.default_rng(0)
    mu = rng.normal(3.0, 2.0, (500, 2)).astype(np.float32)
    logvar = np.log(np.float32([[1.0, 9.0]])).repeat(500, 0)
    latents = Latents(mu, logvar, (("x",),) * 500)
    mean, std = latents.statistics()
    drawn = latents.sample(np.arange(500).repeat(200), rng)
    np.testing.assert_allclose(mean, drawn.mean(0), atol=0.05)
    np.testing.assert_allclose(std, drawn.std(0), rtol=0.02)


def test_views_keep_their_order_and_get_the_posterior_of_the_encoder() -> None:
    torch.manual_seed(0)
    temos = Temos(d=16, layers=1, heads=2, ff=16, dropout=0.5)
    rng = np.random.default_rng(1)
    frames = [rng.standard_normal((length, 136)).astype(np.float32) for length in (40, 16, 33)]
    found = encode_views(temos, ((part, (f"{len(part)}",)) for part in frames))
    assert found.texts == (("40",), ("16",), ("33",))
    for row, part in enumerate(frames):
        with torch.no_grad():
            alone = temos.eval().motion_encoder(torch.from_numpy(part)[None], torch.ones(1, len(part)).bool())
        np.testing.assert_allclose(found.mu[row], alone.mu[0], atol=1e-5)
        np.testing.assert_allclose(found.logvar[row], alone.logvar[0], atol=1e-5)
    with pytest.raises(ValueError, match="no views"):
        encode_views(temos, [])


def test_latents_are_computed_once_for_one_key(tmp_path: Path) -> None:
    calls: list[int] = []

    def compute() -> Latents:
        calls.append(1)
        return clusters(5, seed=len(calls))

    first, again = (cached_latents(["a", "b"], compute, tmp_path) for _ in range(2))
    assert len(calls) == 1
    np.testing.assert_array_equal(first.mu, again.mu)
    assert again.texts == first.texts
    cached_latents(["ab"], compute, tmp_path)
    assert len(calls) == 2


def test_a_batch_depends_on_the_step_alone_and_most_texts_are_shown() -> None:
    task = LatentDiffusionTask(clusters(300, 0), clusters(20, 1), speak, SMALL, seed=3)
    batch, same, other = task.batch(11), task.batch(11), task.batch(12)
    assert all(torch.equal(value, same[name]) for name, value in batch.items())
    assert not torch.equal(batch["latent"], other["latent"])
    shown = torch.stack([task.batch(step)["mask"].any(1).float().mean() for step in range(40)]).mean()
    assert 0.86 < shown < 0.94  # of 1280 texts one in ten is hidden
    times = np.sort(batch["timestep"].numpy())
    edges = 1000 / 32 * np.arange(33)
    assert (np.floor(edges[:-1]) <= times).all()  # one of every 32nd part
    assert (times < edges[1:]).all()


def test_texts_of_like_length_are_batched_together() -> None:
    task = LatentDiffusionTask(clusters(300, 0), clusters(20, 1), speak, SMALL, seed=3)
    alike = [len(set(task.lengths[task._rows(step)])) == 1 for step in range(8)]
    assert sum(alike) >= 7  # "left" and "right" meet in one of eight batches


def test_nearness_counts_who_is_nearer_than_the_own_latent() -> None:
    truth = torch.tensor([[0.0], [1.0], [5.0], [5.0]])
    measures = nearness(torch.tensor([[0.1], [0.2], [4.9], [5.2]]), truth)
    assert measures == {"own": pytest.approx(3 / 4), "nearer": pytest.approx(1 / 16)}


def test_two_clusters_are_told_apart_by_their_texts(tmp_path: Path) -> None:
    settings = dataclasses.replace(SMALL, no_text=0.3)
    task = LatentDiffusionTask(clusters(400, 0), clusters(30, 1), speak, settings, seed=0)
    plan = Schedule(steps=300, lr=3e-3, warmup=10, ema=0.98, validate_every=300, device="cpu", bf16=False)
    measures = Trainer(task, plan, tmp_path, {"network": task.model.config}).run()
    assert measures["error_999"] < 0.1  # of 1: the text tells nearly everything
    model = task.model.eval()
    noise = torch.randn(200, 4, generator=torch.Generator().manual_seed(5))
    words = [("left",), ("right",)] * 100
    tokens = torch.from_numpy(np.stack([np.pad(speak(word), ((0, 5 - len(word[0])), (0, 0))) for word in words]))
    mask = torch.from_numpy(np.arange(5) < np.array([[len(word[0])] for word in words]))
    drawn = draw_latents(model, tokens, mask, noise, steps=10, guidance=1.0)
    torch.testing.assert_close(drawn[0::2].mean(0), torch.full((4,), 12.0), atol=0.25, rtol=0.0)
    torch.testing.assert_close(drawn[1::2].mean(0), torch.full((4,), 8.0), atol=0.25, rtol=0.0)
    free = draw_latents(model, tokens, mask, noise, steps=10, guidance=0.0).mean(1)
    assert 0.2 < float((free > 10.0).float().mean()) < 0.8  # without text both are drawn ...
    assert float(((free - 10.0).abs() > 1.0).float().mean()) > 0.8  # ... and little between them
