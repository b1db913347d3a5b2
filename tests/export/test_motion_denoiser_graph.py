"""The denoiser of motions: what is exported computes what was trained, and listens to all that it is told."""

from __future__ import annotations

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")
pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")

from tiny_nets import tiny_motion_denoiser  # noqa: E402

from motionrt.synthesis.motion_diffusion import held_columns  # noqa: E402
from motionrt_export import specs  # noqa: E402
from motionrt_export.examples import random_examples  # noqa: E402
from motionrt_export.motion_denoiser_graph import MotionDenoiserGraph  # noqa: E402
from motionrt_export.references import motion_denoiser_reference  # noqa: E402
from motionrt_export.trace import trace  # noqa: E402
from motionrt_export.validate import open_session, run  # noqa: E402

SPEC = specs.MOTION_DENOISER


def feeds(batch: int, length: int) -> dict[str, np.ndarray]:
    found = random_examples(SPEC)(batch, length, seed=batch)
    holding = np.zeros_like(found["holding"])
    holding[:, :1] = True
    mask = np.ones((batch, length), bool)
    return {**found, "level": np.abs(found["level"]) + 0.1, "mask": mask, "holding": holding}


@pytest.mark.parametrize(("batch", "length"), [(1, 1), (1, 7), (3, 40), (2, 200)])
def test_the_file_computes_the_guided_estimate_at_every_size(batch: int, length: int) -> None:
    model = tiny_motion_denoiser()
    session = open_session(trace(MotionDenoiserGraph(model), SPEC).SerializeToString())
    given = feeds(batch, length)
    expected = motion_denoiser_reference(model)(given)
    for name, value in run(session, given).items():
        np.testing.assert_allclose(value, expected[name], atol=1e-4)


@pytest.mark.parametrize("name", ["noisy", "level", "token_features", "slots", "numbers", "holding", "guidance"])
def test_every_input_counts(name: str) -> None:
    step, given = motion_denoiser_reference(tiny_motion_denoiser()), feeds(1, 12)
    given |= {"known": np.ones_like(given["known"]), "attention_mask": np.ones_like(given["attention_mask"])}
    changed = (
        ~given[name] if given[name].dtype == bool else (given[name] + 1) % 3 if name == "slots" else 1 - 2 * given[name]
    )
    other = {**given, name: np.abs(changed) if name == "level" else changed}
    assert np.abs(step(given)["clean"] - step(other)["clean"]).max() > 1e-4


def test_without_guidance_the_text_says_nothing() -> None:
    step, given = motion_denoiser_reference(tiny_motion_denoiser()), feeds(1, 12)
    given["guidance"] = np.zeros_like(given["guidance"])
    other = {**given, "token_features": -given["token_features"]}
    np.testing.assert_array_equal(step(given)["clean"], step(other)["clean"])


def test_what_is_held_is_answered_as_it_was_given() -> None:
    given = feeds(2, 12)
    given["holding"] = np.zeros_like(given["holding"])
    given["holding"][:, 5, 2] = True
    found = motion_denoiser_reference(tiny_motion_denoiser())(given)["motion"]
    columns = held_columns() == 2
    np.testing.assert_allclose(found[:, 5, columns], given["held"][:, 5, columns], atol=1e-5)
    assert np.abs(found[:, 4, columns] - given["held"][:, 4, columns]).min() > 1e-3


def test_frames_that_are_padding_change_nothing() -> None:
    step, given = motion_denoiser_reference(tiny_motion_denoiser()), feeds(1, 40)
    given["mask"][:, 21:] = False
    short = {k: v[:, :21] if v.ndim > 1 and v.shape[1] == 40 else v for k, v in given.items()}
    np.testing.assert_allclose(step(given)["clean"][:, :21], step(short)["clean"], atol=1e-4)
