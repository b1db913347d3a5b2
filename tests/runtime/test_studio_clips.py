"""Clips on the stage: interpolation, footsteps, names, files that cannot be read."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from gaits import gait
from hypothesis import given
from hypothesis import strategies as st
from motions import random_motion, walking
from scipy.spatial.transform import Rotation, Slerp

from motionrt.errors import InvalidInputError
from motionrt.motion import Motion
from motionrt.studio.clips import PALETTE, Clip, colour, load_clips, thinned, unique


def test_on_frames_it_is_the_motion_itself() -> None:
    motion = walking(40, fps=20)
    joints, turns = Clip("walk", motion, PALETTE[0]).at(13 / 20)
    np.testing.assert_allclose(joints, motion.positions()[13, :22], atol=1e-6)
    back = Rotation.from_quat(turns[:, [1, 2, 3, 0]]).as_matrix()
    np.testing.assert_allclose(back, motion.global_rotations()[13, :22], atol=1e-5)


def test_between_frames_it_is_near_slerp_and_places_are_linear() -> None:
    motion = walking(40, fps=20)
    joints, turns = Clip("walk", motion, PALETTE[0]).at(13.3 / 20)
    expected = 0.7 * motion.positions()[13, :22] + 0.3 * motion.positions()[14, :22]
    np.testing.assert_allclose(joints, expected, atol=1e-5)
    for joint in range(22):
        ends = Rotation.from_matrix(motion.global_rotations()[13:15, joint])
        apart = Slerp([0, 1], ends)(0.3) * Rotation.from_quat(turns[joint, [1, 2, 3, 0]]).inv()
        assert apart.magnitude() < 0.01


@given(st.integers(0, 1000))
def test_neighbouring_rotations_are_never_on_opposite_sides(seed: int) -> None:
    clip = Clip("any", random_motion(frames=30, seed=seed), PALETTE[0])
    assert ((clip.quaternions[1:] * clip.quaternions[:-1]).sum(axis=-1) >= 0).all()


def test_the_ends_are_held() -> None:
    clip = Clip("walk", walking(10), PALETTE[0])
    np.testing.assert_array_equal(clip.at(99)[0], clip.joints[-1])
    np.testing.assert_array_equal(clip.at(-1)[0], clip.joints[0])


def test_footsteps_are_where_and_when_the_feet_stand() -> None:
    motion, contacts = gait()
    places, spans = Clip("gait", motion, PALETTE[0]).footsteps
    toes = motion.positions()[:, [motion.skeleton.index("left_foot"), motion.skeleton.index("right_foot")]]
    assert len(places) >= 2
    for place, (start, stop) in zip(places, spans, strict=True):
        middle = int((start + stop) / 2 * motion.fps)
        side = int(np.linalg.norm(toes[middle] - place, axis=1).argmin())
        assert contacts[middle, side]
        assert np.linalg.norm(toes[middle, side] - place) < 0.03


def test_a_trail_keeps_its_ends_and_its_spacing() -> None:
    points = np.stack([np.linspace(0, 2, 400), np.zeros(400)], axis=1).astype(np.float32)
    trail = thinned(points, 0.05)
    np.testing.assert_array_equal(trail[[0, -1]], points[[0, -1]])
    assert (np.diff(trail[:-1, 0]) >= 0.05 - 1e-6).all()
    assert len(thinned(np.zeros((9, 2), np.float32), 0.05)) == 1


def test_names_and_colours_differ() -> None:
    clips: list[Clip] = []
    for _ in range(3):
        clips.append(Clip(unique("walk", clips), walking(2), colour(len(clips))))
    assert [clip.name for clip in clips] == ["walk", "walk 2", "walk 3"]
    assert len({clip.colour for clip in clips}) == 3


def test_unreadable_files_are_told_and_the_others_shown(tmp_path: Path) -> None:
    good = walking(5).save(tmp_path / "good.bvh")
    bad = tmp_path / "bad.bvh"
    bad.write_text("HIERARCHY\n", encoding="utf-8")
    clips, problems = load_clips([bad, good, tmp_path / "none.bvh"])
    assert [clip.name for clip in clips] == ["good"]
    assert len(problems) == 2
    assert "bad.bvh" in problems[0]
    with pytest.raises(InvalidInputError, match=r"bad\.bvh"):
        load_clips([bad])


def test_ten_minutes_are_shown_from_any_time_without_work_on_the_rest() -> None:
    short = walking(60, fps=60)
    long = Motion(np.tile(short.rotations, (600, 1, 1, 1)), np.tile(short.root, (600, 1)), 60)
    clip = Clip("long", long, PALETTE[0])
    joints, _ = clip.at(599.5)
    np.testing.assert_allclose(joints, short.positions()[30, :22], atol=1e-5)
    assert len(clip.trail()) < 36_000
