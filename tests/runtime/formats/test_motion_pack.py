"""Packed motions: what comes back, and what is refused."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
from motions import random_motion, standing

from motionrt.errors import FormatError, InvalidInputError
from motionrt.formats.motion_pack import MotionPack
from motionrt.motion import SMPL24, Motion, Skeleton
from motionrt.motion.rotations import axis_angle_to_matrix


def _stored(motions: list[Motion], folder: Path) -> MotionPack:
    with (folder / "m.npz").open("wb") as file:
        MotionPack.of(motions).write(file)
    return MotionPack.read(folder / "m.npz")


def test_motions_come_back_to_a_tenth_of_a_millimetre(tmp_path: Path) -> None:
    motions = [random_motion(50, seed=1), standing(1, fps=29.97), random_motion(7, fps=60.0, seed=2)]
    pack = _stored(motions, tmp_path)
    for i, motion in enumerate(motions):
        assert (pack[i].fps, pack[i].frames) == (motion.fps, motion.frames)
        np.testing.assert_allclose(pack[i].positions(), motion.positions(), atol=5e-4)
        np.testing.assert_allclose(pack[i].rotations, motion.rotations, atol=2e-4)
        np.testing.assert_array_equal(pack[i].root, motion.root)


def test_half_turns_come_back_as_half_turns(tmp_path: Path) -> None:
    axes = np.random.default_rng(0).normal(size=(20, 24, 3))
    axes *= np.pi * (1 - 1e-6) / np.linalg.norm(axes, axis=-1, keepdims=True)
    rotations = axis_angle_to_matrix(axes).astype(np.float32)
    motion = Motion(rotations, np.zeros((20, 3), np.float32), 20.0)
    np.testing.assert_allclose(_stored([motion], tmp_path)[0].rotations, rotations, atol=5e-4)


def test_the_same_motions_give_the_same_bytes() -> None:
    pack = MotionPack.of([random_motion(30)])
    files = [io.BytesIO(), io.BytesIO()]
    for file in files:
        pack.write(file)
    assert files[0].getvalue() == files[1].getvalue()


def test_another_skeleton_is_refused() -> None:
    longer = Skeleton(SMPL24.names, SMPL24.parents, SMPL24.offsets * 2)
    motion = standing()
    with pytest.raises(InvalidInputError, match="smpl24"):
        MotionPack.of([Motion(motion.rotations, motion.root, motion.fps, longer)])


@pytest.mark.parametrize("content", [b"", b"not a zip", b"PK\x03\x04 cut off"])
def test_a_damaged_file_says_so(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "m.npz"
    path.write_bytes(content)
    with pytest.raises(FormatError, match="damaged"):
        MotionPack.read(path)
