"""The benchmark of making motion: what it calls, and what it leaves out."""

from __future__ import annotations

import numpy as np
import pytest
from tiny_models import TINY, TINY_GENERATORS

from motionrt import Motion, Runtime
from motionrt.bench import worker
from motionrt.bench.cases import BENCHMARKS
from motionrt.bench.generation import BODY_PARTS, COMPOSE, DECODE, FRAMES, compose_call, generate_calls, generate_case
from motionrt.bench.setting import Setting
from motionrt.bench.timing import Turns
from motionrt.bench.workload import TEXTS, Workload

SAMPLERS = ("motion", "diffusion", "vae")
CASES = [generate_case(sampler) for sampler in SAMPLERS]


@pytest.fixture(scope="module")
def setting() -> Setting:
    return Setting(str(TINY_GENERATORS), 1, Workload.standard())


def test_texts_become_the_motions_that_the_runtime_makes(setting: Setting) -> None:
    runtime = Runtime(TINY_GENERATORS, threads=1)
    for sampler, call in zip(SAMPLERS, generate_calls(setting.runtime.generator).values(), strict=True):
        for text in (*TEXTS, TEXTS[0]):
            made, expected = call(), runtime.generate(text, FRAMES / 30, seed=0, sampler=sampler)
            assert isinstance(made, Motion)
            assert made.frames == FRAMES
            np.testing.assert_array_equal(made.rotations, expected.rotations)


def test_the_decoder_alone_gives_raw_features(setting: Setting) -> None:
    found = np.asarray(BENCHMARKS["decode"].cases(setting)[DECODE].call())
    assert found.shape == (1, FRAMES, 135)
    assert np.isfinite(found).all()


def test_a_composition_is_as_long_as_its_layers(setting: Setting) -> None:
    made = compose_call(setting.runtime)()
    assert isinstance(made, Motion)
    assert made.frames == FRAMES


def test_every_benchmark_has_its_cases(setting: Setting) -> None:
    cases = [list(BENCHMARKS[name].cases(setting)) for name in ("generate", "decode", "compose", "parts")]
    assert cases == [CASES, [DECODE], [COMPOSE], [BODY_PARTS]]
    assert not setting.missing(BENCHMARKS["generate"].models)


def test_without_models_motions_are_composed_all_the_same() -> None:
    found = worker.measure(str(TINY), 1, turns=Turns(1, 1, 0), only=["generate", "compose", "parts"])
    assert [case["case"] for case in found["cases"]] == [COMPOSE, BODY_PARTS]
    assert found["left_out"]["generate"].startswith("no model temos_text, temos_decoder")
