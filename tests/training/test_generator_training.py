"""Training of the motion generator: mirrored batches, what is held, the losses, and that it learns."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="torch is not installed; the training extra brings it")

from hypothesis import given  # noqa: E402
from hypothesis import strategies as st  # noqa: E402

from motionrt.motion.features import ego77  # noqa: E402
from motionrt.motion.skeleton import SMPL24  # noqa: E402
from motionrt.text import SLOTS, TARGETS, parse_query, slots_of_text  # noqa: E402
from motionrt_training.corpora.views import Views  # noqa: E402
from motionrt_training.generator_holding import draw_holding  # noqa: E402
from motionrt_training.generator_losses import motion_losses  # noqa: E402
from motionrt_training.generator_task import GeneratorSettings, GeneratorTask, SpokenLines  # noqa: E402
from motionrt_training.generator_trial import Trial  # noqa: E402
from motionrt_training.text_cache import TextFeatures  # noqa: E402

LEFT, RIGHT = "wave the left hand", "wave the right hand"
TOLD = GeneratorSettings(
    d=32, layers=1, heads=2, ff=32, batch=16, untold=0.0, said_slots=1.0, sideless=0.0, only_said=1.0, spoken=0.0
)  # fmt: skip
FOOT = ego77.JOINTS.start + 3 * (SMPL24.index("left_foot") - 1)


def strolling(frames: int, left_wrist: float) -> np.ndarray:
    """Somebody (F, 77) who goes straight ahead, the left wrist raised by so many metres."""
    joints = np.repeat((SMPL24.rest_positions - [0, SMPL24.rest_positions[:, 1].min(), 0])[None], frames, axis=0)
    joints[:, SMPL24.index("left_wrist"), 1] += left_wrist
    joints[:, :, 2] += 0.04 * np.arange(frames)[:, None]
    return ego77.encode(joints)


def views(lengths: tuple[int, ...] = (20, 34, 41, 60)) -> Views:
    """Motions that all wave the left hand."""
    rng, count = np.random.default_rng(0), len(lengths)
    motions = [strolling(frames, 0.6) + rng.normal(0, 0.02, (frames, ego77.WIDTH)) for frames in lengths]
    length = np.array(lengths)
    slots = np.repeat(slots_of_text(parse_query(LEFT))[None], count, axis=0)
    return Views(
        np.concatenate(motions).astype(np.float16), np.cumsum(length) - length, length, slots,
        np.zeros((count, len(TARGETS)), np.float32), np.ones((count, len(TARGETS)), bool),
        [[LEFT]] * count, [[]] * count, ["mocap"] * count,
    )  # fmt: skip


def task(settings: GeneratorSettings = TOLD) -> GeneratorTask:
    """Texts have one token each, whose first number is the text's."""
    data = views()
    texts = SpokenLines.of(data)
    tokens = np.zeros((len(texts), 384), np.float16)
    tokens[:, 0] = [{LEFT: 1, RIGHT: 2}[text] for text in texts]
    features = TextFeatures(tokens, np.arange(len(texts)), np.ones(len(texts), np.int64), tokens)
    return GeneratorTask(data, SpokenLines(texts, features), Trial([], [], {}), settings, seed=0)


def losses(found: Any, wanted: Any, frames: Any = None) -> dict[str, float]:
    count, length = wanted.shape[:2]
    there = torch.ones(count, length, dtype=torch.bool) if frames is None else frames
    made = motion_losses(found, wanted, torch.ones(77), torch.zeros(77), there, torch.ones(count))
    return {name: float(value) for name, value in made.items()}


def standing() -> Any:
    row = torch.from_numpy(strolling(30, 0.0))[None].clone()
    row[..., :3] = 0
    return row


def test_a_mirrored_view_has_the_mirrored_text_and_slots() -> None:
    batch = task().batch(0)
    heights = {side: ego77.JOINTS.start + 3 * (SMPL24.index(f"{side}_wrist") - 1) + 1 for side in ("left", "right")}
    left_is_up = batch["motion"][:, 0, heights["left"]] > batch["motion"][:, 0, heights["right"]]
    assert left_is_up.any()
    assert not left_is_up.all()
    for up, token, slots in zip(left_is_up.tolist(), batch["tokens"][:, 0, 0].tolist(), batch["slots"], strict=True):
        text = LEFT if up else RIGHT
        assert token == (1 if up else 2)
        np.testing.assert_array_equal(slots.numpy(), slots_of_text(parse_query(text)))
    assert (slots_of_text(parse_query(LEFT)) != slots_of_text(parse_query(RIGHT))).any()


def test_a_step_gives_the_same_batch_again_and_the_next_another() -> None:
    first, again, other = task().batch(3), task().batch(3), task().batch(4)
    assert all(torch.equal(first[name], again[name]) for name in first)
    assert not torch.equal(first["noise"], other["noise"][: len(first["noise"])])


def test_a_batch_is_whole_patches_long_and_holds_nothing_beyond_the_frames_of_a_view() -> None:
    batch = task(dataclasses.replace(TOLD, held=1.0)).batch(1)
    assert batch["motion"].shape[1] % TOLD.patch == 0
    beyond = ~batch["frames"]
    assert not batch["holding"][beyond].any()
    assert not batch["motion"][beyond].any()
    assert batch["holding"].any()


def test_untold_views_are_told_nothing() -> None:
    batch = task(dataclasses.replace(TOLD, untold=1.0, numbers=1.0)).batch(0)
    assert not any(batch[name].any() for name in ("text", "slots", "known"))
    told = task(dataclasses.replace(TOLD, numbers=1.0)).batch(0)
    assert all(told[name].any() for name in ("text", "slots", "known"))
    assert told["slots"].shape[1] == len(SLOTS)


@given(st.integers(1, 200), st.integers(0, 10_000))
def test_what_is_held_is_a_mask_of_the_frames_and_parts(frames: int, seed: int) -> None:
    held = draw_holding(frames, np.random.default_rng(seed))
    assert (held.shape, held.dtype) == ((frames, 6), np.dtype(bool))


def test_every_kind_of_holding_is_drawn() -> None:
    drawn = [draw_holding(40, np.random.default_rng(seed)) for seed in range(200)]
    start = [held[0].all() and not held[20:].any() for held in drawn]
    ends = [held[0].all() and held[-1].all() and not held[20:36].any() for held in drawn]
    path = [held[:, -1].all() and not held[:, :-1].any() for held in drawn]
    assert min(map(sum, (start, ends, path))) > 0


def test_a_perfect_answer_has_no_loss() -> None:
    motion = torch.from_numpy(np.stack([strolling(30, 0.0), strolling(30, 0.5)]))
    assert losses(motion, motion) == pytest.approx(dict.fromkeys(("loss", "features", "speed", "way", "feet"), 0.0))


def test_frames_that_are_not_there_have_no_loss() -> None:
    motion = standing()
    there = torch.arange(30)[None] < 20
    wrong = motion.clone()
    wrong[:, 20:] += 1.0
    assert losses(wrong, motion, there)["loss"] == pytest.approx(0.0)
    assert losses(wrong, motion)["loss"] > 0.1


def test_the_farther_a_standing_foot_slips_the_larger_the_loss_of_feet() -> None:
    motion, found = standing(), []
    for slip in (0.0, 0.01, 0.02, 0.04):
        slipping = motion.clone()
        slipping[0, :, FOOT] += slip * torch.arange(30)
        found.append(losses(slipping, motion)["feet"])
    assert np.all(np.diff(found) > 0)
    # Speeds and their squares: twice as far is four times the loss.
    assert found[2] / found[1] == pytest.approx(4.0, rel=1e-3)


def test_a_foot_that_stays_on_a_body_that_moves_slips_not() -> None:
    moving = standing()
    moving[..., 2] = 0.03
    for joint in ego77.FEET:
        moving[0, :, ego77.JOINTS.start + 3 * (joint - 1) + 2] -= 0.03 * torch.arange(30)
    assert losses(moving, standing())["feet"] == pytest.approx(0.0, abs=1e-6)
    assert losses(moving, standing())["way"] > 0.01


def test_a_few_steps_lower_the_loss() -> None:
    learner = task()
    optimiser = torch.optim.AdamW(learner.model.parameters(), lr=3e-3)
    before, *_, after = [_step(learner, optimiser, step % 4) for step in range(25)]  # the last batch is the first
    assert after < 0.8 * before


def _step(learner: GeneratorTask, optimiser: Any, step: int) -> float:
    torch.manual_seed(step)
    optimiser.zero_grad()
    loss = learner.losses(learner.model, learner.batch(step))["loss"]
    loss.backward()
    optimiser.step()
    return float(loss.detach())
