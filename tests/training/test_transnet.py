"""TransNet: coasting through gaps, what it leaves alone, its windows, its training, its comparison."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path

import numpy as np
import pytest
import torch
from motions import random_motion, walking
from scipy.integrate import quad
from scipy.spatial.transform import Rotation, Slerp

from motionrt.errors import InvalidInputError
from motionrt.formats.motion_pack import MotionPack
from motionrt.metrics.locomotion import foot_skate
from motionrt.motion import SMPL24, Motion
from motionrt.motion.features import ccf219
from motionrt.motion.transforms import moved, turned
from motionrt_training.corpora.recordings import Recordings
from motionrt_training.evaluate import transitions
from motionrt_training.networks.transnet import COAST, FRAMES, SEED, TransNet, fill, find_gap, smoothed
from motionrt_training.recipes import transnet as recipe
from motionrt_training.trainer import Schedule, Trainer

FPS = 30.0
SETTINGS = recipe.TransNetSettings(
    d=32, layers=1, heads=2, ff=32, dropout=0.0, batch=8, grow=5, examples=64, skate_after=2
)


def hidden_from(first: int, stop: int, batch: int = 1) -> torch.Tensor:
    return recipe.hidden_frames(np.full(batch, first), np.full(batch, stop))


def encoded(*motions: Motion) -> torch.Tensor:
    return torch.from_numpy(np.stack([ccf219.encode(motion) for motion in motions]))


def small_net(seed: int = 0) -> TransNet:
    torch.manual_seed(seed)
    net = TransNet(d=32, layers=2, heads=2, ff=32)
    torch.nn.init.normal_(net.body.out.weight, std=0.2)
    return net.eval()


def recordings_of(*motions: Motion, splits: tuple[str, ...]) -> Recordings:
    return Recordings(MotionPack.of(motions), tuple(f"clip{i}" for i in range(len(motions))), splits)


def corpus() -> Recordings:
    walks = [walking(200, FPS, speed, turn) for speed, turn in ((1.0, 0.0), (1.4, 0.4), (1.2, -0.3))]
    return recordings_of(*walks, splits=("train", "train", "val"))


# -- the network


def test_coasting_integrates_speeds_that_fade_into_an_even_one() -> None:
    v, w, first, stop = 0.4, -0.1, 60, 100
    x = torch.zeros(1, FRAMES, 1)
    x[0, :first, 0] = v * (torch.arange(first) - first + 1.0)
    x[0, stop:, 0] = 5.0 + w * torch.arange(FRAMES - stop)
    found = fill(x.masked_fill(hidden_from(first, stop)[..., None], 0.0), find_gap(hidden_from(first, stop)))[0, :, 0]
    length = stop - first + 1

    def speed(t: float, even: float) -> float:
        return even + (v - even) * np.exp(-t / COAST) + (w - even) * np.exp((t - length) / COAST)

    one, none = (quad(speed, 0, length, args=(even,))[0] for even in (1.0, 0.0))
    even = (5.0 - none) / (one - none)
    expected = [quad(speed, 0, t, args=(even,))[0] for t in range(length + 1)]
    np.testing.assert_allclose(found[first - 1 : stop + 1], expected, atol=1e-4)


def test_without_any_speed_to_be_seen_the_way_is_straight() -> None:
    x = torch.zeros(1, FRAMES, 2)
    x[0, -1] = torch.tensor([1.0, -2.0])
    hidden = hidden_from(1, FRAMES - 1)
    found = fill(x, find_gap(hidden))[0]
    np.testing.assert_allclose(found, np.linspace([0, 0], [1, -2], FRAMES), atol=1e-5)


def test_an_untrained_network_coasts_and_a_trained_one_does_not() -> None:
    frames, hidden = encoded(walking(FRAMES, FPS, turn=0.4)), hidden_from(SEED, FRAMES - 1)
    coasting = fill(frames.masked_fill(hidden[..., None], 0.0), find_gap(hidden))
    with torch.no_grad():
        torch.testing.assert_close(TransNet(d=32, heads=2).eval()(frames, hidden), coasting, atol=1e-5, rtol=0)
        assert float((small_net()(frames, hidden) - coasting).abs().max()) > 0.05


def test_visible_frames_come_back_to_the_last_bit_and_hidden_ones_are_not_read() -> None:
    frames = encoded(walking(FRAMES, FPS), random_motion(FRAMES, FPS))
    hidden = torch.cat((hidden_from(SEED, FRAMES - 1), hidden_from(50, 70)))
    with torch.no_grad():
        found = small_net()(frames, hidden)
        blind = small_net()(frames.masked_fill(hidden[..., None], float("nan")), hidden)
    assert torch.equal(found[~hidden], frames[~hidden])
    assert torch.equal(found, blind)


def test_the_correction_fades_towards_visible_frames() -> None:
    frames, hidden = encoded(walking(FRAMES, FPS)), hidden_from(SEED, FRAMES - 1)
    coasting = fill(frames.masked_fill(hidden[..., None], 0.0), find_gap(hidden))
    with torch.no_grad():
        change = (small_net()(frames, hidden) - coasting).norm(dim=2)[0]
    assert change[SEED] < 0.3 * change[SEED : FRAMES - 1].max()
    assert change[FRAMES - 2] < 0.3 * change[SEED : FRAMES - 1].max()


def test_where_in_the_world_it_happens_does_not_matter() -> None:
    motion = random_motion(FRAMES, FPS, seed=3)
    elsewhere = moved(turned(motion, 1.1), np.array([4.0, 0.0, -2.0], np.float32))
    hidden = hidden_from(SEED, FRAMES - 1, 2)
    with torch.no_grad():
        here, there = small_net()(encoded(motion, elsewhere), hidden).numpy()
    expected = moved(turned(Motion(motion.rotations, here[:, 216:], FPS), 1.1), np.array([4.0, 0.0, -2.0]))
    np.testing.assert_allclose(there[:, 216:], expected.root, atol=1e-3)
    turn = Rotation.from_euler("y", 1.1).as_matrix()
    np.testing.assert_allclose(there[:, :9].reshape(-1, 3, 3), turn @ here[:, :9].reshape(-1, 3, 3), atol=1e-3)
    np.testing.assert_allclose(there[:, 9:216], here[:, 9:216], atol=1e-3)


def test_smoothing_takes_jitter_away_and_leaves_straight_lines() -> None:
    line = torch.linspace(0, 1, 20)[None, :, None]
    torch.testing.assert_close(smoothed(line)[:, 2:-2], line[:, 2:-2])
    jitter = (-1.0) ** torch.arange(20.0)[None, :, None]
    assert float(smoothed(jitter)[:, 2:-2].abs().max()) < 1e-6


# -- what it is trained on


def test_joint_positions_are_those_of_forward_kinematics_and_scaled_rotations_do_no_harm() -> None:
    motion = random_motion(6, FPS)
    found = recipe.joint_positions(encoded(motion))[0]
    np.testing.assert_allclose(found, motion.positions(), atol=1e-5)
    scaled = encoded(motion)
    scaled[..., :216] *= 1.1
    np.testing.assert_allclose(recipe.joint_positions(scaled, rounds=4)[0], motion.positions(), atol=1e-4)
    scaled[..., :216] *= 4.0
    assert bool(recipe.joint_positions(scaled).isfinite().all())


def test_the_foot_skate_that_is_trained_on_is_the_one_that_is_measured() -> None:
    motion = walking(40, FPS, turn=0.2)
    found = recipe.skate(torch.from_numpy(motion.positions()[None].copy()))
    assert float(found.mean()) == pytest.approx(foot_skate(motion.positions()), rel=0.03)


def test_mirrored_windows_are_mirrored_motions() -> None:
    motion = random_motion(4, FPS)
    found = recipe.mirrored(encoded(motion, motion), np.array([True, False]))
    np.testing.assert_allclose(found[0], ccf219.encode(motion.mirror()), atol=1e-6)
    np.testing.assert_array_equal(found[1], ccf219.encode(motion))


def test_arms_of_another_window_leave_the_rest_alone() -> None:
    a, b = random_motion(4, FPS, seed=1), random_motion(4, FPS, seed=2)
    found = recipe.other_arms(encoded(a, b), np.array([True, False]), np.array([1, 0]))
    rotations = found[0, :, :216].reshape(4, 24, 3, 3).numpy()
    arms = [i for i, name in enumerate(SMPL24.names) if name.split("_")[-1] in ("shoulder", "elbow", "wrist", "hand")]
    rest = [i for i in range(24) if i not in arms]
    np.testing.assert_array_equal(rotations[:, arms], b.rotations[:, arms])
    np.testing.assert_array_equal(rotations[:, rest], a.rotations[:, rest])
    np.testing.assert_array_equal(found[1], ccf219.encode(b))


def test_the_gap_grows_to_all_frames_before_the_target_and_never_hides_an_end() -> None:
    rng, plain = np.random.default_rng(0), recipe.TransNetSettings(batch=400, tails=0.0, gaps=0.0)
    for grown, stop in ((0.0, SEED + 4), (0.5, SEED + 30), (1.0, FRAMES - 1)):
        first, last = recipe.gaps(rng, plain, grown)
        assert set(first) == {SEED}
        assert set(last) == {stop}
    for grown in (0.0, 0.5, 1.0):
        hidden = recipe.hidden_frames(*recipe.gaps(rng, recipe.TransNetSettings(batch=400, tails=0.5, gaps=0.5), grown))
        assert bool(hidden.any(1).all())
        assert not bool(hidden[:, : recipe.EARLIEST].any())
        assert not bool(hidden[:, -1].any())


def test_seeds_stand_still_and_ends_are_held_where_asked() -> None:
    frames = encoded(walking(FRAMES, FPS), walking(FRAMES, FPS))
    still = recipe.frozen_seed(frames, np.array([True, False]))
    assert torch.equal(still[0, :SEED], frames[0, SEED - 1].expand(SEED, -1))
    assert torch.equal(still[0, SEED:], frames[0, SEED:])
    assert torch.equal(still[1], frames[1])
    held = recipe.held_end(frames, np.array([110, 110]), np.array([False, True]))
    assert torch.equal(held[1, 110:], frames[1, -1].expand(10, -1))
    assert torch.equal(held[1, :110], frames[1, :110])
    assert torch.equal(held[0], frames[0])


def test_calm_ends_are_held_and_windows_with_more_to_see_are_drawn_more_often() -> None:
    calm = walking(40, FPS, speed=0.0)
    calm = Motion(np.repeat(calm.rotations[:1], 40, axis=0), calm.root, FPS)
    found = recipe.windows([calm, walking(130, FPS)], (1.0,))
    assert len(found.frames) == SEED + 40 + recipe.TAIL + 130
    assert len(found.starts) == 1 + 11
    odds = np.diff(found.odds, prepend=0.0)
    assert odds[0] < 0.2 * odds[1:].min()
    drawn = found.draw(np.random.default_rng(0), 2000)
    assert np.mean(drawn == 0) == pytest.approx(odds[0] / odds.sum(), abs=0.02)


def test_training_beats_coasting_on_held_out_walks_and_goes_on_where_it_stopped(tmp_path: Path) -> None:
    task = recipe.TransNetTask(corpus(), SETTINGS, seed=0)
    with torch.no_grad():
        before = task.validate(task.model.eval())
    notes = {"network": task.model.config}
    schedule = Schedule(steps=20, lr=3e-3, warmup=1, ema=0.5, validate_every=20, bf16=False, device="cpu")
    Trainer(task, schedule, tmp_path / "run", notes).run()
    again = recipe.TransNetTask(corpus(), SETTINGS, seed=0)
    longer = Schedule(steps=40, lr=3e-3, warmup=1, ema=0.5, validate_every=20, bf16=False, device="cpu")
    trainer = Trainer(again, longer, tmp_path / "run", notes)
    after = trainer.run()
    assert trainer.step == 40
    assert after["joint_cm"] < 0.8 * before["joint_cm"]


@pytest.mark.parametrize("window", [96, 180])
def test_other_windows_than_the_shipped_one_can_be_trained(window: int) -> None:
    task = recipe.TransNetTask(corpus(), dataclasses.replace(SETTINGS, window=window), seed=0)
    batch = task.batch(9)
    assert batch["frames"].shape == (8, window, 219)
    assert batch["hidden"].shape == (8, window)
    assert not batch["hidden"][:, -1].any()
    found = task.losses(task.model, batch)
    assert torch.isfinite(found["loss"])
    assert set(task.validate(task.model.eval())) >= {"joint_cm", "skate"}
    task.model.eval()
    with torch.no_grad():
        frames = task.model(batch["frames"], recipe.whole_gap(8, window))
    torch.testing.assert_close(frames[:, :SEED], batch["frames"][:, :SEED], atol=0, rtol=0)


def test_the_published_loss_is_the_squared_error_of_the_hidden_frames_alone() -> None:
    task = recipe.TransNetTask(corpus(), dataclasses.replace(SETTINGS, loss="l2"), seed=0)
    batch, off = task.batch(9), torch.zeros(219)
    off[3], off[217] = 0.1, 0.3
    found = task.losses(lambda frames, hidden: frames + off * hidden[..., None], batch)
    assert float(found["loss"]) == pytest.approx(0.1, rel=1e-4)  # 0.01 + 0.09, whatever the windows' lengths
    assert set(found) == {"loss", "feature"}


def test_impossible_windows_and_short_recordings_are_refused() -> None:
    for window in (70, 122):
        with pytest.raises(InvalidInputError, match="--window must be a multiple of --patch, at least 80"):
            recipe.TransNetTask(corpus(), dataclasses.replace(SETTINGS, window=window), seed=0)
    with pytest.raises(InvalidInputError, match="no recording of a split is 400 frames long"):
        recipe.TransNetTask(corpus(), dataclasses.replace(SETTINGS, window=400), seed=0)


# -- how it is compared


def test_interpolation_is_spherical_and_keeps_the_ends() -> None:
    motion = random_motion(FRAMES, FPS, seed=4)
    found = transitions.interpolate(motion)
    np.testing.assert_array_equal(found.rotations[:SEED], motion.rotations[:SEED])
    np.testing.assert_allclose(found.positions()[-1], motion.positions()[-1], atol=1e-5)
    for joint in (0, 5, 18):
        ends = Rotation.from_matrix(motion.rotations[[SEED - 1, -1], joint])
        middle = Slerp([0, 60], ends)([20]).as_matrix()[0]
        np.testing.assert_allclose(found.rotations[SEED - 1 + 20, joint], middle, atol=1e-5)
    np.testing.assert_allclose(
        found.root[SEED - 1 + 20], motion.root[SEED - 1] * 2 / 3 + motion.root[-1] / 3, atol=1e-6
    )


def test_real_motion_has_no_error_and_a_shift_is_measured_in_centimetres() -> None:
    motion = walking(FRAMES, FPS)
    real = transitions.measure([motion], [motion])
    assert (real.windows, real.joint_cm, real.pose_cm, real.end_cm) == (1, 0.0, 0.0, 0.0)
    shifted = transitions.measure([moved(motion, np.array([0.03, 0, 0.04]))], [motion])
    assert shifted.joint_cm == pytest.approx(5.0, abs=1e-3)
    assert shifted.pose_cm == pytest.approx(0.0, abs=1e-3)
    jump = motion.root.copy()
    jump[SEED:, 0] += 0.02  # one step of 2 cm: 0.6 m/s for one frame
    row = transitions.measure([Motion(motion.rotations, jump, FPS)], [motion])
    assert row.seed_step == pytest.approx(0.6, abs=1e-3)


def test_the_command_compares_all_ways_on_held_out_windows(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    net = TransNet(d=32, layers=1, heads=2, ff=32)
    state = {"model": net.state_dict(), "notes": {"network": net.config}}
    torch.save(state, tmp_path / "best.pt")
    pack = recordings_of(walking(130, FPS), walking(140, FPS), splits=("test", "train"))
    with (tmp_path / "corpus.npz").open("wb") as file:
        pack.pack.write(file)
    rows = {"ids": pack.ids, "splits": pack.splits}
    (tmp_path / "corpus.json").write_text(json.dumps(rows), encoding="utf-8")
    options = ["--corpus", str(tmp_path / "corpus.npz"), "--checkpoint", str(tmp_path / "best.pt"), "--count", "3"]
    transitions.main([*options, "--json"])
    found = json.loads(capsys.readouterr().out)
    assert found["all"]["real motion"]["joint_cm"] == 0
    assert found["all"]["interpolation"]["windows"] == 3
    assert found["root travels > 0.5 m"]["TransNet"]["windows"] == 3  # a walk of 1.2 m/s goes 2.4 m
    transitions.main(options)
    assert "| TransNet |" in capsys.readouterr().out
