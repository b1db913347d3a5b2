"""A character's file as a target of retargeting."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.formats.bvh.read import parse_bvh
from motionrt.formats.bvh.rig import build_rig
from motionrt.formats.bvh.target import BvhTarget
from motionrt.formats.fbx import read_fbx
from motionrt.formats.gltf.container import GLTF_SUFFIXES
from motionrt.formats.gltf.document import open_glb
from motionrt.formats.gltf.target import GlbTarget
from motionrt.formats.leading_pose import drop_leading_tpose
from motionrt.formats.rig_files import RIG_SUFFIXES, BvhRigFile, FbxRigFile, GlbRigFile
from motionrt.formats.text import require_file
from motionrt.motion.motion import Motion
from motionrt.motion.skeleton import FloatArray
from motionrt.rigs.clip import RigClip
from motionrt.rigs.retarget_out import to_rig
from motionrt.rigs.target import Rig, RigMotion
from motionrt.untrusted.arguments import checked_choice
from motionrt.untrusted.files import as_path


def load_target(path: str | Path, *, animation: int | str | None = None, skin: int | str | None = None) -> Rig:
    """Read a character to retarget to.

    Args:
        path: a ``.bvh`` (its frames may be any; a leading T-pose is found), or a ``.glb``, ``.gltf``, ``.vrm`` or
            ``.fbx`` (with or without animation).
        animation: of a GLB: the one that helps where no pose of the file is a T- or A-pose; name or index.
        skin: of a GLB with several figures: which of them; name or index.

    Raises:
        MotionFileNotFoundError: there is no such file.
        FormatError: the file cannot be read; the message says why.
        InvalidInputError: another suffix.
    """
    path = as_path(path)
    require_file(path)
    readers: dict[str, Callable[[], Rig]] = {
        ".bvh": lambda: _from_bvh(path),
        ".fbx": lambda: _from_fbx(path, animation),
        **dict.fromkeys(GLTF_SUFFIXES, lambda: _from_glb(path, animation, skin)),
    }
    checked_choice(animation, "animation")
    checked_choice(skin, "skin")
    suffix = path.suffix.lower()
    if suffix not in readers:
        raise InvalidInputError(f"{path}: a rig '{suffix}' cannot be a target; can be: {', '.join(RIG_SUFFIXES)}")
    return readers[suffix]()


def retarget_to(
    motion: Motion, rig: Rig | str | Path, *, mapping: Mapping[str, str] | None = None, root_motion: bool | str = False
) -> RigMotion:
    """``motion`` on a character, its file or what :func:`load_target` made of it, as :meth:`.Motion.retarget_to`."""
    target = rig if isinstance(rig, Rig) else load_target(rig)
    return to_rig(motion, target, mapping=mapping, root_motion=root_motion)


def _from_bvh(path: Path) -> Rig:
    text = parse_bvh(path)
    clip = build_rig(text.joints, text.values, text.fps)
    rest, reference = drop_leading_tpose(clip)
    movable = [len(joint.positions) == 3 for joint in text.joints]
    return Rig(rest, _poses(rest, reference, clip.rotations[0]), movable, BvhRigFile(BvhTarget(path, text, clip)))


def _from_glb(path: Path, animation: int | str | None, skin: int | str | None) -> Rig:
    document = open_glb(path, skin)
    still = document.clip(None)
    tracks = None
    if animation is not None or len(document.json.get("animations", [])) == 1:
        tracks = document.tracks(animation)
    clip = still if tracks is None else document.clip(tracks)
    poses = _poses(clip, None, still.rotations[0], clip.rotations[0])
    return Rig(clip, poses, [True] * len(clip.names), GlbRigFile(GlbTarget(document)))


def _from_fbx(path: Path, animation: int | str | None) -> Rig:
    clip = read_fbx(path, animation=animation, still=animation is None)
    return Rig(clip, _poses(clip, None, clip.rotations[0]), [True] * len(clip.names), FbxRigFile(path))


def _poses(clip: RigClip, *others: FloatArray | None) -> list[FloatArray]:
    """Rest pose first, unless another pose was marked as the one to go by."""
    known = [pose for pose in others if pose is not None]
    poses = [clip.rest_rotations(), *known] if others[0] is None else [*known[:1], clip.rest_rotations(), *known[1:]]
    return [np.asarray(pose, dtype=np.float32) for pose in poses]
