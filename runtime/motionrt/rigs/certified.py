"""The mapping of a rig with its certificate, as plain values: for programs that put motions on it by themselves."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from motionrt.motion.rotations import Array, matrix_to_quaternion
from motionrt.rigs.build import read_build
from motionrt.rigs.certify import Certificate, certify
from motionrt.rigs.kinds import rig_kind
from motionrt.rigs.stance import read_stance
from motionrt.rigs.target import Rig

_MEASURES = ("hands_cm", "feet_cm", "limbs", "twist", "ground_cm", "flips")


def certified_mapping(rig: Rig, *, mapping: Mapping[str, str] | None = None) -> dict[str, Any]:
    """What another program needs to turn the joints of ``rig``, and how well motionrt's own retargeting does it.

    With ``R`` the global rotation of a joint of ``smpl24``, the joint of the rig has the global rotation
    ``to_world^-1 R alignment^-1`` in the file's axes. Joints of ``spine`` and ``neck`` share the turns of those of
    ``smpl24`` evenly; what else has no role keeps its rotation against its parent.

    Returns:
        Plain values for JSON. ``mapping``: ``smpl24`` joint name -> joint name; ``spine``, ``neck``: joint names from
        below; ``alignments``: joint name -> quaternion xyzw; ``to_world``: xyzw, from the file's axes to Y up;
        ``units_per_metre``; ``kind``; ``certified``; ``worst``: the largest figure of all probes, as in
        :class:`motionrt.rigs.certify.ProbeResult`.

    Raises:
        RigError: the rig cannot be retargeted to at all; the message says why.
    """
    result, clip = certify(rig, mapping=mapping), rig.clip
    stance = read_stance(clip, {**clip.known, **(mapping or {})} or None, rig.poses)
    local = clip.rest_rotations() if stance.local is None else stance.local
    roles = stance.roles
    return {
        "kind": rig_kind(clip.names),
        "certified": result.passes,
        "worst": _worst(result),
        "hip_height": result.hip_height,
        "units_per_metre": read_build(clip, stance, local).units,
        "to_world": _xyzw(stance.to_world),
        "mapping": dict(result.mapping),
        "spine": [clip.names[joint] for joint in roles.spine],
        "neck": [clip.names[joint] for joint in roles.neck],
        "alignments": {clip.names[joint]: _xyzw(turn) for joint, turn in stance.alignments.items()},
    }


def _worst(result: Certificate) -> dict[str, float]:
    return {name: max(getattr(probe, name) for probe in result.probes) for name in _MEASURES}


def _xyzw(rotation: Array) -> list[float]:
    w, x, y, z = (round(float(number), 9) for number in matrix_to_quaternion(rotation))
    return [x, y, z, w]
