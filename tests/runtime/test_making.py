"""The verbs that make motion: what goes in and comes out of generate, compose and body_parts."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from motions import random_motion, standing, walking
from scipy.spatial.transform import Rotation
from tiny_models import TINY, TINY_GENERATORS

from motionrt import PARTS, Layer, Motion, Runtime, load_motion
from motionrt.errors import FormatError, InvalidInputError, ModelNotFoundError, MotionFileNotFoundError
from motionrt.motion.body_parts import PART_JOINTS

WALK, WAVE = "a person walks in a circle", "wave the right hand"
LABELS = {WALK: {"left leg", "right leg", "global"}, WAVE: {"right arm"}, "nod": {"torso"}}


@pytest.fixture(scope="module")
def runtime() -> Runtime:
    return Runtime(TINY_GENERATORS, threads=1)


def assert_same(one: Motion, other: Motion) -> None:
    assert one.fps == other.fps
    np.testing.assert_array_equal(one.rotations, other.rotations)
    np.testing.assert_array_equal(one.root, other.root)


def label(text: str) -> frozenset[str]:
    return frozenset(LABELS[text])


def test_a_text_gives_a_motion_and_a_number_gives_a_list(runtime: Runtime) -> None:
    one = runtime.generate(WALK, 2, seed=1)
    assert isinstance(one, Motion)
    assert (one.frames, one.fps) == (60, 30.0)
    single, several = runtime.generate(WALK, 2, seed=1, n=1), runtime.generate(WALK, 2, seed=1, n=3)
    assert [len(single), len(several)] == [1, 3]
    assert_same(single[0], one)
    assert_same(several[0], one)


def test_a_list_of_texts_gives_a_list_of_answers(runtime: Runtime) -> None:
    walk, wave = runtime.generate([WALK, WAVE], 1, seed=4)
    assert_same(walk, runtime.generate(WALK, 1, seed=4))
    assert_same(wave, runtime.generate(WAVE, 1, seed=4))
    nested = runtime.generate([WALK, WAVE], 1, seed=4, n=2)
    assert [len(motions) for motions in nested] == [2, 2]
    assert_same(nested[1][0], wave)


def test_by_default_four_seconds_and_another_motion_every_time(runtime: Runtime) -> None:
    first, second = runtime.generate(WALK), runtime.generate(WALK)
    assert first.frames == second.frames == 120
    assert not np.allclose(first.rotations, second.rotations)


def test_without_temperature_there_is_one_motion(runtime: Runtime) -> None:
    for sampler in ("vae", "diffusion", "motion"):
        first, second = runtime.generate(WALK, 1, n=2, temperature=0, sampler=sampler)
        assert_same(first, second)
        assert_same(runtime.generate(WALK, 1, seed=99, temperature=0, sampler=sampler), first)


def test_the_sentence_encoder_is_opened_once_for_searching_and_generating(runtime: Runtime) -> None:
    assert runtime.generator.sentences is runtime.model.sentences
    assert runtime.generator.temos.sessions is runtime.model.sessions


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"text": "  "}, "the text is empty"),
        ({"text": []}, "at least one text"),
        ({"text": [WALK, 3]}, "a text must be a str, not int"),
        ({"seconds": 0}, "seconds must be a number from 0.5 to 10, not 0"),
        ({"seconds": 10_000}, "seconds must be a number from 0.5 to 10, not 10000"),
        ({"seconds": float("nan")}, "seconds must be a number from 0.5 to 10, not nan"),
        ({"n": 0}, "n must be a whole number from 1 to 1000, not 0"),
        ({"temperature": -1}, "temperature must be a number from 0 to 10, not -1"),
        ({"sampler": "gan"}, "unknown sampler 'gan'"),
        ({"seed": -3}, "seed must be a whole number from 0"),
    ],
)
def test_bad_wishes_are_refused(runtime: Runtime, options: dict[str, Any], message: str) -> None:
    with pytest.raises(InvalidInputError, match=message):
        runtime.generate(**{"text": WALK, **options})


def test_models_that_cannot_generate_say_so() -> None:
    with pytest.raises(ModelNotFoundError, match="no model 'temos_text'; it has: tmr_decoder"):
        Runtime(TINY).generate(WALK, sampler="diffusion")


def test_the_arm_of_one_motion_on_the_body_of_another(runtime: Runtime) -> None:
    body, arm = walking(90, 30.0), random_motion(60, 30.0)
    found = runtime.compose([body, arm], [None, "right arm"], seam=0)
    covered = np.isin(np.arange(24), PART_JOINTS["right arm"])
    assert found.frames == 60
    np.testing.assert_array_equal(found.rotations[:, covered], arm.rotations[:, covered])
    np.testing.assert_array_equal(found.rotations[:, ~covered], body.rotations[:60, ~covered])
    np.testing.assert_array_equal(found.root, body.root[:60])


def test_masks_move_joints_and_no_more(runtime: Runtime) -> None:
    body, other = walking(60, 30.0), random_motion(60, 30.0)
    found = runtime.compose([body, other], masks=[None, ["left leg", "head"]], seam=0)
    covered = np.isin(np.arange(24), [*PART_JOINTS["left leg"], 15])
    np.testing.assert_array_equal(found.rotations[:, covered], other.rotations[:, covered])
    np.testing.assert_array_equal(found.rotations[:, ~covered], body.rotations[:, ~covered])


def test_texts_are_generated_labelled_and_composed(runtime: Runtime) -> None:
    found = runtime.compose([WALK, WAVE], seed=5, seconds=2, labeller=label)
    motions = runtime.generate([WALK, WAVE], 2, seed=5)
    by_hand = runtime.compose(motions, [LABELS[WALK], LABELS[WAVE]])
    assert found.frames == 60
    assert_same(found, by_hand)


def test_parts_given_go_before_those_of_the_text(runtime: Runtime) -> None:
    layers = runtime.layers([WALK, WAVE, "nod"], [None, "left arm", None], seed=0, seconds=1, labeller=label)
    assert [layer.parts for layer in layers] == [LABELS[WALK], {"left arm"}, {"torso"}]


def test_three_layers_each_move_their_part(runtime: Runtime) -> None:
    walk, arm, nod = walking(40, 30.0), random_motion(40, 30.0, seed=1), random_motion(40, 30.0, seed=2)
    found = runtime.compose([walk, arm, nod], [None, "right arm", "torso"], seam=0)
    for motion, part in ((walk, "left leg"), (arm, "right arm"), (nod, "torso")):
        joints = list(PART_JOINTS[part])
        np.testing.assert_array_equal(found.rotations[:, joints], motion.rotations[:, joints])


def test_files_motions_and_texts_mix(runtime: Runtime, tmp_path: Path) -> None:
    file = walking(90, 30.0).save(tmp_path / "walk cycle.bvh")
    for given in (file, str(file)):
        found = runtime.compose([given, WAVE], [None, "right arm"], seed=0)
        assert found.frames == 90
        np.testing.assert_allclose(found.root, load_motion(file).root, atol=1e-6)


def test_a_text_lasts_as_long_as_the_motion_that_it_is_laid_on(runtime: Runtime) -> None:
    layers = runtime.layers([walking(45, 30.0), WAVE, standing(1, 30.0)], [None, "right arm", "torso"], seed=0)
    assert [layer.motion.frames for layer in layers] == [45, 45, 1]
    assert runtime.layers([WALK, WAVE], ["global", "right arm"], seed=0)[1].motion.frames == 120
    long = runtime.layers([walking(900, 30.0), WAVE], [None, "right arm"], seed=0)
    assert long[1].motion.frames == 240  # as much as the model can; composing loops it
    assert runtime.compose(long, seconds=20).frames == 600


def test_layers_stay_as_they_are(runtime: Runtime) -> None:
    half = Layer(random_motion(30, 30.0), mask="right_elbow", weight=0.5)
    layers = runtime.layers([walking(30, 30.0), half])
    assert layers[0].parts == frozenset(PARTS)
    assert (layers[1].mask, layers[1].weight) == (("right_elbow",), 0.5)
    with pytest.raises(InvalidInputError, match="a Layer says itself"):
        runtime.layers([walking(30, 30.0), half], [None, "torso"])


def test_joint_texts_are_one_sentence(runtime: Runtime) -> None:
    assert_same(
        runtime.compose(["walk in a circle.", WAVE], seed=2, joint=True),
        runtime.generate("walk in a circle and wave the right hand", seed=2),
    )
    assert_same(
        runtime.compose(["walk", "nod", WAVE], seconds=2, seed=2, joint=True),
        runtime.generate("walk, nod and wave the right hand", 2, seed=2),
    )


@pytest.mark.parametrize(
    ("given", "options", "message"),
    [
        ([WALK], {}, "two or more motions, files or texts"),
        (WALK, {}, "two or more motions, files or texts"),
        ([WALK, 3], {}, "a layer is a Motion, a motion file, a text or a Layer, not 3"),
        ([WALK, ""], {"labeller": label}, "the text is empty"),
        ([WALK, WAVE], {"parts": ["global"]}, "one entry for each of the 2 layers"),
        ([WALK, WAVE], {"parts": "torso"}, "one entry for each of the 2 layers"),
        ([WALK, WAVE], {"parts": [None, "tail"], "labeller": label}, "unknown body part 'tail'; the parts are: left"),
        ([WALK, WAVE], {"parts": [None, "torso"], "masks": [None, "head"], "labeller": label}, "not both"),
        ([WALK, WAVE], {"seconds": float("nan")}, "seconds must be a number"),
        ([WALK, WAVE], {"seconds": "long"}, "seconds must be a number"),
        ([WALK, WAVE], {"seconds": 10_000, "labeller": label}, "seconds must be"),
        ([WALK, WAVE], {"joint": True, "parts": [None, "torso"]}, "nothing that parts or masks could split"),
        ([WALK, walking(30, 30.0)], {"joint": True}, "joint=True is for texts alone"),
    ],
)
def test_bad_compositions_are_refused(runtime: Runtime, given: Any, options: dict[str, Any], message: str) -> None:
    with pytest.raises(InvalidInputError, match=message):
        runtime.compose(given, **options)


@pytest.mark.parametrize("name", ["nothing.bvh", "my walks/slow walk.BVH", "c:\\clips\\wave.npz"])
def test_what_is_named_like_a_file_is_no_text(runtime: Runtime, name: str) -> None:
    with pytest.raises(MotionFileNotFoundError):
        runtime.compose([name, WAVE], ["global", "right arm"])


def test_files_that_cannot_be_read_are_no_texts_either(runtime: Runtime, tmp_path: Path) -> None:
    with pytest.raises((InvalidInputError, MotionFileNotFoundError), match=r"run\.fbx"):
        runtime.compose(["run.fbx", WAVE], ["global", "right arm"])
    (tmp_path / "notes.txt").write_text("hello", encoding="utf-8")
    with pytest.raises(InvalidInputError, match="cannot be read"):
        runtime.compose([str(tmp_path / "notes.txt"), WAVE], ["global", "right arm"])


def test_a_text_stays_a_text_beside_a_file_of_that_name(
    runtime: Runtime, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "walk").write_text("a script of mine", encoding="utf-8")
    found = runtime.compose(["walk", "nod. then wave."], ["global", "torso"], seed=0, seconds=1)
    assert_same(found, runtime.compose(runtime.generate(["walk", "nod. then wave."], 1, seed=0), ["global", "torso"]))


def test_motions_left_open_are_asked_what_moves_in_them(runtime: Runtime) -> None:
    still = standing(60, 30.0)
    rotations = still.rotations.copy()
    angle = np.sin(np.arange(60) / 5)
    rotations[:, 17] = Rotation.from_euler("z", angle[:, None]).as_matrix()  # the right shoulder
    arm = Motion(rotations.astype(np.float32), still.root, 30.0)
    layers = runtime.layers([walking(60, 30.0), arm, random_motion(60, 30.0)], [None, None, "torso"])
    assert {"left leg", "right leg", "global"} <= set(layers[0].parts or ())
    assert layers[1].parts == {"right arm"}


def test_body_parts_are_names_of_parts(runtime: Runtime) -> None:
    found = runtime.body_parts(WAVE)
    assert isinstance(found, frozenset)
    assert "right arm" in found
    assert found <= set(PARTS)
    assert runtime.body_parts("nod", labeller=label) == {"torso"}
    with pytest.raises(InvalidInputError):
        runtime.body_parts(" ")


@pytest.mark.parametrize("given", [None, 5, iter([WALK, WAVE])])
def test_what_is_no_list_is_refused(runtime: Runtime, given: Any) -> None:
    with pytest.raises(InvalidInputError, match="needs a list"):
        runtime.compose(given)


@pytest.mark.parametrize("wrong", [{"parts": 5}, {"parts": {0: "torso", 1: None}}, {"masks": 5}])
def test_parts_that_are_no_list_are_refused(runtime: Runtime, wrong: dict[str, Any]) -> None:
    with pytest.raises(InvalidInputError, match="as a list with one entry for each"):
        runtime.compose([standing(9), standing(9)], **wrong)


def test_a_number_is_no_text(runtime: Runtime) -> None:
    with pytest.raises(InvalidInputError, match="list of texts"):
        runtime.generate(5)  # type: ignore[call-overload]


def test_a_folder_named_by_its_path_is_no_text(runtime: Runtime, tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="is a folder"):
        runtime.compose([str(tmp_path), standing(9)], ["torso", None])


def test_marks_alone_are_no_text_for_a_joint_sentence(runtime: Runtime) -> None:
    with pytest.raises(InvalidInputError, match="text is empty"):
        runtime.compose(["...", WAVE], joint=True)
