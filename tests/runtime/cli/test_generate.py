"""``motionrt generate``."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tiny_models import TINY, TINY_GENERATORS

from motionrt import Runtime, load_motion
from motionrt.cli import main

RunJson = Callable[..., Any]
TEXT = "wave the right hand"
MODELS = ("--models", TINY_GENERATORS)


@pytest.fixture(autouse=True)
def fake_models() -> None:
    """The tiny models are used as they are."""


def test_a_motion_is_written_and_told(run_json: RunJson, tmp_path: Path) -> None:
    out = tmp_path / "wave.bvh"
    found = run_json("generate", TEXT, "-o", out, "--seconds", 2, "--seed", 1, *MODELS)
    assert found.keys() == {"text", "seed", "sampler", "temperature", "candidates", "motions"}
    assert (found["text"], found["seed"], found["temperature"]) == (TEXT, 1, 1.0)
    assert found["sampler"] == "motion"
    assert found["candidates"] == 8
    (motion,) = found["motions"]
    assert motion.keys() == {"path", "frames", "fps", "seconds", "foot_skate_cm"}
    assert (motion["path"], motion["frames"], motion["fps"], motion["seconds"]) == (str(out), 60, 30, 2)
    assert motion["foot_skate_cm"] >= 0


def test_the_file_holds_what_the_library_makes(run_json: RunJson, tmp_path: Path) -> None:
    run_json("generate", TEXT, "-o", tmp_path / "wave.bvh", "--seconds", 1, "--seed", 8, *MODELS)
    expected = Runtime(TINY_GENERATORS).generate(TEXT, 1, seed=8, candidates=8)
    np.testing.assert_allclose(load_motion(tmp_path / "wave.bvh").positions(), expected.positions(), atol=2e-3)


def test_several_motions_are_numbered(run_json: RunJson, tmp_path: Path) -> None:
    found = run_json("generate", TEXT, "-o", tmp_path / "a.b.npz", "-n", 3, "--seed", 0, "--seconds", 0.5, *MODELS)
    names = [tmp_path / f"a.b-{number}.npz" for number in (1, 2, 3)]
    assert [motion["path"] for motion in found["motions"]] == list(map(str, names))
    first, *others = (load_motion(path) for path in names)
    assert all(not np.allclose(first.rotations, other.rotations) for other in others)
    assert not (tmp_path / "a.b.npz").exists()


def test_a_seed_that_nobody_gave_is_told_and_makes_the_same_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    models = [str(one) for one in MODELS]
    assert main(["generate", TEXT, "-o", str(tmp_path / "one.npz"), *models]) == 0
    out, err = capsys.readouterr()
    assert out.splitlines()[0].split() == ["seconds", "foot", "skate", "file"]
    assert out.splitlines()[1].endswith("one.npz")
    seed = err.split()[1].rstrip(":")
    assert f"--seed {seed} makes the same again" in err
    assert main(["generate", TEXT, "-o", str(tmp_path / "two.npz"), "--seed", seed, *models]) == 0
    one, two = load_motion(tmp_path / "one.npz"), load_motion(tmp_path / "two.npz")
    np.testing.assert_array_equal(one.rotations, two.rotations)
    assert capsys.readouterr().err == "the best of 8 candidates each; --candidates 1 takes the first\n"


def test_options_reach_the_sampler(run_json: RunJson, tmp_path: Path) -> None:
    def root(*options: object) -> np.ndarray:
        run_json("generate", TEXT, "-o", tmp_path / "o.npz", "--seconds", 1, "--seed", 3, *options, *MODELS)
        return load_motion(tmp_path / "o.npz").positions()

    plain = root()
    for options in (
        ("--guidance", 0.5),
        ("--steps", 2),
        ("--temperature", 0),
        ("--sampler", "vae"),
        ("--no-foot-lock",),
    ):
        assert not np.array_equal(plain, root("--sampler", "diffusion", *options)), options


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([" "], "the text is empty"),
        ([TEXT, "--seconds", "0"], "seconds must be a number from 0.5 to 10, not 0.0"),
        ([TEXT, "--seconds", "10000"], "seconds must be a number from 0.5 to 10, not 10000.0"),
        ([TEXT, "--seconds", "nan"], "seconds must be a number from 0.5 to 10, not nan"),
        ([TEXT, "-n", "0"], "n must be a whole number from 1 to 1000, not 0"),
        ([TEXT, "--temperature", "-1"], "temperature must be a number from 0 to 10, not -1.0"),
        ([TEXT, "--temperature", "1e308"], "temperature must be a number from 0 to 10, not 1e+308"),
        ([TEXT, "--guidance", "1e30"], "guidance must be a number from 0 to 100, not 1e+30"),
        ([TEXT, "-o", "", "-n", "2"], ". is a folder; give a file in it, as in motion.bvh"),
        ([TEXT, "-o", "wave"], "'wave' has no suffix, which would say its kind: name it wave.bvh, for instance"),
        ([TEXT, "-o", "none/wave.bvh"], "cannot write none/wave.bvh: there is no folder none; make it first"),
        ([TEXT, "--sampler", "gan"], "unknown sampler 'gan'; choose one of: motion, diffusion, vae"),
        ([TEXT, "--seed", "-1"], "seed must be a whole number from 0, not -1"),
        ([TEXT, "-o", "motion.xyz"], "motion.xyz: a file '.xyz' cannot be written"),
        ([TEXT, "--models", str(TINY)], "has no model"),
        ([TEXT, "--candidates", "65"], "candidates must be a whole number from 1 to 64, not 65"),
    ],
)
def test_an_error_is_one_line_and_exit_code_one(
    arguments: list[str], message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = ["-o", str(tmp_path / "out.bvh"), *map(str, MODELS), *arguments]
    assert main(["generate", *given]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert message in err
    assert err.count("\n") == 1
    assert not list(tmp_path.iterdir())


def test_neither_text_nor_plan_is_wrong_usage(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["generate", "-o", str(tmp_path / "x.bvh")]) == 2
    assert "give a TEXT, as in 'wave the right hand', or --plan FILE" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("arguments", [[], [TEXT], [TEXT, "-o", "x.bvh", "-n", "many"]])
def test_wrong_usage_is_exit_code_two(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["generate", *arguments]) == 2
    assert "(see 'motionrt generate --help')" in capsys.readouterr().err


@pytest.mark.parametrize(("text", "warned"), [("asdf qwer zxcv", True), ("a person waves", False)])
def test_a_text_without_a_known_word_is_told_to_be_a_guess(
    text: str, warned: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["generate", text, "-o", str(tmp_path / "x.bvh"), *map(str, MODELS)]) == 0
    assert ("this is a guess" in capsys.readouterr().err) is warned
