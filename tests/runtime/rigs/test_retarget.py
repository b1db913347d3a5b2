"""Retargeting: the same person comes back whatever rig held the motion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from retarget_rigs import Z_UP, person, rig
from scipy.spatial.transform import Rotation

from motionrt.motion import SMPL24, Motion
from motionrt.rigs.clip import RigClip
from motionrt.rigs.retarget_in import to_smpl24

FOREIGN = {name: name.replace("left_", "L_").replace("right_", "R_") for name in SMPL24.names}


def distance(found: Motion, truth: Motion) -> float:
    """Largest joint error in metres, heights compared up to a constant (see the floor tests)."""
    error = found.positions() - truth.positions()
    error[..., 1] -= np.median(error[:, 0, 1])
    return float(np.linalg.norm(error, axis=-1).max())


def turned(motion: Motion, yaw: float) -> Motion:
    turn = Rotation.from_rotvec([0, yaw, 0]).as_matrix().astype(np.float32)
    rotations = motion.rotations.copy()
    rotations[:, 0] = turn @ rotations[:, 0]
    return replace(motion, rotations=rotations, root=motion.root @ turn.T)


@pytest.mark.parametrize("scale", [1.0, 100.0, 1 / 0.0254, 17.7])
@pytest.mark.parametrize("rest", ["t", "a", "spread"])
def test_a_known_rest_pose_gives_the_motion_back_exactly_in_any_unit(rest: str, scale: float) -> None:
    truth = person()
    found = to_smpl24(rig(truth, FOREIGN, rest=rest, scale=scale))
    assert distance(found, truth) < 1e-4
    np.testing.assert_allclose(found.rotations[:, :22], truth.rotations[:, :22], atol=2e-4)


@pytest.mark.parametrize("yaw", [np.pi / 2, np.pi, -0.7])
def test_a_rest_pose_may_face_any_way(yaw: float) -> None:
    truth = person()
    assert distance(to_smpl24(rig(truth, FOREIGN, rest_yaw=yaw)), truth) < 1e-3


@pytest.mark.parametrize("up", ["z", None])
def test_z_up_files_are_stood_on_their_feet(up: str | None) -> None:
    truth = person()
    assert distance(to_smpl24(rig(truth, FOREIGN, world=Z_UP, up=up, scale=100)), truth) < 1e-4


def test_a_z_up_world_is_seen_although_the_rest_pose_is_y_up() -> None:
    truth = person()
    clip = rig(truth, FOREIGN)
    rotations, translations = clip.rotations.copy(), clip.translations.copy()
    rotations[:, 0] = Z_UP.astype(np.float32) @ rotations[:, 0]
    translations[:, 0] = translations[:, 0] @ Z_UP.T
    found = to_smpl24(replace(clip, rotations=rotations, translations=translations.astype(np.float32)))
    assert distance(found, truth) < 1e-3


def test_someone_who_lies_down_is_left_lying() -> None:
    truth = person()
    flat = Rotation.from_rotvec([-np.pi / 2, 0, 0]).as_matrix().astype(np.float32)
    rotations = truth.rotations.copy()
    rotations[:, 0] = flat @ rotations[:, 0]
    root = truth.root @ flat.T + np.array([0, 0.15 - (truth.root @ flat.T)[:, 1].mean(), 3], np.float32)
    lying = replace(truth, rotations=rotations, root=root.astype(np.float32))
    assert distance(to_smpl24(rig(lying, FOREIGN)), lying) < 1e-3


@pytest.mark.parametrize("up", ["y", None])
def test_a_meaningless_rest_pose_is_calibrated_from_the_motion(up: str | None) -> None:
    truth = person(frames=120)
    found = to_smpl24(rig(truth, FOREIGN, rest="bones_up", up=up))
    limbs = [SMPL24.index(f"{s}_{p}") for s in ("left", "right") for p in ("hip", "knee", "ankle")]
    error = found.positions() - truth.positions()
    error[..., 1] -= np.median(error[:, 0, 1])
    assert np.linalg.norm(error[:, limbs], axis=-1).max() < 0.01
    assert np.linalg.norm(error, axis=-1).max() < 0.06
    turn = Rotation.from_matrix(np.swapaxes(found.global_rotations()[:, 0], 1, 2) @ truth.global_rotations()[:, 0])
    assert np.rad2deg(turn.magnitude().max()) < 3


def test_a_reference_pose_is_better_than_a_meaningless_rest_pose() -> None:
    truth = person()
    clip = rig(truth, FOREIGN, rest="bones_up")
    still = replace(truth[0:1], rotations=np.tile(np.eye(3, dtype=np.float32), (1, 24, 1, 1)))
    reference = rig(still, FOREIGN, rest="bones_up").rotations[0]
    assert distance(to_smpl24(clip, reference=reference), truth) < 1e-3


def test_a_reference_that_is_no_standing_pose_is_ignored() -> None:
    truth = person()
    clip = rig(truth, FOREIGN)
    crouch = clip.rotations[0].copy()
    for side in ("L", "R"):
        crouch[clip.names.index(f"{side}_hip")] = Rotation.from_rotvec([-2, 0, 0]).as_matrix()
    assert distance(to_smpl24(clip, reference=crouch), truth) < 1e-4


def test_proportions_may_differ_and_bones_keep_their_directions() -> None:
    truth = person()
    clip = rig(truth, FOREIGN)
    stretch = np.ones((len(clip.names), 1), np.float32)
    for joint, name in enumerate(clip.names):
        stretch[joint] = 1.3 if "knee" in name else 0.7 if "elbow" in name else 1.1
    longer = replace(
        clip,
        offsets=clip.offsets * stretch,
        translations=clip.translations * np.where(clip.offsets.any(-1, keepdims=True), stretch, 1),
    )
    found = to_smpl24(longer)
    for upper, lower in (
        ("left_hip", "left_knee"),
        ("right_knee", "right_ankle"),
        ("left_shoulder", "left_elbow"),
    ):
        i, j = SMPL24.index(upper), SMPL24.index(lower)
        a, b = (m.positions()[:, j] - m.positions()[:, i] for m in (found, truth))
        cosine = (a * b).sum(-1) / np.linalg.norm(a, axis=-1) / np.linalg.norm(b, axis=-1)
        assert np.rad2deg(np.arccos(np.clip(cosine, -1, 1))).max() < 0.2


def test_helper_joints_inside_limbs_do_not_matter() -> None:
    truth = person()
    clip = with_twist_bones(rig(truth, FOREIGN))
    assert distance(to_smpl24(clip), truth) < 1e-4


def with_twist_bones(clip: RigClip) -> RigClip:
    """A joint called ``<name>_twist`` in the middle of each forearm and thigh."""
    names, parents, offsets = list(clip.names), list(clip.parents), list(clip.offsets)
    rotations, translations = (
        list(np.moveaxis(clip.rotations, 1, 0)),
        list(np.moveaxis(clip.translations, 1, 0)),
    )
    for name in ("L_knee", "R_knee", "L_wrist", "R_wrist"):
        joint = names.index(name)
        for values in (offsets, translations):
            values.insert(joint, values[joint] / 2)
            values[joint + 1] = values[joint + 1] / 2
        rotations.insert(joint, np.broadcast_to(np.eye(3, dtype=np.float32), rotations[joint].shape))
        names.insert(joint, f"{name}_twist")
        parents = [p + 1 if p >= joint else p for p in parents]
        parents.insert(joint, parents[joint])
        parents[joint + 1] = joint
    return replace(
        clip,
        names=tuple(names),
        parents=tuple(parents),
        offsets=np.array(offsets),
        rotations=np.stack(rotations, axis=1),
        translations=np.stack(translations, axis=1),
    )


def test_sides_are_exchanged_where_the_body_contradicts_the_names() -> None:
    truth = person()
    swapped = {a: FOREIGN[SMPL24.names[b]] for a, b in zip(SMPL24.names, SMPL24.mirrored_joints, strict=True)}
    assert distance(to_smpl24(rig(truth, swapped)), truth) < 1e-4


def test_own_skeleton_comes_back_untouched() -> None:
    truth = turned(person(), 1.0)
    raised = replace(truth, root=truth.root + np.array([0, 0.04, 0], np.float32))
    found = to_smpl24(rig(raised, scale=100))
    np.testing.assert_allclose(found.root, raised.root, atol=1e-5)
    np.testing.assert_allclose(found.rotations, raised.rotations, atol=1e-6)


@pytest.mark.parametrize("below", [-0.9, -0.05, 0.03])
def test_feet_that_rest_near_or_under_the_floor_are_put_on_it(below: float) -> None:
    truth = person()
    moved = replace(truth, root=truth.root + np.array([0, below, 0], np.float32))
    found = to_smpl24(rig(moved, FOREIGN))
    assert abs(np.percentile(found.positions()[:, [10, 11], 1].min(axis=1), 20)) < 0.02


def test_feet_well_above_the_floor_stay_there() -> None:
    truth = person()
    ladder = replace(truth, root=truth.root + np.array([0, 1.0, 0], np.float32))
    found = to_smpl24(rig(ladder, FOREIGN))
    assert abs(np.median(found.root[:, 1] - ladder.root[:, 1])) < 1e-3


def test_flat_feet_stay_flat_whatever_the_shape_of_the_rigs_foot() -> None:
    truth = person()
    clip = rig(truth, FOREIGN)
    offsets, translations = clip.offsets.copy(), clip.translations.copy()
    for name in ("L_foot", "R_foot"):
        offsets[clip.names.index(name)] = (0, -0.02, 0.2)
        translations[:, clip.names.index(name)] = (0, -0.02, 0.2)
    found = to_smpl24(replace(clip, offsets=offsets, translations=translations))
    for name in ("left_ankle", "right_ankle"):
        sole = found.global_rotations()[:, SMPL24.index(name), :, 1]
        expected = truth.global_rotations()[:, SMPL24.index(name), :, 1]
        np.testing.assert_allclose(sole, expected, atol=1e-3)


def test_a_foot_rolled_onto_its_back_by_the_solver_is_turned_over() -> None:
    truth = person()
    clip = rig(truth, FOREIGN)
    ankle, toe = clip.names.index("L_ankle"), clip.names.index("L_foot")
    bone = clip.offsets[toe] / np.linalg.norm(clip.offsets[toe])
    rotations = clip.rotations.copy()
    rotations[10:20, ankle] = rotations[10:20, ankle] @ Rotation.from_rotvec(np.pi * bone).as_matrix().astype(
        np.float32
    )
    assert distance(to_smpl24(replace(clip, rotations=rotations)), truth) < 1e-3


def test_a_head_upside_down_follows_the_neck() -> None:
    truth = person()
    clip = rig(truth, FOREIGN)
    rotations = clip.rotations.copy()
    rotations[5:9, clip.names.index("head")] = np.diag([-1, -1, 1])
    found = to_smpl24(replace(clip, rotations=rotations))
    np.testing.assert_allclose(found.rotations[5:9, SMPL24.index("head")], np.tile(np.eye(3), (4, 1, 1)), atol=1e-5)
    np.testing.assert_allclose(found.rotations[20:, 15], truth.rotations[20:, 15], atol=1e-4)


def test_elbow_axes_are_made_the_same_for_every_rig() -> None:
    """A T-pose whose upper arms and forearms are turned by 30 degrees about their length, as CMU's are."""
    truth = person()
    rotations = truth.rotations.copy()
    for side in ("left", "right"):
        shoulder, elbow, wrist = (SMPL24.index(f"{side}_{part}") for part in ("shoulder", "elbow", "wrist"))
        twist = Rotation.from_rotvec([np.deg2rad(30), 0, 0]).as_matrix().astype(np.float32)
        rotations[:, shoulder] = rotations[:, shoulder] @ twist
        rotations[:, elbow] = twist.T @ rotations[:, elbow] @ twist
        rotations[:, wrist] = twist.T @ rotations[:, wrist]
    found = to_smpl24(rig(replace(truth, rotations=rotations), FOREIGN))
    np.testing.assert_allclose(found.rotations[:, 16:22], truth.rotations[:, 16:22], atol=2e-3)
