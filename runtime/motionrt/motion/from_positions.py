"""From joint positions to a ``smpl24`` motion: rotations without twist, bones of exact length.

The pelvis and the chest (spine3) have three children, whose places fix their rotation. Every other bone turns the
shortest way from where its parent carries it to where it points, so that no twist of a rig or of a model enters. Arms
and legs then reach the given wrists and ankles as two bones each, bent in the plane of the given elbow or knee.
"""

from __future__ import annotations

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.motion.batches import by_batches
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import Array, lengths, normalise, rotation_between
from motionrt.motion.skeleton import SMPL22_JOINTS, SMPL24

_PARENTS = list(SMPL24.parents)
_OFFSETS = SMPL24.offsets.astype(np.float64)
_LENGTHS = lengths(_OFFSETS)
_SIDES = ("left", "right")


def _joints(*names: str) -> list[int]:
    """Indices of joints; names without a side stand for both sides."""
    known = [[name] if name in SMPL24.names else [f"{side}_{name}" for side in _SIDES] for name in names]
    return [SMPL24.index(name) for pair in known for name in pair]


_CHEST = SMPL24.index("spine3")
_OUTER = {0: SMPL24.index("left_hip"), _CHEST: SMPL24.index("left_collar")}
_MIDDLE = {0: SMPL24.index("spine1"), _CHEST: SMPL24.index("neck")}
_STARTS, _MIDDLES, _ENDS = _joints("hip", "shoulder"), _joints("knee", "elbow"), _joints("ankle", "wrist")
_LIMBS = (_STARTS, _MIDDLES), (_MIDDLES, _ENDS), (_ENDS, _joints("foot", "hand"))
_SPINE = (_joints("spine1"), _joints("spine2")), (_joints("spine2"), _joints("spine3"))
_NECK = _joints("neck", "collar"), _joints("head", "shoulder")
_CORRECTED_FROM, _CORRECTED_FULLY = 1e-3, 3e-3  # metres that an end may miss its place before a limb bends for it
_BENDS = np.array([1.0, 1, -1, -1])[:, None]  # knees bend forwards, elbows backwards, where the given limb is straight
_HINT = 1e-3  # metres, the weight of that


def from_positions(joints: Array, fps: float) -> Motion:
    """The ``smpl24`` motion whose joints stand at ``joints``: the inverse of its forward kinematics.

    For positions with the bone lengths of ``smpl24`` every joint is met. For others the pelvis is met, wrists and
    ankles are met within 3 mm as far as arms and legs reach, and the rest keeps its directions.

    Args:
        joints: ``(F, 22 or 24, 3)`` metres, Y up, in the order of ``smpl24``; without hands, they follow the wrists.
        fps: frames per second.

    Raises:
        InvalidInputError: another shape, no frames, or numbers that are not finite.
    """
    given = checked_joints(joints)
    known = given.shape[1]
    pointing = np.zeros((len(given), len(SMPL24), 3))
    pointing[:, 1:known] = normalise(given[:, 1:] - given[:, _PARENTS[1:known]])
    local = np.tile(np.eye(3), (len(given), len(SMPL24), 1, 1))
    turned = local.copy()
    _turn_trunk(local, turned, pointing)
    _bend_limbs(pointing, turned, given)
    for limbs, children in _LIMBS:
        _carry(local, turned, pointing, limbs, children)
    return Motion(_told(local).astype(np.float32), given[:, 0].astype(np.float32), fps)


def checked_joints(joints: Array) -> Array:
    """``joints`` as float64 ``(F, 22 or 24, 3)``.

    Raises:
        InvalidInputError: another shape, no frames, or numbers that are not finite.
    """
    given = np.asarray(joints)
    if given.ndim != 3 or given.shape[1] not in (SMPL22_JOINTS, len(SMPL24)) or given.shape[2] != 3 or not len(given):
        raise InvalidInputError(f"joint positions must have the shape (frames >= 1, 22 or 24, 3), not {given.shape}")
    given = by_batches(lambda part: part.astype(np.float64), given)
    if not by_batches(lambda part: np.isfinite(part).all(axis=(1, 2)), given).all():
        raise InvalidInputError("joint positions hold a number that is not finite")
    return given


def _turn_trunk(local: Array, turned: Array, pointing: Array) -> None:
    """Local and global rotations of pelvis, spine, chest, neck and collars, in place."""
    local[:, 0] = turned[:, 0] = _fitted(pointing, 0)
    for joint, child in _SPINE:
        _carry(local, turned, pointing, joint, child)
    turned[:, _CHEST] = _fitted(pointing, _CHEST)
    local[:, _CHEST] = np.swapaxes(turned[:, _PARENTS[_CHEST]], -1, -2) @ turned[:, _CHEST]
    _carry(local, turned, pointing, *_NECK)


def _carry(local: Array, turned: Array, pointing: Array, joints: list[int], children: list[int]) -> None:
    """Each joint turns as its parent does, and then the shortest way to where its one child points; in place."""
    above = turned[:, [_PARENTS[joint] for joint in joints]]
    seen = (pointing[:, children, None] @ above)[..., 0, :]
    local[:, joints] = rotation_between(_OFFSETS[children], seen)
    turned[:, joints] = above @ local[:, joints]


def _fitted(pointing: Array, joint: int) -> Array:
    """The global rotation ``(F, 3, 3)`` of a joint with three children: across the outer two, up to the middle one."""
    rest, now = _frame(_OFFSETS[None], joint), _frame(pointing * _LENGTHS[:, None], joint)
    return np.asarray(now @ np.swapaxes(rest, -1, -2))


def _frame(bones: Array, joint: int) -> Array:
    """Axes ``(F, 3, 3)`` of pelvis or chest, in columns, of bones ``(F, 24, 3)``."""
    left, right, middle = bones[:, _OUTER[joint]], bones[:, _OUTER[joint] + 1], bones[:, _MIDDLE[joint]]
    up = middle - (left + right) / 2 if joint == 0 else middle + (left + right) / 2
    x = normalise(left - right)
    z = normalise(np.cross(x, up))
    return np.stack([x, np.cross(z, x), z], axis=-1)


def _told(rotations: Array) -> Array:
    """Rotations ``(F, 24, 3, 3)``, none where joints coincide and nothing tells one."""
    square = rotations @ np.swapaxes(rotations, -1, -2)
    told = np.abs(square - np.eye(3)).max(axis=(-2, -1)) < 1e-3
    return np.where(told[..., None, None], rotations, np.eye(3))


def _carried(rotations: Array, joints: list[int]) -> Array:
    """Offsets of joints ``(F, N, 3)`` as their parents' rotations ``(F, N, 3, 3)`` carry them."""
    return np.asarray((rotations @ _OFFSETS[joints][:, :, None])[..., 0])


def _bend_limbs(pointing: Array, turned: Array, given: Array) -> None:
    """Let arms and legs point so that their ends reach the given places, in place."""
    start = _limb_starts(pointing, turned, given[:, 0])
    upper, lower = _LENGTHS[_MIDDLES][:, None], _LENGTHS[_ENDS][:, None]
    middle = start + pointing[:, _MIDDLES] * upper
    end = middle + pointing[:, _ENDS] * lower
    missing = given[:, _ENDS] - end
    share = np.clip((lengths(missing)[..., None] - _CORRECTED_FROM) / (_CORRECTED_FULLY - _CORRECTED_FROM), 0, 1)
    front = turned[..., 2][:, [0, 0, _CHEST, _CHEST]] * _BENDS
    pole = middle - start + front * _HINT * share
    pointing[:, _MIDDLES], pointing[:, _ENDS] = _two_bones(end + missing * share - start, pole, upper, lower)


def _limb_starts(pointing: Array, turned: Array, root: Array) -> Array:
    """Hips and shoulders ``(F, 4, 3)``, metres, as pelvis, spine, chest and collars have them."""
    hips = root[:, None] + _carried(turned[:, [0, 0]], _STARTS[:2])
    spine = _joints("spine2", "spine3")
    chest = root + _carried(turned[:, :1], _joints("spine1"))[:, 0] + _LENGTHS[spine] @ pointing[:, spine]
    collars = chest[:, None] + _carried(turned[:, [_CHEST, _CHEST]], _joints("collar"))
    shoulders = collars + pointing[:, _STARTS[2:]] * _LENGTHS[_STARTS[2:]][:, None]
    return np.concatenate([hips, shoulders], axis=1)


def _two_bones(way: Array, pole: Array, upper: Array, lower: Array) -> tuple[Array, Array]:
    """Unit directions of two bones of lengths ``upper`` and ``lower`` that lead along ``way`` and bend to ``pole``."""
    along = normalise(way)
    reach = np.clip(lengths(way)[..., None], np.abs(upper - lower) + 1e-9, upper + lower)
    share = (upper**2 - lower**2 + reach**2) / (2 * reach)
    height = np.sqrt(np.maximum(upper**2 - share**2, 0))
    side = normalise(pole - np.einsum("fni,fni->fn", pole, along)[..., None] * along)
    middle = along * share + side * height
    return normalise(middle), normalise(along * reach - middle)
