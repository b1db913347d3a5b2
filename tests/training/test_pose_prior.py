"""The pose prior: its network against the runtime's geometry, its balance of poses, and that it learns."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import numpy as np
import pytest
import torch
from motions import random_motion, standing, walking
from scipy.spatial.transform import Rotation

from motionrt.formats.motion_pack import MotionPack
from motionrt.locomotion.posing.objective import Objective
from motionrt.locomotion.posing.search import Search
from motionrt.locomotion.posing.targets import targets_of
from motionrt.models.pose_prior import PosePrior as Prior
from motionrt.motion import SMPL24, Motion
from motionrt.motion.rotations import matrix_from_6d
from motionrt_training.corpora.recordings import Recordings
from motionrt_training.networks.kinematics import joint_positions
from motionrt_training.networks.pose_prior import PosePrior, from_6d, to_6d
from motionrt_training.recipes import pose_prior as recipe
from motionrt_training.trainer import Schedule, Trainer


def crouching() -> Motion:
    """Five frames of deep knee bends among hundreds of steps."""
    motion = standing(5)
    rotations = motion.rotations.copy()
    for name, bend in (("hip", -1.8), ("knee", 2.2)):
        for side in ("left", "right"):
            rotations[:, SMPL24.index(f"{side}_{name}")] = Rotation.from_rotvec([bend, 0, 0]).as_matrix()
    return Motion(rotations, motion.root - [0, 0.5, 0], 30.0)


def recordings() -> Recordings:
    motions = [walking(300, 30.0, turn=0.5), crouching(), walking(60, 30.0), random_motion(40, 30.0)]
    return Recordings(MotionPack.of(motions), ("walk", "crouch", "held", "test"), ("train", "train", "val", "test"))


TINY = recipe.PosePriorSettings(width=64, batch=64, every=1, clusters=12, dropout=0.0)


def test_six_numbers_become_the_rotation_that_the_runtime_makes_of_them() -> None:
    sixd = torch.randn(50, 6, generator=torch.Generator().manual_seed(0))
    np.testing.assert_allclose(from_6d(sixd).numpy(), matrix_from_6d(sixd.numpy()), atol=1e-5)
    rotations = torch.from_numpy(Rotation.random(50, random_state=0).as_matrix())
    torch.testing.assert_close(from_6d(to_6d(rotations)), rotations)


def test_joints_are_where_the_runtime_puts_them() -> None:
    motion = random_motion(6, root=(0, 0, 0))
    expected = motion.positions() - motion.root[:, None]
    np.testing.assert_allclose(joint_positions(torch.from_numpy(motion.rotations.copy())), expected, atol=1e-5)


def test_the_mirror_image_is_that_of_the_runtime() -> None:
    motion = random_motion(6)
    made = recipe.mirrored(torch.from_numpy(motion.rotations.copy()))
    np.testing.assert_allclose(made, motion.mirror().rotations, atol=1e-6)


def test_poses_lose_their_yaw_and_those_upside_down_are_left_out() -> None:
    poses = recipe.poses_of(recordings(), "train")
    assert len(poses) == 305
    torch.testing.assert_close(poses[:300, 0], torch.eye(3).expand(300, 3, 3), atol=1e-4, rtol=0)  # walks upright
    motion = standing(3)
    rotations = motion.rotations.copy()
    rotations[1, 0] = Rotation.from_euler("x", 150, degrees=True).as_matrix()
    turned_over = Recordings(MotionPack.of([Motion(rotations, motion.root, 30.0)]), ("a",), ("val",))
    assert len(recipe.poses_of(turned_over, "val")) == 2


@pytest.mark.parametrize(("balance", "least", "most"), [(1.0, 0.014, 0.019), (0.0, 0.07, 0.6), (0.5, 0.02, 0.2)])
def test_rare_poses_are_drawn_more_often_the_lower_the_balance(balance: float, least: float, most: float) -> None:
    """5 of 305 poses are crouches (1.6 %); where all clusters weigh the same, theirs is one of at most twelve."""
    poses = recipe.poses_of(recordings(), "train")
    weights = recipe.pose_weights(poses, 12, balance, seed=0)
    assert weights.sum() == pytest.approx(1)
    assert least < weights[300:].sum() < most


def test_k_means_finds_well_separated_clusters() -> None:
    centres = torch.tensor([[0.0, 0.0], [10.0, 0.0], [0.0, 10.0]])
    points = (centres[:, None] + 0.1 * torch.randn(3, 20, 2, generator=torch.Generator().manual_seed(0))).flatten(0, 1)
    for seed in range(20):
        member = recipe.k_means(points, 3, seed, sweeps=10)
        if len(set(member.tolist())) == 3 and sorted(Counter(member.tolist()).values()) == [20, 20, 20]:
            assert all(len(set(member[i : i + 20].tolist())) == 1 for i in (0, 20, 40))
            return
    pytest.fail("no seed of twenty told three clusters apart")


def test_batches_depend_on_seed_and_step_alone() -> None:
    one, other = (recipe.PosePriorTask(recordings(), TINY, seed=3) for _ in range(2))
    assert torch.equal(one.batch(7), other.batch(7))
    assert not torch.equal(one.batch(7), one.batch(8))


def test_training_lowers_the_error_of_held_out_poses_and_goes_on_where_it_stopped(tmp_path: Path) -> None:
    task = recipe.PosePriorTask(recordings(), TINY, seed=0)
    with torch.no_grad():
        before = task.validate(task.model.eval())["error_cm"]
    schedule = Schedule(steps=120, lr=3e-3, warmup=1, ema=0.9, validate_every=60, bf16=False, device="cpu")
    notes = {"network": task.model.config}
    after = Trainer(task, schedule, tmp_path, notes).run()["error_cm"]
    assert after < 0.5 * before
    again = Trainer(recipe.PosePriorTask(recordings(), TINY, seed=0), schedule, tmp_path, notes)
    again.run()
    assert again.step == 120


def test_the_jacobian_of_the_search_is_that_of_automatic_differentiation() -> None:
    torch.manual_seed(0)
    network = PosePrior(width=64).eval()
    network.mean.copy_(to_6d(torch.eye(3).expand(24, 3, 3)).flatten())
    prior = Prior(lambda rows: network(torch.from_numpy(rows)).detach().numpy())
    target = torch.tensor([0.3, 1.1, 0.4])
    search = Search(prior, Objective(targets_of({"left_hand": target.numpy()}, None, None)))
    x = np.concatenate([np.random.default_rng(0).normal(size=32) * 0.5, [0.1, 0.9, 0.2, 0.7]])

    def residuals(unknowns: torch.Tensor) -> torch.Tensor:
        cos, sin = unknowns[35].cos(), unknowns[35].sin()
        hand = joint_positions(network(unknowns[None, :32]))[0, SMPL24.index("left_hand")]
        turned = torch.stack([cos * hand[0] + sin * hand[2], hand[1], cos * hand[2] - sin * hand[0]])
        return (turned + unknowns[32:35] - target) / search.objective.weights.reach

    unknowns = torch.from_numpy(x.astype(np.float32))
    expected = torch.autograd.functional.jacobian(residuals, unknowns)
    found, derivatives = search.residuals(x)
    np.testing.assert_allclose(derivatives[:3], expected, atol=0.01 * float(expected.abs().max()))
    np.testing.assert_allclose(found[:3], residuals(unknowns).detach(), atol=1e-2)
