"""From global rotations of the joints with a role to the local ones of the whole rig, and which joint travels."""

from __future__ import annotations

import numpy as np

from motionrt.errors import RigError
from motionrt.motion.batches import by_batches
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import Array, axis_rotation, yaw_angle
from motionrt.motion.skeleton import FloatArray
from motionrt.motion.transforms import heading
from motionrt.rigs.drive import Turned, stored
from motionrt.rigs.stance import Stance
from motionrt.rigs.target import Rig
from motionrt.rigs.tree import RigTree

_CALM_S = 0.15  # standard deviation of the average over the heading of a root


def carry(
    motion: Motion, turned: Turned, pelvis: Array, rig: Rig, stance: Stance, local: FloatArray, root_motion: bool | str
) -> tuple[FloatArray, FloatArray]:
    """Local rotations ``(F, J, 3, 3)`` and translations ``(F, J, 3)`` of all joints, in the file's axes and unit.

    Args:
        motion: the source.
        turned: global rotations of the joints that have a role, Y up; used up.
        pelvis: ``(F, 3)`` where the pelvis joint shall be, Y up, units of the rig.
        rig: the target.
        stance: what is known of it.
        local: ``(J, 3, 3)`` local rotations of joints that have no role.
        root_motion: as for :func:`motionrt.rigs.retarget_out.to_rig`.
    """
    to_file, pose = stance.to_world.T, _Pose(rig, local, motion.frames)
    in_file = _turned_by(to_file, turned)
    tree, hips = RigTree(rig.clip), stance.roles.joints["pelvis"]
    base = _trunk_base(tree, stance, hips)
    if base != hips:  # spine and pelvis hang on another joint, which goes with the pelvis
        in_file[base] = in_file[hips] @ pose.rest_rotation(hips).T @ pose.rest_rotation(base)
    mover = _mover(tree, rig, base)
    if root_motion:
        _place_root(_root(tree, rig, mover, root_motion), motion, pelvis, stance, pose, in_file)
    between = pose.rest_rotation(base).T @ (pose.rest_position(hips) - pose.rest_position(base))
    pose.place(base, pelvis @ to_file.T - in_file[base] @ between, in_file, mover)
    return pose.finish(in_file)


def _turned_by(to_file: Array, turned: Turned) -> Turned:
    """``turned`` in the axes of the file."""
    for joint in turned:
        turned[joint] = stored(lambda part: to_file @ part, turned[joint])
    return turned


class _Pose:
    """All frames of a rig, filled from the root down."""

    def __init__(self, rig: Rig, local: FloatArray, frames: int) -> None:
        self._parents, self._local, self._offsets = rig.clip.parents, local.astype(np.float64), rig.clip.offsets
        offsets, count = rig.clip.offsets.astype(np.float32), np.broadcast_to(np.float32(0), frames)
        self._translations = by_batches(lambda part: np.repeat(offsets[None], len(part), axis=0), count)

    def finish(self, turned: Turned) -> tuple[FloatArray, FloatArray]:
        """Local rotations and translations of all joints."""
        joints, turns = list(turned), list(turned.values())
        rotations = by_batches(lambda *part: self._rotations(dict(zip(joints, part, strict=True))), *turns)
        return rotations, self._translations

    def _rotations(self, turned: Turned) -> FloatArray:
        """Local rotations ``(F, J, 3, 3)``."""
        frames = len(next(iter(turned.values())))
        rotations = np.empty((frames, len(self._parents), 3, 3), dtype=np.float32)
        world: dict[int, Array] = {}
        for joint, parent in enumerate(self._parents):
            above = world[parent] if parent >= 0 else np.eye(3)
            world[joint] = turned[joint] if joint in turned else above @ self._local[joint]
            rotations[:, joint] = np.swapaxes(above, -1, -2) @ world[joint] if joint in turned else self._local[joint]
        return rotations

    def place(self, joint: int, position: Array, turned: Turned, mover: int) -> None:
        """Translate ``mover``, which is ``joint`` or above it, so that ``joint`` comes to ``position`` ``(F, 3)``."""
        parent = self._parents[mover]
        rotation, origin = self._global(parent, turned)
        now = self._global(joint, turned)[1]
        start = self._global(mover, turned)[1]
        wanted = start + position - now
        self._translations[:, mover] = np.einsum("...ba,...b->...a", rotation, wanted - origin)

    def rest_rotation(self, joint: int) -> Array:
        """Global rotation ``(3, 3)`` of a joint at rest, file axes."""
        return self._global(joint, {}, at_rest=True)[0]

    def rest_position(self, joint: int) -> Array:
        """Global position ``(3,)`` of a joint at rest."""
        return self._global(joint, {}, at_rest=True)[1]

    def _global(self, joint: int, turned: Turned, *, at_rest: bool = False) -> tuple[Array, Array]:
        if joint < 0:
            return np.eye(3), np.zeros(3)
        above, origin = self._global(self._parents[joint], turned, at_rest=at_rest)
        step = self._offsets[joint] if at_rest else self._translations[:, joint]
        position = origin + np.einsum("...ab,...b->...a", above, step.astype(np.float64))
        return turned[joint] if joint in turned else above @ self._local[joint], position


def _trunk_base(tree: RigTree, stance: Stance, pelvis: int) -> int:
    """The joint on which pelvis and spine hang: mostly the pelvis itself."""
    base = tree.meeting([pelvis, stance.roles.spine[0]]) if stance.roles.spine else None
    return pelvis if base is None else base


def _place_root(root: int, motion: Motion, pelvis: Array, stance: Stance, pose: _Pose, in_file: Turned) -> None:
    """Put ``root`` under the pelvis, at its own height, and turn it to where the body faces."""
    turn = _calm(np.unwrap(heading(motion).astype(np.float64)), motion.fps) - _rest_heading(stance, pose)
    to_world = stance.to_world
    in_file[root] = to_world.T @ axis_rotation("Y", turn) @ to_world @ pose.rest_rotation(root)
    ground = pelvis * [1, 0, 1] + [0, 1, 0] * (to_world @ pose.rest_position(root))
    pose.place(root, ground @ to_world, in_file, root)


def _mover(tree: RigTree, rig: Rig, joint: int) -> int:
    """``joint``, or the nearest joint above it that the file lets be translated."""
    movers = [other for other in tree.ancestors(joint) if rig.movable[other]]
    if not movers:
        raise RigError(f"neither '{tree.names[joint]}' nor a joint above it has position channels: it cannot travel")
    return movers[0]


def _root(tree: RigTree, rig: Rig, mover: int, wanted: bool | str) -> int:
    """The joint for the root motion: the one of that name; else called root; else the highest above the pelvis."""
    above = [joint for joint in tree.ancestors(mover)[1:] if rig.movable[joint]]
    names = [tree.names[joint] for joint in above]
    if isinstance(wanted, str):
        if wanted not in names:
            known = ", ".join(names) or "none"
            raise RigError(f"no joint '{wanted}' above the pelvis can carry root motion; there are: {known}")
        return above[names.index(wanted)]
    if not above:
        raise RigError("the rig has no joint above its pelvis that could carry root motion; leave it on the pelvis")
    called = [joint for joint in above if "root" in tree.names[joint].lower()]
    return called[0] if called else above[-1]


def _rest_heading(stance: Stance, pose: _Pose) -> float:
    """Which way the rig faces at rest, radians from +Z towards +X."""
    pelvis = stance.roles.joints["pelvis"]
    axes = stance.to_world @ pose.rest_rotation(pelvis) @ stance.alignments[pelvis]
    return float(yaw_angle(axes[:, 2]))


def _calm(values: Array, fps: float) -> Array:
    """``(F,)`` averaged over time with a bell."""
    reach = max(1, round(3 * _CALM_S * fps))
    bell = np.exp(-0.5 * (np.arange(-reach, reach + 1) / (_CALM_S * fps)) ** 2)
    return np.convolve(np.pad(values, reach, mode="edge"), bell / bell.sum(), mode="valid")
