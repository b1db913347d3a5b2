"""TEMOS: its networks, and the task that trains them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import torch
from motions import random_motion, walking

from motionrt.formats.motion_pack import MotionPack
from motionrt.motion import transforms
from motionrt.motion.features import sinc135
from motionrt_training.corpora.actions import Action, ActionClip, read_actions
from motionrt_training.corpora.recordings import Recordings
from motionrt_training.networks.egocentric import to_egocentric
from motionrt_training.networks.temos import Temos
from motionrt_training.networks.transformer import ResidualLayer, key_bias
from motionrt_training.temos_data import ActionData, SpokenTexts
from motionrt_training.temos_task import TemosSettings, TemosTask, ground_velocity
from motionrt_training.trainer import Schedule, Trainer

SMALL = {"d": 32, "layers": 2, "heads": 2, "ff": 32, "dropout": 0.0}


def raw(motion: object) -> torch.Tensor:
    return torch.from_numpy(sinc135.encode(motion))[None]  # type: ignore[arg-type]


@pytest.fixture
def net() -> Temos:
    torch.manual_seed(0)
    model = Temos(**SMALL).eval()
    for parameter in model.parameters():  # branches begin at zero: wake them
        torch.nn.init.normal_(parameter, std=0.05)
    return model


def test_residual_layers_begin_as_the_identity() -> None:
    x, mask = torch.randn(2, 5, 32), torch.ones(2, 5, dtype=torch.bool)
    layer = ResidualLayer(32, 4, 64, latent=True).eval()
    assert torch.equal(layer(x, key_bias(mask), torch.randn(2, 32)), x)


def test_what_is_padded_changes_nothing(net: Temos) -> None:
    motion, other = raw(walking(50, 30.0)), raw(random_motion(90, 30.0))
    padded = torch.cat((torch.nn.functional.pad(motion, (0, 0, 0, 40), value=3.0), other))
    mask = torch.arange(90) < torch.tensor([[50], [90]])
    alone = net.encode_motion(motion, mask[:1, :50])
    together = net.encode_motion(padded, mask)
    assert torch.allclose(alone.mu[0], together.mu[0], atol=1e-5)
    latent = torch.randn(2, 32)
    long, short = net.decode(latent, mask), net.decode(latent[:1], mask[:1, :50])
    assert torch.allclose(long[:1, :50], short, atol=1e-5)
    assert (long[0, 50:] == 0).all()


def test_a_motion_has_the_same_latent_wherever_it_is_done(net: Temos) -> None:
    motion = random_motion(60, 30.0, seed=2)
    elsewhere = transforms.moved(transforms.turned(motion, 1.1), np.array([3.0, 0.0, -2.0]))
    mask = torch.ones(1, 60, dtype=torch.bool)
    assert torch.allclose(
        net.encode_motion(raw(motion), mask).mu, net.encode_motion(raw(elsewhere), mask).mu, atol=1e-4
    )


def test_decoded_motions_begin_above_the_origin_and_face_z(net: Temos) -> None:
    found = net.decode(torch.randn(3, 32), torch.ones(3, 40, dtype=torch.bool))
    assert found.shape == (3, 40, 135)
    assert torch.allclose(found[:, 0, 132:134], torch.zeros(3, 2))


def test_ground_velocity_is_that_of_the_joints_in_the_world() -> None:
    motion = walking(30, 30.0, turn=0.8)
    frames = to_egocentric(raw(motion))
    local = motion.positions() - motion.root[:, None] * [1, 0, 1]
    yaw = 0.8 * np.arange(30) / 30.0
    turn = np.stack(
        [[np.cos(yaw), 0 * yaw, -np.sin(yaw)], [0 * yaw, 0 * yaw + 1, 0 * yaw], [np.sin(yaw), 0 * yaw, np.cos(yaw)]]
    )
    seen = np.einsum("ijf,fkj->fki", turn, local)  # into the frame of the body
    velocity = np.einsum("ijf,fkj->fki", turn[..., :-1], np.diff(motion.positions(), axis=0)) * 30.0
    found = ground_velocity(frames, torch.from_numpy(seen[None]).float())[0]
    np.testing.assert_allclose(found.numpy(), velocity, atol=2e-3)


class Letters:
    """A backbone of nothing: one token per letter."""

    fingerprint = "letters"

    def encode(self, text: str) -> tuple[np.ndarray, np.ndarray]:
        tokens = np.zeros((len(text), 384), np.float32)
        tokens[np.arange(len(text)), [ord(letter) % 384 for letter in text]] = 1.0
        return tokens, tokens.mean(0)


def task(seed: int = 1) -> TemosTask:
    actions = Action("walk", frozenset({"global"})), Action("wave", frozenset({"left arm"}))
    clips = [
        ActionClip(
            f"{split}{number}", split, to_egocentric(raw(walking(70, 30.0, turn=0.3 * number)))[0], actions, ("a",)
        )
        for number in range(3)
        for split in ("train", "val")
    ]
    data = ActionData(least_frames=40, most_frames=60)
    settings = TemosSettings(**{**SMALL, "batch": 4})  # type: ignore[arg-type]
    return TemosTask(clips, SpokenTexts(Letters()), settings, data, seed)


def test_a_step_sees_the_same_batch_again() -> None:
    first, again, other = task().batch(7), task().batch(7), task().batch(8)
    assert all(torch.equal(first[name], again[name]) for name in first)
    assert first["frames"].shape != other["frames"].shape or not torch.equal(first["frames"], other["frames"])


def test_training_brings_the_loss_down(tmp_path: Path) -> None:
    schedule = Schedule(steps=90, lr=3e-3, warmup=1, validate_every=90, log_every=4, device="cpu", bf16=False)
    measures = Trainer(task(), schedule, tmp_path).run()
    rows = [json.loads(line) for line in (tmp_path / "log.jsonl").read_text(encoding="utf-8").splitlines()]
    losses = [row["loss"] for row in rows if "loss" in row]
    assert losses[-1] < 0.95 * losses[0]
    assert np.isfinite(list(measures.values())).all()
    assert 0.0 <= measures["temos"] <= 1.0


def test_clips_are_cut_as_their_captions_say(tmp_path: Path) -> None:
    motion = walking(90, 30.0)
    row = {"id": "x_0", "trial": "x", "start_s": 1.0, "end_s": 2.5, "split": "train", "captions": ["he walks"]}
    row["labels"] = [{"text": "walk", "parts": ["left leg", "right leg", "global"]}]
    path = tmp_path / "captions.jsonl"
    path.write_text(json.dumps(row) + "\n", encoding="utf-8")
    (clip,) = read_actions(Recordings(MotionPack.of([motion]), ("x",), ("train",)), path)
    assert clip.frames.shape == (45, 136)
    assert clip.actions == (Action("walk", frozenset({"left leg", "right leg", "global"})),)
