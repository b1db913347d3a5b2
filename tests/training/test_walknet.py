"""WalkNet: its frames of reference, its task, and the pool of walks that it is trained on."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch
from gaits import gait
from scipy.spatial.transform import Rotation

from motionrt.motion import SMPL24, Motion
from motionrt.motion.features import ccf219
from motionrt_training.checkpoint import load_any, save_release
from motionrt_training.corpora.bend import bent, smoothed, wave
from motionrt_training.corpora.walks import RUNS, WALKS, Variants, goal_headings, locomotion_parts, resped, variants
from motionrt_training.networks.legs import feet
from motionrt_training.networks.walknet import FRAMES, WalkNet, from_body, goal_features, seen_from, to_body
from motionrt_training.walk_pool import pool_of, speeds_ahead
from motionrt_training.walk_task import WalkSettings, WalkTask, orthonormal

SMALL = {"d": 32, "layers": 1, "heads": 2, "ff": 32, "patch": 5}


def random_frames(batch: int = 3, seed: int = 0) -> torch.Tensor:
    rng = np.random.default_rng(seed)
    turns = Rotation.random(batch * FRAMES * 24, random_state=seed).as_matrix().reshape(batch, FRAMES, 216)
    return torch.from_numpy(np.concatenate([turns, rng.normal(size=(batch, FRAMES, 3))], axis=2)).float()


@pytest.fixture(scope="module")
def walk() -> Motion:
    return gait(seconds=6.0, speed=0.8)[0]


def test_frames_seen_from_the_body_come_back_as_they_were() -> None:
    frames = random_frames()
    local, turn, place = to_body(frames)
    assert torch.allclose(from_body(local, turn, place), frames, atol=1e-5)


def test_the_last_frame_stands_at_the_origin_and_faces_z() -> None:
    local, _, _ = to_body(random_frames())
    pelvis = local[:, -1, :9].unflatten(1, (3, 3))
    assert torch.allclose(local[:, -1, [216, 218]], torch.zeros(3, 2), atol=1e-6)
    assert torch.allclose(pelvis[:, 0, 2], torch.zeros(3), atol=1e-6)
    assert (pelvis[:, 2, 2] > 0).all()


def test_the_goal_is_told_to_the_left_and_ahead() -> None:
    turn, place = torch.tensor([[1.0, 0.0]]), torch.tensor([[0.0, 0.0, -2.0]])  # faces +Z, two metres before it
    left, ahead, *scales, cos, sin = goal_features(turn, place)[0].tolist()
    assert left == pytest.approx(0.0, abs=1e-6)
    assert ahead == pytest.approx(2.0 / 2.25, abs=1e-4)
    assert scales == pytest.approx([2.0 / 2.3, 2.0 / 3.0, 2.0 / 5.0], abs=1e-4)
    assert (cos, sin) == (1.0, 0.0)


def test_prediction_turns_with_the_world() -> None:
    """The same history and goal, both turned by some angle about the goal: the same walk, turned."""
    torch.manual_seed(0)
    net = WalkNet(**SMALL).eval()
    torch.nn.init.normal_(net.body.out.weight, std=0.05)
    frames, angle = random_frames(), 0.7
    turn = torch.tensor([[np.cos(angle), np.sin(angle)]], dtype=torch.float32).expand(3, 2)
    zero = torch.zeros(3, 3)
    local, heading, place = to_body(frames)
    other = to_body(seen_from(frames, turn, zero))
    assert torch.allclose(local, other[0], atol=1e-5)
    assert torch.allclose(place.norm(dim=1), other[2].norm(dim=1), atol=1e-5)
    assert not torch.allclose(heading, other[1], atol=1e-2)


def test_columns_that_never_change_stay_at_their_mean() -> None:
    torch.manual_seed(0)
    net = WalkNet(**SMALL).eval()
    torch.nn.init.normal_(net.body.out.weight, std=0.05)
    net.still[30] = 1.0
    net.pose_mean[30] = 0.25
    made = net(random_frames(), torch.ones(3))
    assert torch.allclose(made[:, :, 30], torch.full((3, FRAMES), 0.25))
    assert (made[:, :, 31] - made[:, :1, 31]).abs().max() > 1e-6


def test_an_untrained_network_stays_where_it_is() -> None:
    frames = random_frames()
    made = WalkNet(**SMALL).eval()(frames, torch.ones(3))
    assert torch.allclose(made, frames[:, -1:].expand_as(made), atol=1e-5)


def test_feet_are_those_of_forward_kinematics(walk: Motion) -> None:
    points = feet(torch.from_numpy(ccf219.encode(walk))[None])[0].numpy()
    names = [[f"{side}_{joint}" for joint in ("ankle", "foot")] for side in ("left", "right")]
    index = [[SMPL24.index(name) for name in pair] for pair in names]
    assert np.allclose(points, walk.positions()[:, index], atol=1e-5)


def test_one_newton_step_brings_near_rotations_onto_so3() -> None:
    frames = random_frames()
    noisy = frames.clone()
    noisy[..., :216] += 0.02 * torch.randn(frames[..., :216].shape, generator=torch.Generator().manual_seed(1))
    assert skewness(orthonormal(noisy)) < 0.25 * skewness(noisy)
    assert skewness(orthonormal(orthonormal(orthonormal(noisy)))) < 1e-5


def skewness(frames: torch.Tensor) -> float:
    """How far the matrices are from orthonormal."""
    matrices = frames[..., :216].unflatten(-1, (24, 3, 3))
    return float((matrices @ matrices.transpose(-1, -2) - torch.eye(3)).abs().max())


def test_bending_turns_by_curvature_times_distance(walk: Motion) -> None:
    curved = bent(walk, np.full(walk.frames, 0.5))
    way = np.linalg.norm(np.diff(smoothed(walk.root[:, [0, 2]]), axis=0), axis=1).sum()
    step = curved.root[-1] - curved.root[-2]
    before = walk.root[-1] - walk.root[-2]
    turned = np.arctan2(step[0], step[2]) - np.arctan2(before[0], before[2])
    assert turned == pytest.approx(0.5 * way, abs=0.02)
    assert np.allclose(curved.root[:, 1], walk.root[:, 1])


def test_straight_bending_changes_nothing(walk: Motion) -> None:
    same = bent(walk, np.zeros(walk.frames))
    assert np.allclose(same.root, walk.root, atol=1e-4)
    assert np.allclose(same.rotations, walk.rotations, atol=1e-6)


def test_curvature_waves_stay_within_their_bounds() -> None:
    curve = wave(400, np.random.default_rng(0), 0.8)
    assert curve.shape == (400,)
    assert np.abs(curve).max() <= 0.8
    assert np.abs(np.diff(curve)).max() < 0.1  # smooth


def test_playing_faster_shortens_and_speeds_up(walk: Motion) -> None:
    fast = resped(walk, 1.25)
    assert fast.fps == walk.fps
    assert fast.frames == pytest.approx(walk.frames / 1.25, abs=2)
    assert speeds_ahead(fast).mean() == pytest.approx(1.25 * speeds_ahead(walk).mean(), rel=0.03)


def test_a_walk_is_found_and_standing_is_not(walk: Motion) -> None:
    standing = Motion(np.repeat(walk.rotations[:1], 90, 0), np.repeat(walk.root[:1], 90, 0), walk.fps)
    assert sum(part.frames for part in locomotion_parts(walk)) == walk.frames
    assert locomotion_parts(standing) == []


def test_goals_face_where_the_walk_goes(walk: Motion) -> None:
    assert np.allclose(goal_headings(walk)[10:-10], 0.0, atol=0.15)  # the gait walks along +Z


def test_every_variant_comes_with_its_mirror_image(walk: Motion) -> None:
    made = list(variants(walk, Variants(speeds=(1.1,), bends=1), np.random.default_rng(0)))
    assert len(made) == 2 * 3
    for plain, mirrored in zip(made[::2], made[1::2], strict=True):
        assert np.allclose(plain.mirror().root, mirrored.root, atol=1e-5)


def test_lists_of_walks_and_runs_do_not_overlap() -> None:
    assert WALKS
    assert RUNS
    assert not WALKS & RUNS


@pytest.fixture(scope="module")
def task(walk: Motion) -> WalkTask:
    pool = pool_of(iter([(walk, 1.0), (walk.mirror(), 1.0)]))
    settings = WalkSettings(width=32, ff=32, batch=8, chain_after=0, chain=2, chunk=4)
    return WalkTask(pool, pool, settings, seed=3)


def test_batches_depend_on_seed_and_step_alone(task: WalkTask) -> None:
    first, again, other = task.batch(5), task.batch(5), task.batch(6)
    assert all(torch.equal(first[name], again[name]) for name in first)
    assert not torch.equal(first["window"][:, :FRAMES], other["window"][:, :FRAMES])


def test_windows_are_seen_from_a_goal_that_lies_ahead(task: WalkTask) -> None:
    batch = task.batch(0)
    assert (batch["window"][:, FRAMES - 1, 218] < 0.05).all()  # the walker comes from behind the goal, at z < 0


def test_training_lowers_the_loss(task: WalkTask) -> None:
    torch.manual_seed(0)
    optimiser = torch.optim.Adam(task.model.parameters(), lr=1e-2)
    losses = []
    for _ in range(60):
        loss = task.losses(task.model, task.batch(1))["loss"]
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        losses.append(float(loss.detach()))
    assert np.mean(losses[-3:]) < 0.8 * losses[0]


def test_a_teacher_says_how_plain_walks_go_on_and_the_data_everything_else(walk: Motion, tmp_path: Path) -> None:
    pool = pool_of(iter([(walk, 1.0), (walk.mirror(), 1.0)]))
    settings = WalkSettings(width=32, ff=32, batch=8, chain_after=0, chain=2, chunk=4, noise=0.0)
    own = WalkTask(pool, pool, settings, seed=3)
    kept = tmp_path / "kept.safetensors"
    save_release(own.model, kept, {})
    taught = WalkTask(pool, pool, replace(settings, teacher=str(kept), plain=1.0, stick=0.0, facing=0.0), seed=3)
    taught.model.load_state_dict(load_any(kept, WalkNet).state_dict())
    batch = taught.batch(2)
    assert batch["plain"].all()
    batch["wish"] = torch.zeros_like(batch["wish"])
    assert taught.losses(taught.model, batch)["features"] < 1e-6
    batch["plain"] = torch.zeros_like(batch["plain"])
    assert taught.losses(taught.model, batch)["features"] > 0.01
