"""What cannot be retargeted says what is missing and what to do."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from retarget_rigs import person, rig

from motionrt.errors import MotionRTError, RigError
from motionrt.motion import SMPL24
from motionrt.rigs import RigClip
from motionrt.rigs.retarget_in import to_smpl24

NAMES = {name: name.replace("left_", "L_").replace("right_", "R_") for name in SMPL24.names}
NONSENSE = {name: f"q{joint}" for joint, name in enumerate(SMPL24.names)}


def chain(joints: int) -> RigClip:
    offsets = np.tile(np.array([0, 1, 0], np.float32), (joints, 1))
    return RigClip(
        names=tuple(f"b{i}" for i in range(joints)),
        parents=tuple(range(-1, joints - 1)),
        offsets=offsets,
        rotations=np.tile(np.eye(3, dtype=np.float32), (4, joints, 1, 1)),
        translations=np.tile(offsets, (4, 1, 1)),
        fps=30,
    )


def test_a_chain_is_no_humanoid() -> None:
    with pytest.raises(RigError, match=r"no pair of like limbs.*mapping="):
        to_smpl24(chain(12))


def test_one_joint_is_no_humanoid() -> None:
    with pytest.raises(RigError, match="humanoid"):
        to_smpl24(chain(1))


def test_missing_legs_are_named() -> None:
    names = {joint: name for joint, name in NAMES.items() if not joint.endswith(("hip", "knee", "ankle", "foot"))}
    with pytest.raises(RigError, match=r"left_hip, right_hip, left_knee.*mapping="):
        to_smpl24(rig(person(4), names))


def test_a_missing_elbow_is_named() -> None:
    names = {joint: name for joint, name in NAMES.items() if joint != "left_elbow"}
    with pytest.raises(RigError, match=r"joint for left_elbow;.*mapping="):
        to_smpl24(rig(person(4), names))


def test_two_claims_on_one_role_are_an_error_that_names_both() -> None:
    clip = rig(person(4), NAMES)
    names = tuple("L_knee" if name == "R_ankle" else name for name in clip.names)
    with pytest.raises(RigError, match=r"several joints could be left_knee: 'L_knee', 'L_knee'.*mapping="):
        to_smpl24(replace(clip, names=names))


def test_the_users_mapping_is_believed() -> None:
    truth = person(30)
    clip = rig(truth, NONSENSE)
    mapping = {name: NONSENSE[name] for name in SMPL24.names}
    gap = to_smpl24(clip, mapping=mapping).positions() - truth.positions()
    gap[..., 1] -= np.median(gap[:, 0, 1])
    assert np.linalg.norm(gap, axis=-1).max() < 1e-3


def test_a_partial_mapping_is_completed() -> None:
    truth = person(30)
    names = NAMES | {"left_elbow": "Gelenk", "right_knee": "Knie"}
    found = to_smpl24(rig(truth, names), mapping={"left_elbow": "Gelenk", "right_knee": "Knie"})
    gap = found.positions() - truth.positions()
    gap[..., 1] -= np.median(gap[:, 0, 1])
    assert np.linalg.norm(gap, axis=-1).max() < 1e-3


def test_a_mapping_settles_two_claims() -> None:
    clip = rig(person(4), NAMES)
    names = tuple("L_knee_b" if name == "R_hand" else name for name in clip.names)
    assert to_smpl24(replace(clip, names=names), mapping={"left_knee": "L_knee"}).frames == 4


def test_a_mapping_to_an_unknown_rig_joint_lists_near_names() -> None:
    with pytest.raises(RigError, match=r"the mapping of left_knee: the rig has no joint 'L_kne'; it has L_knee"):
        to_smpl24(rig(person(4), NAMES), mapping={"left_knee": "L_kne"})


def test_a_mapping_of_an_unknown_role_lists_the_roles() -> None:
    with pytest.raises(RigError, match=r"names 'LeftKnee', no joint of smpl24.*; there are: pelvis, left_hip"):
        to_smpl24(rig(person(4), NAMES), mapping={"LeftKnee": "L_knee"})


def test_legs_without_length_are_an_error() -> None:
    clip = rig(person(4), NAMES)
    flat = np.array([0 if "knee" in name or "ankle" in name else 1 for name in clip.names])[:, None]
    squashed = replace(clip, offsets=clip.offsets * flat, translations=clip.translations * flat.astype(np.float32))
    with pytest.raises(RigError, match="no length"):
        to_smpl24(squashed)


def test_positions_that_are_not_finite_are_an_error() -> None:
    clip = rig(person(4), NAMES)
    translations = clip.translations.copy()
    translations[2, 0, 0] = np.nan
    with pytest.raises(RigError, match="not finite"):
        to_smpl24(replace(clip, translations=translations))


def test_a_rig_error_is_a_value_error() -> None:
    assert issubclass(RigError, MotionRTError)
    assert issubclass(RigError, ValueError)


@pytest.mark.parametrize("side", ["left", "right"])
def test_one_mapped_joint_settles_the_sides_of_a_nameless_rig(side: str) -> None:
    """Straight legs and no feet: the body does not show its sides."""
    still = person(4)
    rotations = np.tile(np.eye(3, dtype=np.float32), (4, 24, 1, 1))
    footless = {name: label for name, label in NONSENSE.items() if not name.endswith("_foot")}
    clip = rig(replace(still, rotations=rotations), footless)
    with pytest.raises(RigError, match=r"left and right .* mapping=\{'left_hip'"):
        to_smpl24(clip)
    found = to_smpl24(clip, mapping={f"{side}_wrist": NONSENSE[f"{side}_wrist"]})
    assert (found.positions()[:, SMPL24.index("left_hip"), 0] > found.root[:, 0]).all()


def test_one_joint_in_two_roles_is_an_error() -> None:
    clip = rig(person(4), NAMES)
    both = {f"{side}_{part}": f"L_{part}" for side in ("left", "right") for part in ("hip", "knee", "ankle")}
    with pytest.raises(RigError, match=r"right_hip.*mapping="):
        to_smpl24(clip, mapping=both)
