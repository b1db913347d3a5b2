"""The comparison of ``benchmarks/variants.py``: what counts as worse, its table, and its figures for the manifest."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")
pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")

from motionrt_export.measured import Measured

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def compare() -> Iterator[ModuleType]:
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(ROOT / "benchmarks")
        yield import_module("variants")


@pytest.mark.parametrize(
    ("better", "values", "least", "change", "worse"),
    [
        (-1, (2.0, 2.2), 0.0, 0.1, 0.1),  # more of what should be little
        (-1, (2.0, 1.8), 0.0, -0.1, 0.0),
        (1, (50.0, 45.0), 0.0, -0.1, 0.1),  # less of what should be much
        (1, (50.0, 55.0), 0.0, 0.1, 0.0),
        (0, (90.0, 81.0), 0.0, -0.1, 0.1),  # should stay alike
        (-1, (0.0, 0.2), 10.0, 0.02, 0.02),  # hardly anything became hardly anything
    ],
)
def test_what_is_worse(
    compare: ModuleType, better: int, values: tuple[float, float], least: float, change: float, worse: float
) -> None:
    row = compare.Measure("m", better, values, least)
    assert row.change(1) == pytest.approx(change)
    assert row.worse(1) == pytest.approx(worse)
    assert row.worse(0) == 0.0


def test_the_noise_is_the_standard_error_of_the_differences(compare: ModuleType) -> None:
    differences = np.array([[0.0, 0.0, 0.0], [1.0, 2.0, 6.0]])
    assert compare.standard_errors(differences).tolist() == pytest.approx([0.0, np.sqrt(7.0) / np.sqrt(3.0)])
    assert compare.standard_errors(differences[:, :1]).tolist() == [0.0, 0.0]


def test_the_table_says_how_much_and_how_sure(compare: ModuleType) -> None:
    rows = [
        compare.Measure("walking: skate", -1, (0.4, 0.36), noise=(0.0, 0.02)),
        compare.Measure("R@1", 1, (60.1, 120.2)),
    ]
    assert compare.table(["fp32", "int8"], rows).splitlines() == [
        "|  | fp32 | int8 | change |",
        "| --- | ---: | ---: | ---: |",
        "| walking: skate | 0.40 | 0.36 | -10.0 ± 2.0 % |",
        "| R@1 | 60.1 | 120 | +100.0 % |",
    ]


def test_figures_are_noted_at_the_model_that_they_are_about(compare: ModuleType, tmp_path: Path) -> None:
    path = tmp_path / "figures.yaml"
    Measured(benchmark={"walknet": {"int8": {"p50_ms": 1.0}}}).write(path)
    rows = [
        compare.Measure("walking: jerk (m/s³)", -1, (93.81, 94.44)),
        compare.Measure("generation: R@3 (%)", 1, (83.9, 84.0)),
        compare.Measure("transitions: foot skate (cm/frame)", -1, (0.6612, 0.69)),
    ]
    compare.note(path, ["fp32", "int8"], rows)
    found = Measured.read(path)
    assert found.of("quality", "walknet", "fp32") == {"jerk (m/s³)": 93.8}
    assert found.of("quality", "latent_denoiser", "int8") == {"R@3 (%)": 84.0}
    assert found.of("quality", "transnet", "int8") == {"foot skate (cm/frame)": 0.69}
    assert found.of("benchmark", "walknet", "int8") == {"p50_ms": 1.0}
