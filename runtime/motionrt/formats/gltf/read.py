"""GLB in: the skeleton of a character and one of its animations as a :class:`RigClip`."""

from __future__ import annotations

from pathlib import Path

from motionrt.errors import FormatError
from motionrt.formats.gltf.document import open_glb
from motionrt.rigs.clip import RigClip


def read_glb(
    path: str | Path, *, fps: float | None = None, animation: int | str | None = None, skin: int | str | None = None
) -> RigClip:
    """Read a GLB file (glTF 2.0, binary).

    Joints are those of the skin, the nodes between them and all above them; without a skin, what the animation moves.
    Skins that share joints or a skeleton are one figure. Scales of nodes are carried into the translations, scale and
    morph tracks are ignored. The rest pose is the bind pose. Meshes, materials and images are not looked at, so it
    does not matter how they are compressed.

    Args:
        path: the file.
        fps: rate at which the animation is sampled. By default that of its keys; 30 where they follow no beat.
        animation: name or index; needed where several animations of more than one key move the skeleton.
        skin: name or index; needed where the file holds several figures of like size.

    Raises:
        MotionFileNotFoundError: there is no such file.
        FormatError: not a whole GLB file; no skeleton or no animation, or several to choose from; sparse or compressed
            accessors, or other files, where the skeleton needs them; mirrored or uneven scales; says what to do.
    """
    document = open_glb(path, skin)
    tracks = document.tracks(animation)
    if tracks is None:
        raise FormatError(path, "holds a skeleton but no animation of it; it can be a target: motion.retarget_to(path)")
    return document.clip(tracks, fps)
