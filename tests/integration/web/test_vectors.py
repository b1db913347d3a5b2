"""The test vectors hold for motionrt-web, with motions of the same seed equal to the millimetre in float arithmetic."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from motionrt.synthesis.finishing import locked
from motionrt.synthesis.motion_generator import MotionGenerator, Wanted
from motionrt.synthesis.sampling import Sampling
from motionrt.synthesis.timeline import Line, lines_of_text, read_timeline
from motionrt.web.folder import motion_rows

from .conftest import Ask
from .test_in_node import as_motion

pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")
pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")

ROOT = Path(__file__).parents[3]
TEXTS: tuple[tuple[str, float], ...] = (
    *(("a person claps", 4.0), ("a person points with the left hand", 3.25), ("somebody takes a bow", 4.0)),
    *(("a person marches in place", 4.0), ("a man kneels on one knee", 4.0), ("stands on one leg", 3.0)),
    *(("a person throws a ball", 4.0), ("a woman drinks from a cup", 4.0), ("a person crawls", 4.0)),
    *(("sidesteps to the left", 4.0), ("a person turns right", 2.55), ("looks around and nods", 4.0)),
    *(("walks forward then sits down", 4.0), ("hops three times on the left leg", 4.0), ("a man lies down", 4.0)),
    *(
        ("takes a stroll in a zigzag", 4.0),
        ("plays air guitar", 3.0),
        ("strafes leftward", 4.0),
        ("spins twice", 4.0),
        ("jumps forward", 3.0),
    ),
    *(("stands still", 3.0), ("wave with the right hand", 4.0), ("a person walks forward", 9.5)),
)
TIMELINE = (("a person walks forward", 3.0), ("a person claps three times and looks up", 2.5))
MODELS = ("tmr_text", "walknet", "motion_denoiser")


@pytest.fixture(scope="module")
def portable_files(site: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    from motionrt_export.portable import portable
    from motionrt_export.sources import Sources

    folder = tmp_path_factory.mktemp("portable_files")
    for name in MODELS:
        model = portable(Sources(ROOT / "models").source(name))
        (folder / f"{name}.portable.onnx").write_bytes(model.SerializeToString())
    return folder


@pytest.fixture(scope="module")
def vectors(portable_files: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    from motionrt_export.vectors import write_vectors

    return write_vectors(tmp_path_factory.mktemp("vectors"), portable_files)


@pytest.fixture(scope="module")
def float_site(site: Path, portable_files: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same folder with the portable files."""
    out = tmp_path_factory.mktemp("float")
    (out / "tokenizer.json").symlink_to(site / "tokenizer.json")
    models = {name: {"file": f"{name}.portable.onnx"} for name in MODELS}
    for entry in models.values():
        (out / entry["file"]).symlink_to(portable_files / entry["file"])
    (out / "models.json").write_text(json.dumps({"version": "float", "models": models, "galleries": []}))
    return out


def test_tokens_and_embeddings_are_those_of_the_vectors(ask: Ask, vectors: Path) -> None:
    told = json.loads(vectors.read_text())
    wanted = np.load(vectors.parent / "embeddings.npy")
    found = np.array(ask("embed", texts=[one["text"] for one in told["texts"][: len(wanted)]]))
    assert (found * wanted).sum(axis=1).min() > 0.98  # quantised beside float
    assert ask("tokens", texts=[one["text"] for one in told["texts"]]) == [one["ids"] for one in told["texts"]]


def test_600_frames_of_a_walk_are_those_of_the_vectors(ask: Ask, vectors: Path, float_site: Path) -> None:
    told, frames = json.loads(vectors.read_text()), np.load(vectors.parent / "walk_frames.npy")
    walk = ask("walk", site=float_site, goals=told["walk"]["goals"], frames=len(frames), speed=told["walk"]["speed"])
    np.testing.assert_allclose(walk, frames, atol=1e-3)


def test_a_seed_gives_the_same_motion(ask: Ask, vectors: Path, float_site: Path) -> None:
    for number, one in enumerate(json.loads(vectors.read_text())["motions"]):
        asked = {key: one[key] for key in ("text", "seconds", "seed", "steps")}
        found = as_motion(ask("generate", site=float_site, **asked))
        np.testing.assert_allclose(motion_rows(found), np.load(vectors.parent / f"motion_{number}_rows.npy"), atol=1e-3)


def test_gestures_and_steps_are_those_of_python(ask: Ask, portable_files: Path, float_site: Path) -> None:
    from motionrt_export.vectors import FloatSessions

    generator = MotionGenerator(FloatSessions(portable_files))
    asked: list[list[tuple[str, float]]] = [[one] for one in TEXTS] + [list(TIMELINE)]
    jobs = [
        {"what": [{"text": text, "seconds": seconds} for text, seconds in lines], "seed": seed, "footLock": lock}
        for seed, lines in enumerate(asked)
        for lock in (False, True)
    ]
    made = [as_motion(one) for one in ask("motions", site=float_site, asked=jobs)]
    for seed, lines in enumerate(asked):
        wanted = Wanted(read_timeline(lines, lambda _: frozenset()))
        drawn = generator.generate(wanted, Sampling(seed=seed, foot_lock=False))[0]
        for found, motion, metres in zip(
            made[2 * seed : 2 * seed + 2], (drawn, locked(drawn, walking=True)), (1e-3, 5e-3), strict=True
        ):
            np.testing.assert_allclose(found.positions(), motion.positions(), rtol=0, atol=metres, err_msg=str(lines))


def test_the_acts_of_a_text_follow_one_another_as_in_python(ask: Ask, portable_files: Path, float_site: Path) -> None:
    from motionrt_export.vectors import FloatSessions

    text = "after waving, he turns around, walks back and then has a seat"
    lines = lines_of_text(text, 6.0)
    assert len(lines) == 4
    drawn = MotionGenerator(FloatSessions(portable_files)).generate(Wanted(lines), Sampling(seconds=6.0, seed=3))[0]
    found = as_motion(ask("generate", site=float_site, text=text, seconds=6, seed=3))
    np.testing.assert_allclose(found.positions(), drawn.positions(), rtol=0, atol=5e-3)


def test_the_longest_text_gives_300_frames_of_the_same_motion(ask: Ask, portable_files: Path, float_site: Path) -> None:
    from motionrt_export.vectors import FloatSessions

    wanted = Wanted((Line("a person walks forward", 0.0, 10.0),))
    drawn = MotionGenerator(FloatSessions(portable_files)).generate(wanted, Sampling(seconds=10.0, seed=12))[0]
    found = as_motion(ask("generate", site=float_site, text="a person walks forward", seconds=10, seed=12))
    assert found.frames == drawn.frames == 300
    np.testing.assert_allclose(found.positions(), drawn.positions(), rtol=0, atol=5e-3)


def test_quantised_files_make_nearly_the_same_motion(ask: Ask, vectors: Path) -> None:
    one = json.loads(vectors.read_text())["motions"][0]
    asked = {key: one[key] for key in ("text", "seconds", "seed", "steps")}
    rows = np.load(vectors.parent / "motion_0_rows.npy")
    found = motion_rows(as_motion(ask("generate", **asked)))
    assert np.abs(found[:, :3] - rows[:, :3]).mean() < 0.05  # metres
