"""The library ``ufbx``, and a file opened by it.

Of the readers that Python has, ``ufbx`` (PyPI 0.0.5, MIT) evaluates the scene as FBX means it: pivots, pre-rotations,
inherited scale, curves, units and axes. ``pyufbx`` installs a module of the same name that evaluates nothing.
"""

from __future__ import annotations

import ctypes
import gc
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from motionrt.errors import FormatError, MissingDependencyError
from motionrt.formats.text import require_file

T = TypeVar("T")
FILE_LIMIT = 2**31

_INSTALL = (
    'reading FBX needs the package ufbx: pip install "motionrt[fbx]" (where there is no wheel for your system, save'
    " the file as .glb or .bvh, in Blender for example)"
)


@dataclass(frozen=True, eq=False)
class Scene:
    """An open scene, to be closed; see :func:`held` for what is fetched of it."""

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
        for own in gc.get_referents(held(raw)):  # what it was made from
            held(own)
        nodes, stacks, skins = (_all(many) for many in (raw.nodes, raw.anim_stacks, raw.skin_deformers))
        attributes = [(held(node.bone), held(node.mesh), held(node.camera), held(node.light)) for node in nodes]
        clusters = [cluster for skin in skins for cluster in _all(skin.clusters)]
        anims = [held(stack.anim) for stack in stacks]
        return Scene(raw, nodes, attributes, stacks, anims, skins, clusters, held(raw.settings))

    def __enter__(self) -> Scene:  # noqa: PYI034
        return self

    def __exit__(self, *_: object) -> None:
        self.raw.free()


def held(thing: T) -> T:
    """``thing``, just fetched from a scene, for ever.

    ``ufbx`` 0.0.5 hands out what it keeps without counting the reference: what is let go is freed, and freed again with
    the scene, or found by the garbage collector, which crashes. With a reference more for each time that something is
    fetched, and out of the collector's sight, it is not. A closed scene leaves some kilobytes behind.
    """
    if thing is not None:
        pointer = ctypes.py_object(thing)
        ctypes.pythonapi.Py_IncRef(pointer)
        if gc.is_tracked(thing):
            ctypes.pythonapi.PyObject_GC_UnTrack(pointer)
    return thing


def _all(many: Any) -> list[Any]:
    return [held(one) for one in held(many)]


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
