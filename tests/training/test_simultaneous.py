"""Sentences of two actions, synthetic pairs, and the examples that training draws."""

from __future__ import annotations

import numpy as np
import pytest
import torch
from motions import random_motion, walking

from motionrt.motion.features import sinc135
from motionrt.synthesis.composing import combination
from motionrt_training.corpora.actions import Action, ActionClip
from motionrt_training.networks.egocentric import from_egocentric, mirrored, to_egocentric
from motionrt_training.networks.temos import Temos
from motionrt_training.simultaneous import combined, random_combination
from motionrt_training.temos_data import ActionData, Examples, crop, prolonged, separated
from motionrt_training.wording.pairs import gerund, sentence

PLAIN = ActionData(captions=0.0, synthetic=0.0, mirror=False, tempo=0.0)


def frames(motion: object) -> torch.Tensor:
    return to_egocentric(torch.from_numpy(sinc135.encode(motion))[None])[0]  # type: ignore[arg-type]


def clip(name: str, seed: int, *actions: Action, length: int = 60) -> ActionClip:
    return ActionClip(name, "train", frames(random_motion(length, 30.0, seed)), actions, (f"caption of {name}",))


WALK = Action("walk forward", frozenset({"left leg", "right leg", "global"}))
WAVE = Action("wave the left hand", frozenset({"left arm"}))
KICK = Action("kick", frozenset({"right leg"}))


@pytest.mark.parametrize(
    ("label", "expected"),
    [
        ("walk forward", "walking forward"),
        ("run and stop quickly", "running and stopping quickly"),
        ("lie down", "lying down"),
        ("left arm up", "left arm up"),
        ("raise the right hand", "raising the right hand"),
    ],
)
def test_labels_become_gerunds(label: str, expected: str) -> None:
    assert gerund(label) == expected


def test_every_sentence_says_both_actions_in_both_orders() -> None:
    rng = np.random.default_rng(0)
    said = {sentence("walk", "wave", rng) for _ in range(400)}
    assert all(("walk" in text and ("wave" in text or "waving" in text)) for text in said)
    assert {"walk while waving", "wave while walking", "walk and wave", "wave, walk"} <= said
    assert not any("{" in text for text in said)


def test_combining_frames_is_combining_features_seen_by_the_character() -> None:
    a, b = (raw_start(random_motion(30, 30.0, seed)) for seed in (1, 2))
    parts = combination(WALK.parts, WAVE.parts)
    expected = parts.apply_features(a[0].numpy(), b[0].numpy())
    found = from_egocentric(combined(to_egocentric(a)[0], to_egocentric(b)[0], parts)[None])[0]
    np.testing.assert_allclose(found.numpy(), expected, atol=1e-5)


def raw_start(motion: object) -> torch.Tensor:
    """Features from the origin on."""
    return from_egocentric(to_egocentric(torch.from_numpy(sinc135.encode(motion))[None]))  # type: ignore[arg-type]


def test_a_pair_takes_the_legs_of_the_walk_and_the_arm_of_the_wave() -> None:
    walk, wave = frames(walking(40, 30.0)), frames(random_motion(50, 30.0, seed=4))
    found = combined(walk, wave, combination(WALK.parts, WAVE.parts))
    arm = slice(10 + 6 * 12, 10 + 6 * 13)  # left collar, joint 13
    assert len(found) == 40
    assert torch.equal(found[:, :16], walk[:, :16])
    assert torch.equal(found[:, arm], wave[:40, arm])


def test_random_parts_mix_both_motions() -> None:
    rng = np.random.default_rng(0)
    for _ in range(50):
        assert set(np.unique(random_combination(rng).joints)) <= {0, 1}
    assert any(0 < random_combination(rng).joints.sum() < 24 for _ in range(20))


def test_synthetic_pairs_are_of_compatible_labels() -> None:
    examples = Examples(
        [clip("a", 1, WALK), clip("b", 2, WAVE), clip("c", 3, KICK)], ActionData(synthetic=1.0, mirror=False)
    )
    rng = np.random.default_rng(0)
    for _ in range(30):
        (text,) = examples.draw(rng).texts
        assert not ("walk" in text and "kick" in text)
        assert "wav" in text


def test_single_actions_are_said_alone_and_pairs_at_once() -> None:
    clips = [clip("a", 1, WALK, WAVE)]
    rng = np.random.default_rng(0)
    alone = Examples(clips, ActionData(captions=0.0, synthetic=0.0, pairs=False, mirror=False))
    assert {alone.draw(rng).texts for _ in range(20)} == {("walk forward",), ("wave the left hand",)}
    both = Examples(clips, PLAIN)
    assert all("walk" in text and "wav" in text for (text,) in (both.draw(rng).texts for _ in range(20)))


def test_the_part_of_real_pairs_is_kept() -> None:
    clips = [clip(str(number), number, WALK, WAVE, length=20) for number in range(40)]
    none = Examples(clips, ActionData(captions=0.0, synthetic=0.0, real=0.0, mirror=False))
    half = Examples(clips, ActionData(captions=0.0, synthetic=0.0, real=0.5, mirror=False))
    rng = np.random.default_rng(0)
    assert all(len(none.draw(rng).texts[0].split()) < 5 for _ in range(30))
    paired = [("walk" in text and "wav" in text) for (text,) in (half.draw(rng).texts for _ in range(400))]
    assert 0.4 < np.mean(paired) < 0.6


def test_separate_encoding_gives_two_texts() -> None:
    examples = Examples(
        [clip("a", 1, WALK, WAVE)], ActionData(captions=0.0, synthetic=0.0, separate=True, mirror=False)
    )
    assert sorted(examples.draw(np.random.default_rng(0)).texts) == ["walk forward", "wave the left hand"]


def test_mirrored_examples_swap_sides_in_motion_and_text() -> None:
    examples = Examples([clip("a", 1, WAVE)], ActionData(captions=0.0, synthetic=0.0, tempo=0.0, least_frames=60))
    rng = np.random.default_rng(0)
    seen = {example.texts[0]: example.frames for example in (examples.draw(rng) for _ in range(20))}
    assert set(seen) == {"wave the left hand", "wave the right hand"}
    assert torch.allclose(mirrored(seen["wave the left hand"]), seen["wave the right hand"], atol=1e-5)


def test_a_faster_crop_moves_more_per_frame() -> None:
    walk = frames(walking(90, 30.0, speed=1.0))
    found = crop(walk, np.random.default_rng(3), 40, tempo=0.5)
    speed = found[:-1, 1:3].norm(dim=1)
    assert len(found) == 40
    assert speed.std() < 1e-3
    assert 1.0 / 1.5 - 1e-3 <= float(speed[0]) * 30.0 <= 1.5 + 1e-3


def test_a_short_walk_is_repeated_without_a_jump() -> None:
    walk = frames(walking(50, 30.0, speed=1.0))  # a stride takes 30 frames
    found = prolonged(walk, 140)
    assert len(found) == 140
    assert torch.equal(found[:49], walk[:49])
    assert found[:, 1:3].norm(dim=1).numpy() * 30.0 == pytest.approx(1.0, abs=1e-3)
    change = found[1:, 3:] - found[:-1, 3:]
    assert float(change.abs().max()) < 1.2 * float((walk[1:, 3:] - walk[:-1, 3:]).abs().max())


def test_what_never_comes_back_to_an_earlier_pose_ends_where_it_ends() -> None:
    fall = frames(walking(60, 30.0))
    fall[:, 3] = torch.linspace(12.0, 0.0, 60)  # always lower: never nearer than 2 m to where it was
    assert torch.equal(prolonged(fall, 140), fall)
    long = frames(walking(160, 30.0))
    assert torch.equal(prolonged(long, 140), long)


def test_synthetic_pairs_replace_real_singles_alone_unless_all_are_to_be() -> None:

    walk, wave = Action("walk", frozenset({"left leg"})), Action("wave", frozenset({"right arm"}))
    frames = torch.zeros(80, 136)
    clips = [
        ActionClip("single", "train", frames, (walk,), ("somebody walks",)),
        ActionClip("other", "train", frames, (wave,), ("somebody waves",)),
        ActionClip("pair", "train", frames, (walk, wave), ("somebody walks and waves",)),
    ]

    def texts(**options: object) -> set[str]:
        data = ActionData(captions=0.0, synthetic=1.0, mirror=False, **options)
        made, rng = Examples(clips, data), np.random.default_rng(1)
        made._synthetic = lambda *_: (frames, ("synthetic",))
        return {kind(made.draw(rng).texts[0]) for _ in range(60)}

    def kind(text: str) -> str:
        both = "wav" in text and "walk" in text
        return "synthetic" if text == "synthetic" else "real pair" if both else "single"

    assert texts() == {"synthetic", "real pair"}
    assert texts(replaces="all") == {"synthetic"}
    assert texts(pairs=False) == {"synthetic"}


def test_a_separation_token_stands_between_texts_and_is_learnt() -> None:

    parts = [np.ones((2, 384), np.float32), np.full((3, 384), 2.0, np.float32)]
    rows = separated(parts)
    assert rows[:, 0].tolist() == [1, 1, 0, 2, 2, 2]
    torch.manual_seed(0)
    model = Temos(layers=1, ff=32, dropout=0.0, separation=True)
    tokens, mask = torch.from_numpy(rows)[None], torch.ones(1, 6, dtype=torch.bool)
    model.encode_text(tokens, mask).mu.sum().backward()
    assert model.separator.grad is not None
    assert float(model.separator.grad.abs().max()) > 0
    assert Temos(**model.config).config == model.config
    assert "separation" not in Temos(layers=1, ff=32).config
