"""FBX in, binary and ASCII, through the library ``ufbx`` (extra ``fbx``): a skeleton and one of its animations.

Of the readers that Python has, ``ufbx`` (PyPI 0.0.5, MIT) evaluates the scene as FBX means it: pivots, pre-rotations,
inherited scale, curves, units and axes. ``pyufbx`` installs a module of the same name that evaluates nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from motionrt.errors import FormatError, MissingDependencyError
from motionrt.formats.gltf.choice import called, chosen
from motionrt.formats.text import require_file
from motionrt.motion.rotations import Array, normalise, quaternion_to_matrix
from motionrt.rigs.clip import RigClip

FILE_LIMIT = 2**31
JOINT_LIMIT, VALUE_LIMIT = 2048, 20_000_000
_FEWEST_BONES = 8
_FIGURE = 0.75
"""Share of the bones that one tree must have for the others to be props."""

_INSTALL = (
    "reading FBX needs the package ufbx: pip install 'motionrt[fbx]' (where there is no wheel for your system, save the"
    " file as .glb or .bvh, in Blender for example)"
)


def read_fbx(
    path: str | Path, *, fps: float | None = None, animation: int | str | None = None, still: bool = False
) -> RigClip:
    """Read an FBX file: metres, Y up, whatever unit and axes it is in.

    Joints are the bones and all nodes above them; where there are hardly any bones, all nodes without mesh, camera or
    light. The rest pose is the bind pose of the skin, or the pose in which the nodes stand. Scales of nodes are carried
    into the translations.

    Args:
        path: the file.
        fps: rate at which the animation is sampled; by default that of the file.
        animation: name or index of the take; needed where several move the skeleton.
        still: only the pose in which the nodes stand, as one frame.

    Raises:
        MissingDependencyError: ``ufbx`` is not installed.
        MotionFileNotFoundError: there is no such file.
        FormatError: no FBX file, no skeleton, or several to choose from.
    """
    path = Path(path)
    scene = open_scene(path)
    joints = _joints(scene, path)
    if still:
        return _standing(scene, joints)
    stack = _take(scene, joints.nodes, animation, path)
    rate = float(fps) if fps is not None else _rate(scene)
    frames = max(1, round((stack.time_end - stack.time_begin) * rate) + 1)
    if frames * len(joints.nodes) > VALUE_LIMIT:
        raise FormatError(path, f"its animation has {frames} frames at {rate:g} fps; cut it")
    rotations, translations = _sampled(joints, stack, stack.time_begin + np.arange(frames) / rate)
    offsets, rest = _rest(scene, joints)
    return RigClip(
        joints.names, tuple(joints.parents), offsets, rotations, translations, rate, "y", 1.0, rest.astype(np.float32)
    )


def _standing(scene: _Scene, joints: _Joints) -> RigClip:
    poses = np.array([_pose(node.local_transform) for node in joints.nodes])
    turns = quaternion_to_matrix(normalise(np.roll(poses[:, 3:], 1, axis=-1))).astype(np.float32)
    places = (poses[:, :3] * joints.units[:, None]).astype(np.float32)
    offsets, rest = _rest(scene, joints)
    parents, rest = tuple(joints.parents), rest.astype(np.float32)
    return RigClip(joints.names, parents, offsets, turns[None], places[None], _rate(scene), "y", 1.0, rest)


def fbx_animations(path: Path) -> list[str]:
    """What the takes that move the skeleton are called."""
    scene = open_scene(path)
    nodes, takes = _joints(scene, path).nodes, _takes(scene)
    names = [take.name for take in takes]
    return [called(names, i) for i, take in enumerate(takes) if _moves(take, nodes)]


@dataclass(frozen=True, eq=False)
class _Scene:
    """An open scene, with all of its objects held.

    ``ufbx`` 0.0.5 hands out the same object for the same element without holding it: one that was let go is read again
    from freed memory. So everything is fetched once and kept as long as the scene.
    """

    raw: Any
    nodes: list[Any]
    attributes: list[tuple[Any, ...]]
    stacks: list[Any]
    anims: list[Any]
    skins: list[Any]
    clusters: list[Any]
    settings: Any

    @staticmethod
    def of(raw: Any) -> _Scene:
        """All that is read of a scene."""
        nodes, stacks, skins = list(raw.nodes), list(raw.anim_stacks), list(raw.skin_deformers)
        attributes = [(node.bone, node.mesh, node.camera, node.light) for node in nodes]
        clusters = [cluster for skin in skins for cluster in skin.clusters]
        return _Scene(raw, nodes, attributes, stacks, [stack.anim for stack in stacks], skins, clusters, raw.settings)


def open_scene(path: Path) -> _Scene:
    """The file as a scene in metres and Y up."""
    require_file(path)
    ufbx = _library()
    if path.stat().st_size > FILE_LIMIT:
        raise FormatError(path, f"has {path.stat().st_size} bytes; at most {FILE_LIMIT} are read")
    try:
        raw = ufbx.load_file(
            str(path),
            target_axes=ufbx.axes_right_handed_y_up,
            target_unit_meters=1.0,
            space_conversion=ufbx.SpaceConversion.ADJUST_TRANSFORMS,
            inherit_mode_handling=ufbx.InheritModeHandling.COMPENSATE,
            load_external_files=False,
            file_format=ufbx.FileFormat.FBX,
        )
    except ufbx.UfbxError as error:
        raise FormatError(path, f"is no FBX file that can be read: {error}") from error
    return _Scene.of(raw)


def _library() -> Any:
    try:
        import ufbx
    except ImportError as error:
        raise MissingDependencyError(_INSTALL) from error
    if not hasattr(ufbx, "load_file") or not hasattr(ufbx, "axes_right_handed_y_up"):
        raise MissingDependencyError(f"the module ufbx here is another package (pyufbx?); {_INSTALL}")
    return ufbx


@dataclass(frozen=True, eq=False)
class _Joints:
    """``J`` nodes, parents before children; ``units`` is the scale of all nodes above each."""

    nodes: Sequence[Any]
    parents: list[int]
    names: tuple[str, ...]
    units: Array


def _joints(scene: _Scene, path: Path) -> _Joints:
    every = [node for node in scene.nodes if not node.is_root]
    kinds = {node.typed_id: kinds for node, kinds in zip(scene.nodes, scene.attributes, strict=True)}
    bones = [node for node in every if kinds[node.typed_id][0] is not None]
    if len(bones) < _FEWEST_BONES:
        bones = [node for node in every if kinds[node.typed_id][1:] == (None, None, None)]
    if not bones:
        raise FormatError(path, "holds no skeleton: no bones and no empty nodes")
    members = _one_figure(bones, path)
    nodes = sorted((node for node in every if node.typed_id in members), key=lambda node: node.node_depth)
    if len(nodes) > JOINT_LIMIT:
        raise FormatError(path, f"has a skeleton of {len(nodes)} joints; at most {JOINT_LIMIT} are read")
    place = {node.typed_id: joint for joint, node in enumerate(nodes)}
    parents = [place.get(node.parent.typed_id, -1) for node in nodes]
    units = np.ones(len(nodes))
    for joint, parent in enumerate(parents):
        if parent >= 0:
            units[joint] = units[parent] * abs(float(np.mean(nodes[parent].local_transform.scale)))
    return _Joints(nodes, parents, _unique([node.name for node in nodes]), units)


def _one_figure(bones: list[Any], path: Path) -> set[int]:
    """Ids of the bones of the largest tree and of all nodes above them."""
    trees: dict[int, list[Any]] = {}
    for bone in bones:
        trees.setdefault(_line(bone)[-1].typed_id, []).append(bone)
    largest = max(trees.values(), key=len)
    if len(largest) < _FIGURE * len(bones):
        tops = ", ".join(f"'{_line(tree[0])[-1].name}'" for tree in trees.values())
        raise FormatError(path, f"its bones hang on {len(trees)} nodes ({tops}); put one figure into a file")
    return {node.typed_id for bone in largest for node in _line(bone)}


def _line(node: Any) -> list[Any]:
    """``node`` and all above it but the scene's root, nearest first."""
    out = []
    while node is not None and not node.is_root:
        out.append(node)
        node = node.parent
    return out


def _unique(names: list[str]) -> tuple[str, ...]:
    taken: dict[str, int] = {}
    out = []
    for name in names:
        taken[name] = taken.get(name, 0) + 1
        out.append(name if taken[name] == 1 else f"{name}_{taken[name]}")
    return tuple(out)


def _take(scene: _Scene, nodes: Sequence[Any], animation: int | str | None, path: Path) -> _Take:
    stacks = _takes(scene)
    names = [stack.name for stack in stacks]
    if animation is not None:
        return stacks[chosen("animation", animation, names, path)]
    moving = [stack for stack in stacks if _moves(stack, nodes)] or stacks[:1]
    if not moving:
        raise FormatError(path, "holds a skeleton but no animation of it")
    if len(moving) > 1:
        known = ", ".join(called(names, stacks.index(stack)) for stack in moving)
        raise FormatError(path, f"holds {len(moving)} animations; choose with animation=, one of: {known}")
    return moving[0]


@dataclass(frozen=True, eq=False)
class _Take:
    """What an animation stack animates, and from when to when, seconds."""

    name: str
    anim: Any
    time_begin: float
    time_end: float


def _takes(scene: _Scene) -> list[_Take]:
    """All takes; one that states no time lasts from its first key to its last."""
    out = []
    for stack, anim in zip(scene.stacks, scene.anims, strict=True):
        begin, end = float(stack.time_begin), float(stack.time_end)
        if end <= begin:
            baked = _library().bake_anim(scene.raw, anim)
            begin, end = float(baked.key_time_min), float(baked.key_time_max)
        out.append(_Take(str(stack.name), anim, begin, max(begin, end)))
    return out


def _moves(stack: _Take, nodes: Sequence[Any]) -> bool:
    times = np.linspace(stack.time_begin, stack.time_end, 7)
    poses = np.array([[_pose(node.evaluate_transform(stack.anim, time)) for node in nodes] for time in times])
    return bool(np.abs(poses - poses[0]).max() > 1e-6)


def _pose(transform: Any) -> tuple[float, ...]:
    return (*transform.translation, *transform.rotation)


def _rate(scene: _Scene) -> float:
    rate = float(scene.settings.frames_per_second)
    return rate if 1 <= rate <= 1000 else 30.0


def _sampled(joints: _Joints, stack: _Take, times: Array) -> tuple[Array, Array]:
    """Local rotations ``(F, J, 3, 3)`` and translations ``(F, J, 3)`` in metres."""
    rotations = np.empty((len(times), len(joints.nodes), 3, 3), dtype=np.float32)
    translations = np.empty((len(times), len(joints.nodes), 3), dtype=np.float32)
    seconds, anim = times.tolist(), stack.anim
    for joint, node in enumerate(joints.nodes):
        poses = np.array([_pose(node.evaluate_transform(anim, time)) for time in seconds])
        rotations[:, joint] = quaternion_to_matrix(normalise(np.roll(poses[:, 3:], 1, axis=-1)))
        translations[:, joint] = poses[:, :3] * joints.units[joint]
    return rotations, translations


def _rest(scene: _Scene, joints: _Joints) -> tuple[Array, Array]:
    """Offsets ``(J, 3)`` and local rotations ``(J, 3, 3)`` of the bind pose, or of the nodes where there is no skin."""
    poses = np.array([_pose(node.local_transform) for node in joints.nodes])
    rest = quaternion_to_matrix(normalise(np.roll(poses[:, 3:], 1, axis=-1)))
    offsets = poses[:, :3] * joints.units[:, None]
    bound = _bind_matrices(scene, joints)
    if not bound:
        return offsets.astype(np.float32), rest
    places, turned = np.zeros((len(rest), 3)), np.zeros((len(rest), 3, 3))
    for joint, parent in enumerate(joints.parents):
        above, at = (turned[parent], places[parent]) if parent >= 0 else (np.eye(3), np.zeros(3))
        places[joint], turned[joint] = at + above @ offsets[joint], above @ rest[joint]
        if joint in bound:
            places[joint], turned[joint] = bound[joint][:, 3], _turn(bound[joint])
            offsets[joint], rest[joint] = above.T @ (places[joint] - at), above.T @ turned[joint]
    return offsets.astype(np.float32), rest


def _bind_matrices(scene: _Scene, joints: _Joints) -> dict[int, Array]:
    """Global transforms ``(3, 4)`` at binding by joint, from all skins."""
    place = {node.typed_id: joint for joint, node in enumerate(joints.nodes)}
    out: dict[int, Array] = {}
    for cluster in scene.clusters:
        node = cluster.bone_node
        if node is not None and node.typed_id in place:
            matrix = _matrix(cluster.bind_to_world)
            if abs(np.linalg.det(matrix[:, :3])) > 1e-18:
                out.setdefault(place[node.typed_id], matrix)
    return out


def _matrix(matrix: Any) -> Array:
    """``(3, 4)`` of a matrix of ``ufbx``, whose columns are the axes and the place."""
    return np.array([matrix.c0, matrix.c1, matrix.c2, matrix.c3], dtype=np.float64).T


def _turn(matrix: Array) -> Array:
    """The rotation in ``(3, 4)`` without its scale."""
    u, _, v = np.linalg.svd(matrix[:, :3])
    return np.asarray(u @ np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ v))]) @ v)
