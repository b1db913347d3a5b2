"""Text to motion on tiny models: chance, length, placing, feet, refusals."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tiny_models import TINY_GENERATORS

from motionrt.errors import InvalidInputError
from motionrt.metrics.locomotion import foot_skate
from motionrt.models import Sessions
from motionrt.motion import Motion
from motionrt.motion.transforms import floor_height, heading
from motionrt.synthesis.generating import Generator, finished
from motionrt.synthesis.sampling import Sampling

TEXT = "a person walks in a circle"
SAMPLERS = pytest.mark.parametrize("sampler", ["vae", "diffusion"])


@pytest.fixture(scope="module")
def generator() -> Generator:
    return Generator(Sessions(TINY_GENERATORS, threads=1))


def assert_same(one: Motion, other: Motion) -> None:
    np.testing.assert_array_equal(one.rotations, other.rotations)
    np.testing.assert_array_equal(one.root, other.root)


def told(generator: Generator) -> np.ndarray:
    return generator.sentences.encode(TEXT).token_features[0].mean(axis=0)[:256]


@SAMPLERS
def test_the_same_seed_gives_the_same_motion_alone_and_among_others(generator: Generator, sampler: str) -> None:
    many = generator.generate(TEXT, Sampling(seed=7, n=3, sampler=sampler))
    assert len(many) == 3
    assert_same(generator.generate(TEXT, Sampling(seed=7, sampler=sampler))[0], many[0])
    for one, other in zip(many, generator.generate(TEXT, Sampling(seed=7, n=5, sampler=sampler)), strict=False):
        assert_same(one, other)


@SAMPLERS
def test_samples_and_seeds_differ(generator: Generator, sampler: str) -> None:
    latents = generator.latents(TEXT, Sampling(seed=1, n=3, sampler=sampler))
    others = generator.latents(TEXT, Sampling(seed=2, n=3, sampler=sampler))
    rows = np.concatenate([latents, others])
    apart = np.linalg.norm(rows[:, None] - rows[None], axis=-1)[~np.eye(6, dtype=bool)]
    assert apart.min() > 1e-3


@SAMPLERS
def test_without_temperature_all_seeds_agree(generator: Generator, sampler: str) -> None:
    given = [generator.latents(TEXT, Sampling(seed=seed, n=2, temperature=0, sampler=sampler)) for seed in (0, 9)]
    rows = np.concatenate(given)
    np.testing.assert_array_equal(rows, np.repeat(rows[:1], 4, axis=0))


def test_without_temperature_the_vae_gives_the_mean(generator: Generator) -> None:
    found = generator.latents(TEXT, Sampling(temperature=0, sampler="vae"))[0]
    np.testing.assert_allclose(found, told(generator), atol=1e-6)


def test_the_vae_draws_from_the_distribution_of_the_text(generator: Generator) -> None:
    """The tiny text encoder's standard deviation is 0.5; half the temperature, half as far."""
    for temperature in (1.0, 0.5):
        rows = generator.latents(TEXT, Sampling(seed=0, n=64, temperature=temperature, sampler="vae"))
        away = rows - told(generator)
        assert away.std() == pytest.approx(0.5 * temperature, rel=0.03)
        assert abs(away.mean()) < 0.02 * temperature


def test_one_step_of_diffusion_is_the_denoisers_estimate(generator: Generator) -> None:
    how = Sampling(seed=3, steps=1, guidance=2.0, sampler="diffusion")
    expected = 2 * (0.999 * how.noise(0, 256) + 2.0 * told(generator)) + 0.1
    np.testing.assert_allclose(generator.latents(TEXT, how)[0], expected, atol=1e-4)


def test_guidance_and_steps_matter_to_diffusion_alone(generator: Generator) -> None:
    for sampler, differs in (("diffusion", True), ("vae", False)):
        plain = generator.latents(TEXT, Sampling(seed=0, sampler=sampler))
        for change in ({"guidance": 1.0}, {"steps": 3}):
            other = generator.latents(TEXT, Sampling(seed=0, sampler=sampler, **change))
            assert (not np.allclose(plain, other)) is differs


@pytest.mark.parametrize(("seconds", "frames"), [(0.5, 15), (1.0, 30), (3.3, 99), (4.0, 120), (8.0, 240)])
def test_a_motion_lasts_as_long_as_it_should(generator: Generator, seconds: float, frames: int) -> None:
    motion = generator.generate(TEXT, Sampling(seconds=seconds, seed=0))[0]
    assert motion.frames == frames
    assert motion.fps == 30


def test_the_decoder_sees_few_lengths(generator: Generator, monkeypatch: pytest.MonkeyPatch) -> None:
    seen: set[int] = set()
    decode = generator.temos.decode

    def watched(latent: np.ndarray, mask: np.ndarray) -> np.ndarray:
        seen.add(mask.shape[1])
        return decode(latent, mask)

    monkeypatch.setattr(generator.temos, "decode", watched)
    for frames in range(15, 241):
        assert generator.decode(np.zeros((1, 256), np.float32), frames)[0].frames == frames
    assert seen == set(range(20, 241, 20))


def test_padding_does_not_change_a_frame(generator: Generator) -> None:
    latents = generator.latents(TEXT, Sampling(seed=0))
    long, short = generator.decode(latents, 120)[0], generator.decode(latents, 101)[0]
    np.testing.assert_allclose(short.root, long.root[:101], atol=1e-6)


def test_a_motion_begins_at_the_origin_faces_ahead_and_stands_on_the_floor(generator: Generator) -> None:
    for foot_lock in (False, True):
        motion = generator.generate(TEXT, Sampling(seed=0, foot_lock=foot_lock))[0]
        np.testing.assert_allclose(motion.root[0, [0, 2]], 0, atol=1e-5)
        assert heading(motion)[0] == pytest.approx(0, abs=1e-5)
        assert floor_height(motion) == pytest.approx(0, abs=0.03 if foot_lock else 1e-5)
    raw = generator.decode(generator.latents(TEXT, Sampling(seed=0)), 30)[0]
    assert heading(raw)[0] == pytest.approx(0.5, abs=1e-4)


def test_rotations_are_proper(generator: Generator) -> None:
    rotations = generator.generate(TEXT, Sampling(seed=0))[0].rotations.astype(np.float64)
    products = np.swapaxes(rotations, -1, -2) @ rotations
    np.testing.assert_allclose(products, np.broadcast_to(np.eye(3), products.shape), atol=1e-5)
    np.testing.assert_allclose(np.linalg.det(rotations), 1, atol=1e-5)


def test_a_locked_foot_slides_less_and_only_legs_and_height_change(generator: Generator) -> None:
    sliding = generator.decode(np.full((1, 256), -1.5, np.float32), 40)[0]  # 0.085 m/s on straight legs
    free, locked = finished(sliding, foot_lock=False), finished(sliding)
    legs = [i for i, name in enumerate(free.skeleton.names) if name.endswith(("hip", "knee", "ankle", "foot"))]
    others = np.setdiff1d(np.arange(24), legs)
    np.testing.assert_array_equal(locked.rotations[:, others], free.rotations[:, others])
    np.testing.assert_array_equal(locked.root[:, [0, 2]], free.root[:, [0, 2]])
    assert foot_skate(locked.positions()) < 0.5 * foot_skate(free.positions())


@pytest.mark.parametrize("text", ["", "  \n", None, 3])
def test_texts_that_say_nothing_are_refused(text: Any) -> None:
    with pytest.raises(InvalidInputError, match="text"):
        Generator(Sessions(TINY_GENERATORS)).generate(text)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        *(("seconds", value) for value in (0, 0.4, -1, 10.1, 10_000, float("nan"), float("inf"), "long", None, True)),
        *(("temperature", value) for value in (-0.1, float("nan"), float("inf"), "hot")),
        *(("guidance", value) for value in (-1, float("nan"))),
        *(("n", value) for value in (0, -2, 1.5, True)),
        *(("steps", value) for value in (0, 1001, 2.5)),
        *(("seed", value) for value in (-1, 0.5, "x")),
    ],
)
def test_numbers_out_of_range_are_refused_by_name(name: str, value: Any) -> None:
    with pytest.raises(InvalidInputError, match=rf"^{name} must be a (whole )?number from "):
        Sampling(**{name: value})


def test_an_unknown_sampler_is_refused_with_those_there_are() -> None:
    with pytest.raises(InvalidInputError, match=r"unknown sampler 'gan'; choose one of: motion, diffusion, vae"):
        Sampling(sampler="gan")


def test_a_seed_that_nobody_gave_is_found_afterwards(generator: Generator) -> None:
    drawn = Sampling(sampler="vae")
    assert drawn.seed is not None
    assert drawn.seed != Sampling().seed
    again = Sampling(sampler="vae", seed=drawn.seed)
    assert_same(generator.generate(TEXT, drawn)[0], generator.generate(TEXT, again)[0])


def test_numpy_numbers_are_taken() -> None:
    how = Sampling(seconds=np.float32(2), seed=np.int64(3), n=np.int32(2))
    assert (how.frames, how.seed, how.n) == (60, 3, 2)
