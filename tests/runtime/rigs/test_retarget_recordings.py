"""Retargeting of recorded motions, one walk or run of every rig in the shared data."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from motionrt.formats.acclaim.amc import read_amc
from motionrt.formats.bvh.read import read_bvh
from motionrt.formats.leading_pose import drop_leading_tpose
from motionrt.motion import SMPL24, Motion
from motionrt.rigs import RigClip
from motionrt.rigs.retarget_in import to_smpl24

DATA = Path(__file__).parents[3].parent / "shared" / "data" / "mocap"
RECORDINGS = {
    "cgspeed": (
        "cmu/bvh/02_01.bvh",
        ("LeftUpLeg", "LeftLeg", "LeftArm", "LeftForeArm", "LeftHand", "LeftFoot"),
    ),
    "daz": ("cmu/bvh/10_01.bvh", ("lThigh", "lShin", "lShldr", "lForeArm", "lHand", "lFoot")),
    "131": (
        "cmu/bvh/131_01.bvh",
        ("LeftHip", "LeftKnee", "LeftShoulder", "LeftElbow", "LeftWrist", "LeftAnkle"),
    ),
    "16": ("cmu/bvh/16_02.bvh", ("lfemur", "ltibia", "lhumerus", "lradius", "lwrist", "lfoot")),
    "amc": ("cmu/amc/16_11.amc", ("lfemur", "ltibia", "lhumerus", "lradius", "lwrist", "lfoot")),
    "hip_knee": (
        "locomotion/jl_run_turns.bvh",
        ("LeftHip", "LeftKnee", "LeftShoulder", "LeftElbow", "LeftWrist", "LeftAnkle"),
    ),
    "unity": (
        "locomotion/jl_walk_run_short.bvh",
        ("LeftUpperLeg", "LeftLowerLeg", "LeftUpperArm", "LeftLowerArm", "LeftHand", "LeftFoot"),
    ),
}
BONES = (
    ("hip", "knee", 0, 1),
    ("knee", "ankle", 1, 5),
    ("shoulder", "elbow", 2, 3),
    ("elbow", "wrist", 3, 4),
)


@cache
def recording(rig: str) -> tuple[RigClip, Motion]:
    path = DATA / RECORDINGS[rig][0]
    if not path.exists():
        pytest.skip(f"the shared recordings are not here: {path}")
    if path.suffix == ".amc":
        clip = read_amc(path, DATA / "cmu" / "asf" / f"{path.stem.split('_')[0]}.asf", fps=60)
        return clip, to_smpl24(clip)
    clip, reference = drop_leading_tpose(read_bvh(path))
    return clip, to_smpl24(clip, reference=reference)


def at(motion: Motion, name: str) -> npt.NDArray[np.float32]:
    return motion.positions()[:, SMPL24.index(name)]


def unit(vectors: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


@pytest.mark.parametrize("rig", [rig for rig in RECORDINGS if rig != "daz"])  # its rest pose is bent: see below
def test_limbs_point_where_they_did(rig: str) -> None:
    clip, motion = recording(rig)
    positions, _ = clip.global_pose()
    joints = [clip.names.index(name) for name in RECORDINGS[rig][1]]
    for upper, lower, i, j in BONES:
        source = unit(positions[:, joints[j]] - positions[:, joints[i]])
        found = unit(at(motion, f"left_{lower}") - at(motion, f"left_{upper}"))
        assert np.rad2deg(np.arccos(np.clip((source * found).sum(-1), -1, 1))).max() < 0.5


@pytest.mark.parametrize("rig", RECORDINGS)
def test_the_figure_stands_on_the_floor_at_human_height(rig: str) -> None:
    _, motion = recording(rig)
    toes = np.minimum(at(motion, "left_foot")[:, 1], at(motion, "right_foot")[:, 1])
    assert abs(np.median(toes)) < 0.05
    assert np.percentile(toes, 2) > -0.07
    assert 1.3 < np.median(at(motion, "head")[:, 1]) < 1.75


@pytest.mark.parametrize("rig", [rig for rig in RECORDINGS if rig not in ("131", "16")])  # a dance, jumps on the spot
def test_it_goes_forward(rig: str) -> None:
    _, motion = recording(rig)
    across = at(motion, "left_hip") - at(motion, "right_hip")
    forward = unit(np.cross(across, np.array([0, 1, 0], np.float32)))
    step = np.gradient(motion.root, axis=0)
    assert (step * forward).sum() > 0.6 * np.linalg.norm(step[:, [0, 2]], axis=-1).sum()


@pytest.mark.parametrize("rig", RECORDINGS)
def test_toes_point_forward_and_knees_bend_backward(rig: str) -> None:
    _, motion = recording(rig)
    across = at(motion, "left_hip") - at(motion, "right_hip")
    forward = unit(np.cross(across, np.array([0, 1, 0], np.float32)))
    for side in ("left", "right"):
        toes = unit(at(motion, f"{side}_foot") - at(motion, f"{side}_ankle"))
        assert (toes * forward).sum(-1).mean() > 0.5
        thigh = unit(at(motion, f"{side}_knee") - at(motion, f"{side}_hip"))
        shank = unit(at(motion, f"{side}_ankle") - at(motion, f"{side}_knee"))
        assert (np.cross(thigh, shank) * across).sum(-1).mean() > 0


@pytest.mark.parametrize("rig", RECORDINGS)
def test_trunk_and_head_stay_upright_and_face_forward(rig: str) -> None:
    _, motion = recording(rig)
    across = at(motion, "left_hip") - at(motion, "right_hip")
    forward = unit(np.cross(across, np.array([0, 1, 0], np.float32)))
    for name in ("pelvis", "spine3", "head"):
        turned = motion.global_rotations()[:, SMPL24.index(name)]
        assert np.median(turned[:, 1, 1]) > np.cos(np.deg2rad(35))
        assert np.median((turned[:, :, 2] * forward).sum(-1)) > np.cos(np.deg2rad(35))


@pytest.mark.parametrize("rig", RECORDINGS)
def test_soles_are_level_while_feet_rest(rig: str) -> None:
    _, motion = recording(rig)
    for side in ("left", "right"):
        foot = at(motion, f"{side}_foot")
        speed = np.linalg.norm(np.gradient(foot, axis=0), axis=-1) * motion.fps
        resting = (speed < 0.15) & (foot[:, 1] < np.percentile(foot[:, 1], 5) + 0.03)
        assert resting.any()
        level = motion.global_rotations()[resting][:, SMPL24.index(f"{side}_ankle"), 1, 1]
        assert np.rad2deg(np.arccos(np.clip(np.median(level), -1, 1))) < 15


@pytest.mark.parametrize("rig", RECORDINGS)
def test_joints_that_are_hinges_stay_hinges(rig: str) -> None:
    _, motion = recording(rig)
    for name, axis in (("left_knee", 0), ("right_knee", 0), ("left_elbow", 1), ("right_elbow", 1)):
        turned = motion.rotations[:, SMPL24.index(name)]
        rest_axis = turned[:, axis, axis]
        assert np.median(rest_axis) > np.cos(np.deg2rad(35))


@pytest.mark.parametrize(
    ("trial", "skeleton", "centimetres"), [("02_01", "02", 6.0), ("11_01", "14", 9.0), ("14_21", "14", 9.0)]
)
def test_two_files_of_one_recording_agree(trial: str, skeleton: str, centimetres: float) -> None:
    """The same capture as BVH (two of the bent rest pose) and as AMC: bends and joints, seen from the pelvis."""
    amc, asf = DATA / "cmu" / "pairs" / f"{trial}.amc", DATA / "cmu" / "asf" / f"{trial.split('_', maxsplit=1)[0]}.asf"
    if not amc.exists():
        pytest.skip(f"the shared recordings are not here: {amc}")
    asf = asf if asf.exists() else asf.with_name(f"{skeleton}.asf")
    clip, reference = drop_leading_tpose(read_bvh(DATA / "cmu" / "bvh" / f"{trial}.bvh"))
    first = to_smpl24(clip, reference=reference).positions()
    second = to_smpl24(read_amc(amc, asf, fps=60)).positions()[-len(first) :]
    for line in (("left_hip", "left_knee", "left_ankle"), ("right_shoulder", "right_elbow", "right_wrist")):
        assert abs(np.median(bend(first, line) - bend(second, line))) < 4
    apart = np.linalg.norm((first - first[:, :1]) - (second - second[:, :1]), axis=-1)
    assert 100 * apart.mean(axis=0).max() < centimetres
    assert 100 * apart.mean() < 3


def bend(positions: npt.NDArray[np.float32], line: tuple[str, str, str]) -> npt.NDArray[np.float32]:
    top, middle, end = (positions[:, SMPL24.index(name)] for name in line)
    return np.degrees(np.arccos(np.clip((unit(middle - top) * unit(end - middle)).sum(-1), -1, 1)))
