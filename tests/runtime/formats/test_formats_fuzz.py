"""Damaged bytes: whatever they are, only a MotionRTError comes out, or a sound clip."""

from __future__ import annotations

import random
from pathlib import Path

import numpy as np
import pytest
from mini_files import AMC, ASF, BVH, write
from motions import random_motion

from motionrt.errors import MotionRTError
from motionrt.formats import load_rig, write_npz

CASES = 300
JUNK = [*(bytes([c]) for c in b"\xff\0{}\n -e.9#:"), b"nan", b"JOINT", b"1e999", b"\xc3\x28"]


def mutate(content: bytes, rng: random.Random) -> bytes:
    """A few bytes changed, a piece cut out, doubled or replaced by junk."""
    for _ in range(rng.randint(1, 2)):
        start = rng.randrange(len(content))
        stop = min(len(content), start + rng.choice([1, 1, 2, 8, 100]))
        piece = content[start:stop]
        noise = bytes(rng.randrange(256) for _ in piece)
        kinds = [b"", piece * 2, rng.choice(JUNK), noise, bytes([piece[0] ^ 1])]
        content = content[:start] + rng.choice(kinds) + content[stop:] or b" "
    return content


def load_damaged(path: Path, content: bytes) -> bool:
    """Whether the damaged file still reads; then what it holds must be finite and whole."""
    write(path, content)
    try:
        clip = load_rig(path)
    except MotionRTError:
        return False
    positions, rotations = clip.global_pose()
    assert np.isfinite(positions).all()
    assert np.isfinite(rotations).all()
    assert clip.frames >= 1
    return True


def outcomes(path: Path, content: bytes) -> list[bool]:
    rng = random.Random(20)
    return [load_damaged(path, mutate(content, rng)) for _ in range(CASES)]


@pytest.mark.filterwarnings("error", "ignore::motionrt.errors.MotionFileWarning")
def test_damaged_bvh(tmp_path: Path) -> None:
    assert 5 < sum(outcomes(tmp_path / "clip.bvh", BVH.encode())) < CASES - 20


@pytest.mark.filterwarnings("error", "ignore::motionrt.errors.MotionFileWarning")
def test_damaged_amc(tmp_path: Path) -> None:
    write(tmp_path / "01.asf", ASF)
    assert 5 < sum(outcomes(tmp_path / "01_01.amc", AMC.encode())) < CASES - 20


@pytest.mark.filterwarnings("error")
def test_damaged_asf(tmp_path: Path) -> None:
    amc, rng = write(tmp_path / "01_01.amc", AMC), random.Random(21)
    readable = 0
    for _ in range(CASES):
        write(tmp_path / "01.asf", mutate(ASF.encode(), rng))
        readable += load_damaged(amc, AMC.encode())
    assert 20 < readable < CASES - 20


def test_damaged_npz(tmp_path: Path) -> None:
    path = write_npz(random_motion(4), tmp_path / "clip.npz")
    assert sum(outcomes(path, path.read_bytes())) < CASES - 20


@pytest.mark.parametrize("suffix", [".bvh", ".amc", ".npz"])
def test_random_bytes(tmp_path: Path, suffix: str) -> None:
    rng = random.Random(22)
    for size in (1, 2, 3, 10, 100, 10_000):
        for alphabet in (range(256), range(32, 127), b"0123456789 .\n", b"{}\n ROTJINEDS"):
            content = bytes(rng.choice(list(alphabet)) for _ in range(size))
            assert not load_damaged(tmp_path / f"noise{suffix}", content)
