"""Drawing on a canvas: pieces, rings, what is held and what is corrected, with a denoiser that is known."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from motionrt.models.motion_denoiser import Told
from motionrt.models.text import SentenceFeatures
from motionrt.motion.body_parts import PARTS
from motionrt.motion.features import ego77
from motionrt.motion.skeleton import SMPL24
from motionrt.synthesis.canvas import OWNERS, Canvas, Held, Piece, Words, draw
from motionrt.synthesis.constraints import Constraints, Target, Waypoint
from motionrt.synthesis.motion_diffusion import HIGHEST, LOWEST, noise_levels, solve

STANDING = SMPL24.rest_positions - [0.0, SMPL24.rest_positions[:, 1].min(), 0.0]


class Known:
    """A denoiser that always estimates the same motion for a text, and keeps what is held."""

    def __init__(self, motions: dict[int, np.ndarray]) -> None:
        self.motions, self.lengths = motions, list[int]()

    def __call__(self, noisy: Any, level: Any, told: Told, guidance: Any) -> tuple[Any, Any]:
        self.lengths.append(noisy.shape[1])
        one = np.broadcast_to(self.motions[int(told.slots[0, 0])], noisy.shape[1:])
        kept = np.where(told.holding[0][:, OWNERS], told.held[0], one)[None].astype(np.float32)
        return kept, kept


def words(number: int) -> Words:
    features = SentenceFeatures(np.zeros((1, 1, 384), np.float32), np.ones((1, 1), np.int64), np.zeros(384))
    return Words(features, np.full(21, number))


def piece(number: int, first: int, weight: np.ndarray) -> Piece:
    return Piece(words(number), first, weight.astype(np.float32))


def noise(frames: int) -> np.ndarray:
    return np.random.default_rng(0).standard_normal((frames, 77), dtype=np.float32)


def test_levels_fall_from_the_highest_to_the_lowest() -> None:
    levels = noise_levels(12)
    assert (np.diff(levels) < 0).all()
    assert levels[0] == pytest.approx(60)
    assert levels[-1] == pytest.approx(0.15)


def test_the_solver_is_exact_for_normal_data_as_steps_grow() -> None:
    # For x_0 normal with deviation d the estimate is d^2 x / (d^2 + s^2). The flow keeps x / sqrt(d^2 + s^2), from the
    # highest level to the lowest, where the answer is the estimate.
    start = np.random.default_rng(1).standard_normal((1, 4, 77), dtype=np.float32)
    found = solve(lambda x, s: np.float32(0.25 / (0.25 + s * s)) * x, start, 400)
    exact = HIGHEST * start / np.sqrt(0.25 + HIGHEST**2) * 0.25 / np.sqrt(0.25 + LOWEST**2)
    assert found == pytest.approx(exact, abs=2e-3)


def test_pieces_own_their_frames_and_pass_into_each_other() -> None:
    rise = np.repeat(np.clip((np.arange(20) - 8) / 4, 0, 1)[:, None], 6, axis=1)
    canvas = Canvas([piece(1, 0, 1 - rise), piece(2, 0, rise)], Held.nothing(20))
    found = draw(Known({1: np.full(77, 1.0), 2: np.full(77, 3.0)}), canvas, noise(20), 4, (1, 1))
    assert found[:6] == pytest.approx(1.0)
    assert found[15:] == pytest.approx(3.0)
    assert found[10] == pytest.approx(2.0, abs=0.1)


def test_a_part_belongs_to_the_piece_that_owns_it() -> None:
    arm = np.zeros((10, 6))
    arm[:, PARTS.index("left arm")] = 1
    canvas = Canvas([piece(1, 0, 1 - arm), piece(2, 0, arm)], Held.nothing(10))
    found = draw(Known({1: np.full(77, 1.0), 2: np.full(77, 3.0)}), canvas, noise(10), 3, (1, 1))
    wrist = ego77.JOINTS.start + 3 * (SMPL24.index("left_wrist") - 1)
    knee = ego77.JOINTS.start + 3 * (SMPL24.index("left_knee") - 1)
    assert found[:, wrist] == pytest.approx(3.0)
    assert found[:, knee] == pytest.approx(1.0)


def test_a_ring_is_seen_beyond_its_end_where_it_begins() -> None:
    denoiser = Known({1: np.zeros(77)})
    draw(denoiser, Canvas([piece(1, 0, np.ones((26, 6)))], Held.nothing(20), ring=True), noise(20), 2, (1, 1))
    assert denoiser.lengths == [26, 26]


def test_what_is_held_stands_as_it_was_given() -> None:
    held = Held.nothing(10)
    held.motion[3], held.parts[3] = 7.0, True
    found = draw(Known({1: np.zeros(77)}), Canvas([piece(1, 0, np.ones((10, 6)))], held), noise(10), 3, (1, 1))
    assert found[3] == pytest.approx(7.0)
    assert found[7] == pytest.approx(0.0)


def standing(forward: float = 0.0) -> np.ndarray:
    """(77,) of somebody who stands or goes straight ahead, metres a frame."""
    row = ego77.encode(np.repeat(STANDING[None], 3, axis=0))[0]
    row[2] = forward
    return row


def drawn(constraints: Constraints, forward: float) -> np.ndarray:
    """Joints (61, 24, 3) that were drawn."""
    canvas = Canvas([piece(1, 0, np.ones((61, 6)))], constraints.held(61), correct=constraints.corrected)
    return ego77.decode(draw(Known({1: standing(forward)}), canvas, noise(61), 12, (1, 1)))


def test_a_path_is_met_at_its_times_with_its_headings() -> None:
    way = (Waypoint(1.0, (0.3, 1.0)), Waypoint(2.0, (1.0, 1.5), heading=60.0), Waypoint(3.0, (1.5, 1.5), heading=90.0))
    joints = drawn(Constraints(path=way), forward=0.05)
    for waypoint in way:
        frame = round(waypoint.time * 20)
        assert joints[frame, 0, [0, 2]] == pytest.approx(waypoint.place, abs=1e-3)
    assert np.degrees(ego77.facing(joints))[[-1]] == pytest.approx(90, abs=2)


def test_a_hand_meets_its_target_and_the_other_stays() -> None:
    wrist = SMPL24.index("right_wrist")
    place = STANDING[wrist] - STANDING[0] * [1, 0, 1] + [0.05, 0.2, 0.1]
    joints = drawn(Constraints(targets=(Target(1.5, "right_wrist", tuple(place)),)), forward=0.0)
    assert joints[30, wrist] == pytest.approx(place, abs=1e-3)
    left = SMPL24.index("left_wrist")
    assert joints[30, left] == pytest.approx(joints[0, left], abs=1e-4)
    assert joints[50, wrist] == pytest.approx(joints[0, wrist], abs=1e-4)
