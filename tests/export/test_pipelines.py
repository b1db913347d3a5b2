"""What files make together beside torch: the same runtime beside itself is equal, and one that is bent is not."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")
pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")

from fake_character_models import FakeCharacterModels
from tiny_nets import tiny_sources

from motionrt import Motion, Runtime
from motionrt_export.measures import beyond
from motionrt_export.pipelines import ARMS, LEGS, SCRIPT, CompositionDrift, PerformanceDrift, performed
from motionrt_export.tolerances import PIPELINES, pipeline_tolerance
from motionrt_export.torch_runtime import TorchRuntime

SHORT = """
start: [0, 0]
steps:
  - walk: {to: [0, 3]}
  - act:
      name: reach
      keypoints: {right_hand: [0.3, 1.2, 3.5], left_foot: [0.1, 0, 3.2], right_foot: [-0.1, 0, 3.2]}
      hold: 1
  - walk: {to: [1, 5]}
"""


class Moved(Runtime):
    """CharacterModels that have learned nothing, with an offset to every frame of a walk."""

    def __init__(self, aside: float = 0.0) -> None:
        super().__init__()
        self.aside = aside

    @property
    def character_models(self) -> Any:  # type: ignore[override]
        character_models = FakeCharacterModels()
        step = character_models.walk

        def walk(frames: np.ndarray, speed: np.ndarray) -> np.ndarray:
            made = step(frames, speed).copy()
            made[:, 216] += self.aside
            return made

        character_models.walk = walk
        return character_models


@pytest.fixture(scope="module")
def script(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("scripts") / "short.yaml"
    path.write_text(SHORT, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def runtime(tmp_path_factory: pytest.TempPathFactory) -> TorchRuntime:
    return TorchRuntime(tiny_sources(tmp_path_factory.mktemp("checkpoints")))


def test_a_performance_beside_itself_is_equal(script: Path) -> None:
    figures = PerformanceDrift(Moved(), script=script)(Moved())
    assert beyond(figures, pipeline_tolerance("performance", "fp32")) == []
    assert figures["performance"]["end_cm"] == 0.0
    assert {key for key, value in figures["performance"].items() if value == 1.0} >= {
        "seconds_ratio", "path_deviation_ratio", "foot_skate_ratio", "keypoint_ratio",
    }  # fmt: skip


def test_a_walk_that_is_pushed_aside_is_beyond_the_tolerance(script: Path) -> None:
    figures = PerformanceDrift(Moved(), script=script)(Moved(aside=0.02))
    broken = beyond(figures, pipeline_tolerance("performance", "int8"))
    assert any("path_deviation_ratio" in words for words in broken)


def test_a_step_that_is_missing_is_counted(script: Path) -> None:
    whole = Moved().play(script)
    less = dataclasses.replace(whole, segments=whole.segments[:-2])
    assert performed(less, whole)["segments_missed"] == 2.0
    renamed = dataclasses.replace(whole.segments[0], name="another")
    other = dataclasses.replace(whole, segments=(renamed, *whole.segments[1:]))
    assert performed(other, whole)["segments_missed"] == 1.0


def test_a_composition_beside_itself_is_equal(runtime: TorchRuntime) -> None:
    figures = CompositionDrift(runtime, count=2, seconds=0.7)(runtime)["composition"]
    assert figures == {"joints_cm": 0.0, "end_cm": 0.0, "foot_skate_ratio": 1.0, "other_parts_percent": 0.0}


def test_a_text_that_is_made_otherwise_is_beyond_the_tolerance(runtime: TorchRuntime) -> None:
    class Lifted(TorchRuntime):
        def generate(self, *given: Any, **options: Any) -> Any:
            made: Motion = super().generate(*given, **options)
            rotations = made.rotations[[0] * made.frames].copy()
            rotations[:, 16] = np.eye(3)[[1, 0, 2]] * [1, -1, 1]
            return dataclasses.replace(made, rotations=rotations)

    lifted = Lifted(runtime._sources)
    figures = CompositionDrift(runtime, count=1, seconds=0.7)(lifted)
    assert any("joints_cm" in words for words in beyond(figures, pipeline_tolerance("composition", "int8")))


def test_two_hundred_compositions_are_two_hundred_pairs_of_texts() -> None:
    assert len(set(LEGS)) * len(set(ARMS)) == 200
    asked: list[tuple[str, str]] = []

    class Recording:
        def generate(self, text: str, seconds: float, seed: int) -> str:
            asked.append((text, str(seed)))
            return text

        def body_parts(self, text: str) -> set[str]:
            return set()

        def compose(self, motions: list[str], parts: Any, seed: int) -> SimpleNamespace:
            return SimpleNamespace(texts=tuple(motions))

    made = CompositionDrift(Recording())._expected  # type: ignore[arg-type]
    assert len({composed.motion.texts for composed in made}) == 200
    assert len(asked) == 400


def test_the_script_is_there_and_every_pipeline_has_a_tolerance() -> None:
    assert SCRIPT.is_file()
    for pipeline, by_variant in PIPELINES.items():
        assert set(by_variant) == {"fp32", "int8"}
        assert pipeline_tolerance(pipeline, "fp16") == by_variant["fp32"]
