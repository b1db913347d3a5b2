"""Certification of a rig: probe motions are put on it, and what comes out is measured by plain forward kinematics.

Nothing here shares code with the retargeting but the names of the joints: limbs are compared with those of the probe as
directions, hands and feet where the rig's own bones would have them if they pointed exactly so.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from motionrt.motion.motion import Motion
from motionrt.motion.rotations import Array
from motionrt.motion.skeleton import SMPL24
from motionrt.rigs.mapping import draft_mapping
from motionrt.rigs.plain_kinematics import angles_between
from motionrt.rigs.played import Played, played_on
from motionrt.rigs.probes import probe_motions
from motionrt.rigs.target import Rig
from motionrt.rigs.twists import twists

POSITION_GATE_CM, ANGLE_GATE = 2.0, 5.0
_FLIP = 60.0
_STANDS = 0.4
"""Metres: toes below this height are put where those of the motion are, whatever that takes of the legs."""

_LEGS, _ARMS = ("hip", "knee", "ankle"), ("shoulder", "elbow", "wrist")
_SIDES = ("left", "right")


@dataclass(frozen=True)
class ProbeResult:
    """One probe motion on the rig; centimetres at human size, degrees, 95th percentiles over frames.

    Attributes:
        hands_cm: distance of the wrists from where the rig's bones in the probe's directions end.
        feet_cm: distance of toes near the floor from those of the probe; of ankles higher up the same as of the wrists.
        limbs: angle between limbs; of legs only where the foot is not near the floor.
        twist: turn of limbs about their own length against the probe, what is constant left out; of bent legs whose
            foot is near the floor, of the knee's hinge against its bend, and of where it points against the probe's.
        ground_cm: how far the lower toe is from where it stands at rest, while that of the probe is on the floor.
        flips: steps in which a driven joint turns by more than 60 degrees further than any joint of the probe.
    """

    name: str
    hands_cm: float
    feet_cm: float
    limbs: float
    twist: float
    ground_cm: float
    flips: int

    @property
    def passes(self) -> bool:
        """Whether all gates are kept."""
        centimetres = max(self.hands_cm, self.feet_cm, self.ground_cm)
        return centimetres <= POSITION_GATE_CM and max(self.limbs, self.twist) <= ANGLE_GATE and not self.flips


@dataclass(frozen=True)
class Certificate:
    """The result for a rig.

    Attributes:
        probes: results of all probe motions.
        hip_height: of the standing rig, as a share of that of the probe.
        sides: whether the left arm of the rig moved, and the right one did not, when that of the probe did.
        driven, still: joint names that were, or were not, moved.
        mapping: ``smpl24`` joint name -> joint name.
    """

    probes: tuple[ProbeResult, ...]
    hip_height: float
    sides: bool
    driven: tuple[str, ...]
    still: tuple[str, ...]
    mapping: Mapping[str, str] = field(default_factory=dict)

    @property
    def passes(self) -> bool:
        """Whether all gates are kept."""
        return self.sides and all(probe.passes for probe in self.probes)


def certify(rig: Rig, *, mapping: Mapping[str, str] | None = None) -> Certificate:
    """Put the probe motions on ``rig`` and measure.

    Raises:
        RigError: the rig cannot be retargeted to at all; the message says why.
    """
    given = {**rig.clip.known, **(mapping or {})} or None
    roles = draft_mapping(rig.clip, given)
    motions = probe_motions()
    played = {name: played_on(motion, rig, given, roles) for name, motion in motions.items()}
    results = tuple(_measured(name, motions[name], played[name]) for name in motions)
    moved = np.max([np.abs(np.diff(one.rotations, axis=0)).max(axis=(0, 2, 3)) for one in played.values()], axis=0)
    names = [(name, bool(move > 1e-4)) for name, move in zip(rig.clip.names, moved, strict=True)]
    stand = played["stand"]
    return Certificate(
        probes=results,
        hip_height=round(_hip_height(stand) / _source_hip_height(motions["stand"]), 3),
        sides=_left_is_left(played["left arm alone"]),
        driven=tuple(name for name, moves in names if moves),
        still=tuple(name for name, moves in names if not moves and not name.endswith("_end")),
        mapping=roles,
    )


def _measured(name: str, motion: Motion, played: Played) -> ProbeResult:
    source = motion.positions().astype(np.float64)
    ends = {line[-1]: _end_errors(source, played, line) for line in (_ARMS, _LEGS)}
    legs = np.where(_standing(source, played), 0.0, _limb_angles(source, played, _LEGS))
    limbs = np.concatenate([_limb_angles(source, played, _ARMS), legs])
    return ProbeResult(
        name=name,
        hands_cm=_worst(100 * ends["wrist"]),
        feet_cm=_worst(100 * _feet(ends["ankle"], source, played)),
        limbs=_worst(limbs),
        twist=_worst(twists(motion, played, _standing(source, played))),
        ground_cm=_worst(100 * _ground(source, played)),
        flips=_flips(motion, played),
    )


def _worst(values: Array) -> float:
    """The 95th percentile over frames of the worst of the rows."""
    return round(float(np.percentile(values, 95, axis=-1).max()), 2) if values.size else 0.0


def _source_bone(source: Array, upper: str, lower: str) -> Array:
    return np.asarray(source[:, SMPL24.index(lower)] - source[:, SMPL24.index(upper)])


def _limb_angles(source: Array, played: Played, line: tuple[str, str, str]) -> Array:
    rows = [
        angles_between(_source_bone(source, f"{s}_{a}", f"{s}_{b}"), played.bone(f"{s}_{a}", f"{s}_{b}"))
        for s in _SIDES
        for a, b in ((line[0], line[1]), (line[1], line[2]))
    ]
    return np.stack(rows)


def _standing(source: Array, played: Played) -> npt.NDArray[np.bool_]:
    """``(4, F)``: whether the foot of each leg bone is near the floor, where it is put by bending the leg."""
    if "left_foot" not in played.roles:
        return np.zeros((4, 1), dtype=bool)
    low = [source[:, SMPL24.index(f"{side}_foot"), 1] < _STANDS for side in _SIDES]
    return np.repeat(low, 2, axis=0)


def _end_errors(source: Array, played: Played, line: tuple[str, str, str]) -> Array:
    """Distances ``(2, F)`` of wrists or ankles from where the rig's bones would end in the source's directions."""
    rows = []
    for side in _SIDES:
        miss = np.zeros(source.shape[::2])
        for upper, lower in ((f"{side}_{line[0]}", f"{side}_{line[1]}"), (f"{side}_{line[1]}", f"{side}_{line[2]}")):
            ours, theirs = _source_bone(source, upper, lower), played.bone(upper, lower)
            length = np.linalg.norm(theirs, axis=-1, keepdims=True)
            miss = miss + theirs - ours / np.linalg.norm(ours, axis=-1, keepdims=True) * length
        rows.append(np.linalg.norm(miss, axis=-1))
    return np.stack(rows)


def _feet(errors: Array, source: Array, played: Played) -> Array:
    """Distances ``(2, F)`` of toes near the floor from those of the source, of ankles high up as in ``errors``."""
    if "left_foot" not in played.roles:
        return errors
    rows = []
    for side, error in zip(_SIDES, errors, strict=True):
        toe = source[:, SMPL24.index(f"{side}_foot")]
        found = played.places[:, played.roles[f"{side}_foot"]] - [0, played.sole, 0]
        rows.append(np.where(toe[:, 1] < _STANDS, np.linalg.norm(found - toe, axis=-1), error))
    return np.stack(rows)


def _ground(source: Array, played: Played) -> Array:
    if "left_foot" not in played.roles:
        return np.zeros((0, 1))
    toes = np.min([source[:, SMPL24.index(f"{side}_foot"), 1] for side in _SIDES], axis=0)
    found = np.min([played.places[:, played.roles[f"{side}_foot"], 1] for side in _SIDES], axis=0)
    return np.asarray(np.abs(found - played.sole - toes)[None])


def _flips(motion: Motion, played: Played) -> int:
    ours = _steps(motion.rotations.astype(np.float64)).max(axis=1)
    return int((_steps(played.rotations).max(axis=1) > ours + _FLIP).sum())


def _steps(rotations: Array) -> Array:
    """Angles ``(F - 1, J)`` in degrees from frame to frame."""
    trace = (rotations[1:] * rotations[:-1]).sum(axis=(-2, -1))
    return np.asarray(np.degrees(np.arccos(np.clip((trace - 1) / 2, -1, 1))))


def _hip_height(played: Played) -> float:
    hips = 0.5 * (played.places[:, played.roles["left_hip"], 1] + played.places[:, played.roles["right_hip"], 1])
    return float(np.median(hips))


def _source_hip_height(motion: Motion) -> float:
    places = motion.positions()[:, [SMPL24.index("left_hip"), SMPL24.index("right_hip")], 1]
    return float(np.median(places))


def _left_is_left(played: Played) -> bool:
    reach = [float(np.ptp(played.places[:, played.roles[f"{side}_wrist"], 1])) for side in _SIDES]
    return reach[0] > 0.3 and reach[1] < 0.1 * reach[0]
