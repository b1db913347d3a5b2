"""Rigs of the usual tools and databases: read as the motion that they play, and certified as characters."""

from __future__ import annotations

from pathlib import Path

import pytest
from limb_check import furthest, limbs, places_of
from rig_kinds import KINDS, PERSON

from motionrt.formats import load_motion, load_target
from motionrt.rigs.certify import certify
from motionrt.rigs.kinds import rig_kind


@pytest.mark.parametrize("kind", KINDS)
def test_a_kind_of_rig_reads_as_the_motion_that_it_plays(kind: str, tmp_path: Path) -> None:
    found = load_motion(KINDS[kind].write(tmp_path))
    assert furthest(limbs(places_of(found)), limbs(places_of(PERSON))) < 1.0


@pytest.mark.parametrize("kind", KINDS)
def test_a_kind_of_rig_is_certified(kind: str, tmp_path: Path) -> None:
    result = certify(load_target(KINDS[kind].write(tmp_path)))
    assert result.passes, [probe for probe in result.probes if not probe.passes]
    assert 0.95 < result.hip_height < 1.05
    names = KINDS[kind].names()
    limbs_of = {
        names[f"{side}_{part}"] for side in ("left", "right") for part in ("hip", "knee", "shoulder", "elbow", "wrist")
    }
    assert limbs_of <= set(result.driven)


@pytest.mark.parametrize(
    ("kind", "called"),
    [
        ("Unity, VRM", "VRoid / VRM"),
        ("Unreal 5 Mannequin", "Unreal Mannequin"),
        ("100STYLE", "LeftHip / LeftKnee names"),
    ]
    + [(kind, kind) for kind in ("Mixamo", "Rigify", "Auto-Rig Pro", "Daz", "MakeHuman", "MMD", "Xsens", "KayKit")],
)
def test_a_kind_of_rig_is_called_by_its_name(kind: str, called: str) -> None:
    assert rig_kind(KINDS[kind].clip().names) == called
