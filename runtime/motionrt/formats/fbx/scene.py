"""The library ``ufbx``, and a file opened by it.

Of the readers that Python has, ``ufbx`` (PyPI 0.0.5, MIT) evaluates the scene as FBX means it: pivots, pre-rotations,
inherited scale, curves, units and axes. ``pyufbx`` installs a module of the same name that evaluates nothing.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from motionrt.errors import FormatError, MissingDependencyError
from motionrt.formats.text import require_file

FILE_LIMIT = 2**31

_INSTALL = (
    "reading FBX needs the package ufbx: pip install 'motionrt[fbx]' (where there is no wheel for your system, save the"
    " file as .glb or .bvh, in Blender for example)"
)


@dataclass(frozen=True, eq=False)
class Scene:
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
    def of(raw: Any) -> Scene:
        """All that is read of a scene."""
        nodes, stacks, skins = list(raw.nodes), list(raw.anim_stacks), list(raw.skin_deformers)
        attributes = [(node.bone, node.mesh, node.camera, node.light) for node in nodes]
        clusters = [cluster for skin in skins for cluster in skin.clusters]
        return Scene(raw, nodes, attributes, stacks, [stack.anim for stack in stacks], skins, clusters, raw.settings)


def open_scene(path: Path) -> Scene:
    """The file as a scene in metres and Y up."""
    require_file(path)
    ufbx = library()
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
    return Scene.of(raw)


def library() -> Any:
    """The module; MissingDependencyError where there is none, or another one of the same name."""
    try:
        import ufbx
    except ImportError as error:
        raise MissingDependencyError(_INSTALL) from error
    if not hasattr(ufbx, "load_file") or not hasattr(ufbx, "axes_right_handed_y_up"):
        raise MissingDependencyError(f"the module ufbx here is another package (pyufbx?); {_INSTALL}")
    return ufbx
