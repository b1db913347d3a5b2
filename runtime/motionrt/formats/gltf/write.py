"""GLB out: a skeleton, its animation and a body of plain bones, as one glTF 2.0 file."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from motionrt.formats.atomic import write_bytes
from motionrt.formats.gltf.builder import ARRAY_BUFFER, GlbBuilder
from motionrt.formats.gltf.channels import build_animation
from motionrt.formats.gltf.container import Json, pack_container, pack_text
from motionrt.formats.gltf.humanoid import add_humanoid
from motionrt.formats.gltf.mesh import bone_mesh
from motionrt.formats.tips import bone_tips
from motionrt.motion.events import events
from motionrt.motion.motion import Motion
from motionrt.motion.rotations import matrix_to_quaternion
from motionrt.rigs.clip import RigClip
from motionrt.untrusted.arguments import check_kind
from motionrt.untrusted.files import as_path

GENERATOR = "motionrt"
_COLOUR = [0.32, 0.52, 0.78, 1.0]


def write_glb(motion: Motion, path: str | Path) -> Path:
    """Write a motion as GLB, whole or not at all; as ``.gltf`` with everything in its text, as ``.vrma`` for VRM.

    Metres, Y up, facing +Z, as glTF wants it. One node a joint with the joint's name; a skin whose bind pose is the
    T-pose on the floor; an octahedron a bone as its mesh; one animation named after the file: rotations of all joints
    and the translation of the root, linear between keys at ``frame / fps`` seconds, quaternions without sign flips.
    Its extras hold the :func:`~motionrt.motion.events.events` of the motion, under ``motionrt``.

    Returns:
        ``path``.

    Raises:
        InvalidInputError: the file cannot be written.
    """
    check_kind(motion, Motion, "motion", "a Motion")
    return write_rig_glb(standing_clip(motion), path, extras={GENERATOR: events(motion)})


def standing_clip(motion: Motion) -> RigClip:
    """``motion`` as a clip in metres whose rest pose stands on the floor with its lowest joint."""
    skeleton = motion.skeleton
    offsets = skeleton.offsets.copy()
    offsets[0, 1] -= skeleton.rest_positions[:, 1].min()
    translations = np.repeat(offsets[None], motion.frames, axis=0)
    translations[:, 0] = motion.root
    return RigClip(
        skeleton.names, skeleton.parents, offsets, motion.rotations, translations, motion.fps, "y", metres_per_unit=1.0
    )


def write_rig_glb(clip: RigClip, path: str | Path, *, extras: Json | None = None) -> Path:
    """Write any clip in metres and Y up as :func:`write_glb` does; its rest pose becomes the bind pose.

    ``extras``: what goes into the extras of the animation.
    """
    path = as_path(path)
    document: Json = {
        "asset": {"version": "2.0", "generator": GENERATOR},
        "buffers": [{"byteLength": 0}],
        "nodes": _nodes(clip),
    }
    builder = GlbBuilder(document)
    _add_body(builder, clip)
    joints = range(len(clip.names))
    document["animations"] = [build_animation(builder, clip, path.stem, joints, np.ones(len(joints)), clip.offsets)]
    if extras is not None:
        document["animations"][0]["extras"] = extras
    if path.suffix.lower() == ".vrma":
        add_humanoid(document)
    pack = pack_text if path.suffix.lower() == ".gltf" else pack_container
    return write_bytes(path, pack(document, builder.finish()))


def _nodes(clip: RigClip) -> list[Json]:
    nodes: list[Json] = []
    quaternions = matrix_to_quaternion(clip.rest_rotations().astype(np.float64))
    for joint, name in enumerate(clip.names):
        node: Json = {"name": name, "translation": clip.offsets[joint].tolist()}
        if not np.allclose(quaternions[joint], [1, 0, 0, 0]):
            node["rotation"] = np.roll(quaternions[joint], -1).tolist()
        children = [child for child, parent in enumerate(clip.parents) if parent == joint]
        if children:
            node["children"] = children
        nodes.append(node)
    return nodes


def _add_body(builder: GlbBuilder, clip: RigClip) -> None:
    """Mesh, material, skin and the node and scene that hold them."""
    document, joints = builder.document, len(clip.names)
    roots = [joint for joint, parent in enumerate(clip.parents) if parent < 0]
    document["nodes"].append({"name": "bones", "mesh": 0, "skin": 0})
    document["scene"], document["scenes"] = 0, [{"nodes": [*roots, joints]}]
    surface = {"baseColorFactor": _COLOUR, "metallicFactor": 0.0, "roughnessFactor": 0.7}
    document["materials"] = [{"name": "bones", "pbrMetallicRoughness": surface}]
    document["meshes"] = [{"name": "bones", "primitives": [_primitive(builder, clip)]}]
    inverse = builder.add(_inverse_bind_matrices(clip))
    document["skins"] = [
        {"name": "skeleton", "skeleton": roots[0], "joints": list(range(joints)), "inverseBindMatrices": inverse}
    ]


def _primitive(builder: GlbBuilder, clip: RigClip) -> Json:
    positions, rotations = (array.astype(np.float64) for array in clip.rest_pose())
    tips = bone_tips(clip.names, clip.parents, clip.offsets)
    ends = {joint: positions[joint] + _tip_rotation(clip, rotations, joint) @ tip for joint, tip in tips.items()}
    corners, normals, carriers = bone_mesh(positions, clip.parents, ends)
    joints = np.zeros((len(carriers), 4), dtype=np.uint8 if len(clip.names) < 256 else np.uint16)
    joints[:, 0] = carriers
    weights = np.tile(np.array([1, 0, 0, 0], dtype=np.float32), (len(carriers), 1))
    attributes = {
        "POSITION": builder.add(corners, target=ARRAY_BUFFER, bounds=True),
        "NORMAL": builder.add(normals, target=ARRAY_BUFFER),
        "JOINTS_0": builder.add(joints, target=ARRAY_BUFFER),
        "WEIGHTS_0": builder.add(weights, target=ARRAY_BUFFER),
    }
    return {"attributes": attributes, "material": 0}


def _tip_rotation(clip: RigClip, rotations: np.ndarray, joint: int) -> np.ndarray:
    """Offsets, from which tips are made, stand in the axes of the parent."""
    parent = clip.parents[joint]
    return rotations[parent] if parent >= 0 else np.eye(3)


def _inverse_bind_matrices(clip: RigClip) -> np.ndarray:
    """``(J, 4, 4)`` float32: from the space of the mesh to that of each joint at rest."""
    positions, rotations = (array.astype(np.float64) for array in clip.rest_pose())
    out = np.tile(np.eye(4), (len(positions), 1, 1))
    out[:, :3, :3] = np.swapaxes(rotations, -1, -2)
    out[:, :3, 3] = -np.einsum("jba,jb->ja", rotations, positions)
    return out.astype(np.float32)
