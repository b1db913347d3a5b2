"""The real recordings, where they are at hand: every file reads and loses only its T-pose."""

from __future__ import annotations

import csv
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from motionrt.formats import drop_leading_tpose, load_motion, load_rig
from motionrt.formats.acclaim.asf_search import find_asf

MOCAP = Path(__file__).parents[4] / "shared" / "data" / "mocap"
CMU = MOCAP / "cmu"

pytestmark = pytest.mark.skipif(not CMU.is_dir(), reason=f"the recordings are not at {MOCAP}")

# Conversions whose first frame is the motion's own although all others of their kind begin with a T-pose.
NO_T_POSE = {"131_01", "131_02", "16_01", "16_02"}


@cache
def listed_frames() -> dict[str, int]:
    with (CMU / "index.csv").open(encoding="utf-8", newline="") as file:
        return {row["trial"]: int(row["frames"]) for row in csv.DictReader(file)}


def files(pattern: str) -> list[Path]:
    return sorted(CMU.glob(pattern)) if CMU.is_dir() else []


@pytest.mark.parametrize("subject", sorted({path.stem.split("_")[0] for path in files("bvh/*.bvh")}))
def test_bvh_files_lose_their_t_pose_and_at_most_the_frames_blended_with_it(subject: str) -> None:
    for path in files(f"bvh/{subject}_*.bvh"):
        clip = load_rig(path)
        motion, reference = drop_leading_tpose(clip)
        assert clip.fps == 60
        assert clip.frames == listed_frames()[path.stem] + 1
        if path.stem in NO_T_POSE:
            assert motion.frames == clip.frames
        else:
            assert 1 <= clip.frames - motion.frames <= 6, path.name
            assert reference is not None
            assert np.trace(reference[0]) > 2.99  # it stands straight, facing along +Z


@pytest.mark.parametrize("subject", sorted({path.stem.split("_")[0] for path in files("amc/*.amc")}))
def test_amc_files_read_whole_with_the_rate_of_the_index(subject: str) -> None:
    for path in files(f"amc/{subject}_*.amc"):
        clip = load_rig(path)
        assert (clip.frames, clip.fps) == (listed_frames()[path.stem], 60), path.name
        assert drop_leading_tpose(clip)[0] is clip


def test_locomotion_files_keep_every_frame() -> None:
    frames = {"run_turns": 5562, "tpose": 1, "walk_run_short": 1794, "walk_run_turns": 5877}
    for name, count in frames.items():
        clip = load_rig(MOCAP / "locomotion" / f"jl_{name}.bvh")
        assert (clip.frames, clip.fps) == (count, 60)
        assert drop_leading_tpose(clip)[0] is clip


def test_subjects_without_a_skeleton_share_one_stand_in() -> None:
    chosen = {find_asf(path).path.stem for s in ("13", "88", "90", "91") for path in files(f"amc/{s}_*.amc")}
    assert len(chosen) == 1


CM_PER_UNIT = 2.54 / 0.45


def test_amc_and_bvh_of_one_subject_agree_in_bones_height_floor_and_side() -> None:
    walks = {
        "bvh": (CMU / "bvh" / "16_15.bvh", "Hips", ("UpLeg", "Leg", "Foot", "ToeBase"), ("Left", "Right")),
        "amc": (CMU / "amc" / "16_17.amc", "root", ("femur", "tibia", "foot", "toes"), ("l", "r")),
    }
    bones, root_height, floor = {}, {}, {}
    for kind, (path, root, (thigh, shin, foot, toe), (left, right)) in walks.items():
        clip, _ = drop_leading_tpose(load_rig(path))
        positions = clip.global_pose()[0] * CM_PER_UNIT
        at = {name: positions[:, j] for j, name in enumerate(clip.names)}
        chain = [f"{side}{bone}" for side in (left, right) for bone in (thigh, shin, foot, toe)]
        bones[kind] = [np.linalg.norm(clip.offsets[clip.names.index(name)]) for name in chain]
        root_height[kind] = np.median(at[root][:, 1])
        floor[kind] = np.quantile(np.minimum(at[left + toe][:, 1], at[right + toe][:, 1]), 0.05)
        facing = np.cross(at[left + thigh] - at[right + thigh], [0, 1, 0])  # left x up
        assert np.median((facing * (at[left + toe] - at[left + foot])).sum(-1)) > 0
        assert (at[root][-1] - at[root][0]) @ facing.mean(axis=0) > 0  # it walks the way it faces
    assert_allclose(bones["bvh"], bones["amc"], rtol=1e-3)
    assert 90 < root_height["amc"] < 105
    assert abs(root_height["bvh"] - root_height["amc"]) < 2
    assert abs(floor["bvh"]) < 5
    assert abs(floor["amc"]) < 5


@pytest.mark.parametrize("name", ["bvh/02_01.bvh", "bvh/13_13.bvh", "bvh/131_01.bvh", "amc/16_17.amc", "amc/91_01.amc"])
def test_loaded_walks_are_upright_people_on_the_floor(name: str, tmp_path: Path) -> None:
    motion = load_motion(CMU / name)
    positions = motion.positions()
    index = motion.skeleton.index
    head, toes = index("head"), [index("left_foot"), index("right_foot")]
    assert 1.3 < np.median(positions[:, head, 1]) < 1.8
    assert -0.1 < np.quantile(positions[:, toes, 1].min(axis=1), 0.05) < 0.1
    again = load_motion(motion.save(tmp_path / "again.bvh"))
    assert np.abs(again.positions() - positions).max() < 1e-3
