"""What errors add up to: walks and transitions that the networks make of themselves, and how they are compared."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")
pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")

from tiny_nets import TinySources, tiny_sources  # noqa: E402

from motionrt_export.drift import LEAST_M, TransitionDrift, WalkDrift, beyond_chance, joints, ratio  # noqa: E402
from motionrt_export.measures import beyond  # noqa: E402
from motionrt_export.references import Reference, transition_reference, walk_reference  # noqa: E402
from motionrt_export.tolerances import tolerance  # noqa: E402
from motionrt_export.transitions import Transitions  # noqa: E402
from motionrt_export.walks import standing_start, winding  # noqa: E402

Feeds = Mapping[str, np.ndarray]


@pytest.fixture(scope="module")
def sources(tmp_path_factory: pytest.TempPathFactory) -> TinySources:
    return tiny_sources(tmp_path_factory.mktemp("checkpoints"))


@pytest.fixture(scope="module")
def transitions(sources: TinySources) -> Transitions:
    return Transitions(sources.walks, sources.pose_prior.model)


def pushed(graph: Reference, metres: float) -> Reference:
    """The same, but every new frame stands further to the left of the goal."""

    def step(feeds: Feeds) -> dict[str, np.ndarray]:
        made = graph(feeds)["next"].copy()
        made[:, 216] += metres
        return {"next": made}

    return step


def test_a_walk_beside_itself_does_not_drift(sources: TinySources) -> None:
    reference = walk_reference(sources.walknet.model)
    figures = WalkDrift(sources.walks, steps=35, characters=2)(reference, reference)["walk"]
    assert {key for key, value in figures.items() if value == 1.0} == {"path_deviation_ratio", "foot_skate_ratio"}
    assert sum(figures.values()) == 2.0


def test_a_walk_that_is_pushed_aside_is_beyond_the_tolerance(sources: TinySources) -> None:
    reference = walk_reference(sources.walknet.model)
    figures = WalkDrift(sources.walks, steps=35, characters=2)(pushed(reference, 0.03), reference)
    broken = beyond(figures, {"walk": tolerance("walknet", "int8")["walk"]})
    assert any("path_deviation_ratio" in words for words in broken)
    assert any("joints_cm_after_1_s" in words for words in broken)


def test_a_slight_pull_that_no_walk_would_show_is_beyond_the_tolerance(sources: TinySources) -> None:
    reference = walk_reference(sources.walknet.model)
    figures = WalkDrift(sources.walks, steps=35, characters=2)(pushed(reference, 0.0003), reference)["walk"]
    assert figures["pull_cm_per_s"] == pytest.approx(0.9, rel=1e-3)  # 0.3 mm a frame at 30 fps
    assert figures["step_cm"] == pytest.approx(0.03, rel=1e-3)
    limits = tolerance("walknet", "int8")["walk"]
    assert [words for words in beyond({"walk": figures}, {"walk": limits}) if "pull_cm_per_s" in words]


def test_only_a_difference_beyond_two_standard_errors_counts_as_one() -> None:
    random = np.random.default_rng(0)
    theirs = random.gamma(4.0, 0.012, (2000, 32))  # metres from the path, 0.048 on average
    same = random.gamma(4.0, 0.012, (2000, 32))
    found = [beyond_chance(ours, other, LEAST_M) for ours, other in zip(same, theirs, strict=True)]
    assert np.mean([value > 1.05 for value in found]) < 0.02  # no difference is hardly ever taken for one
    worse = [beyond_chance(1.8 * ours, other, LEAST_M) for ours, other in zip(same, theirs, strict=True)]
    assert np.mean([value > 1.05 for value in worse]) > 0.95  # and one of 80 % hardly ever overlooked


def test_the_standard_error_of_a_ratio_is_that_of_simulated_ones() -> None:
    random = np.random.default_rng(1)
    ours, theirs = random.normal(1.2, 0.1, (4000, 50)), random.normal(1.0, 0.1, (4000, 50))
    simulated = (ours.mean(axis=1) / theirs.mean(axis=1)).std()
    errors = [
        (ratio(a.mean(), b.mean(), 0.0) - beyond_chance(a, b, 0.0)) / 2 for a, b in zip(ours, theirs, strict=True)
    ]
    assert np.mean(errors) == pytest.approx(simulated, rel=0.03)


def test_a_transition_that_is_bent_is_beyond_the_tolerance(sources: TinySources, transitions: Transitions) -> None:
    reference = transition_reference(sources.transnet.model)

    def raised(feeds: Feeds) -> dict[str, np.ndarray]:
        return {"motion": reference(feeds)["motion"] + np.eye(219, dtype=np.float32)[217] * 0.02}

    drift = TransitionDrift(transitions, count=3)
    assert drift(reference, reference)["transition"] == {"joints_cm": 0.0, "end_cm": 0.0, "foot_skate_ratio": 1.0}
    assert drift(raised, reference)["transition"]["end_cm"] == pytest.approx(2.0, abs=0.01)


def test_inputs_of_walknet_are_windows_seen_from_a_goal(sources: TinySources) -> None:
    feeds = sources.walks(5, 1, seed=4)
    assert feeds["frames"].shape == (5, 30, 219)
    rotations = feeds["frames"][..., :216].reshape(-1, 3, 3)
    square = rotations @ rotations.swapaxes(1, 2)
    np.testing.assert_allclose(square, np.broadcast_to(np.eye(3), square.shape), atol=1e-5)
    again = sources.walks(5, 1, seed=4)
    assert all(np.array_equal(feeds[name], again[name]) for name in feeds)


def test_a_gap_lies_between_a_walk_and_a_pose_that_stands_at_the_origin(transitions: Transitions) -> None:
    feeds = transitions(7, 1, seed=2)
    hidden, frames = feeds["hidden"], feeds["frames"]
    assert not hidden[:, :60].any()
    assert hidden[:, 60].all()
    assert not hidden[:, -1].any()
    target = joints(frames[:, -1])
    np.testing.assert_allclose(target[..., 1].min(axis=1), 0.0, atol=1e-4)
    np.testing.assert_allclose(frames[:, -1, [216, 218]], 0.0)


def test_a_walk_begins_with_a_glide_towards_the_origin(sources: TinySources) -> None:
    start = standing_start(sources.walknet.model)
    np.testing.assert_allclose(start[[0, 15, 29], 218], [-29 / 30, -14 / 30, 0.0])
    np.testing.assert_allclose(start[:, 217], 0.9, atol=1e-6)


def test_a_path_goes_on_from_where_a_body_stands() -> None:
    history = np.zeros((30, 219))
    history[-1, [2, 8, 216, 218]] = 1.0, 0.0, 5.0, 7.0  # heading +X
    path = winding(history, 12.0, np.random.default_rng(0))
    np.testing.assert_allclose(path[:3], [[6, 7, np.pi / 2], [7, 7, np.pi / 2], [8, 7, np.pi / 2]], atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(np.diff(path[:, :2], axis=0), axis=1), 1.0)
    assert len(path) >= 12


def test_small_figures_count_as_equal() -> None:
    assert ratio(0.2, 0.1, 0.0) == pytest.approx(2.0)
    assert ratio(2e-6, 1e-6, 0.05) == pytest.approx(1.0, abs=1e-4)


def test_missing_checkpoints_are_named(tmp_path: Path) -> None:
    from motionrt_export.sources import Sources

    with pytest.raises(FileNotFoundError, match=r"no released model at .*walknet\.safetensors"):
        Sources(tmp_path).source("walknet")
