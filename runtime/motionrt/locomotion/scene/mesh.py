"""Triangle meshes: from a file or from arrays to vertices in metres with Y up."""

from __future__ import annotations

import struct
import zipfile
import zlib
from collections.abc import Sequence
from pathlib import Path
from typing import Literal

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError, SceneError
from motionrt.limits import how_to_raise, limits
from motionrt.locomotion.scene.mesh_files import Beside, check_claims
from motionrt.locomotion.scene.optional import require_scene_file, scene_package
from motionrt.untrusted.arguments import checked_array, checked_up, real
from motionrt.untrusted.files import as_path
from motionrt.untrusted.words import shorten, shown

Triangles = npt.NDArray[np.float64]
UpAxis = Literal["y", "z"]
MeshArrays = tuple[npt.ArrayLike, npt.ArrayLike]
"""Vertices ``(V, 3)`` and faces ``(T, 3)``, counter-clockwise seen from outside."""

BROKEN = (
    OSError,
    ValueError,
    TypeError,
    LookupError,
    AttributeError,
    ArithmeticError,
    AssertionError,
    EOFError,
    ImportError,  # a kind of mesh that needs a package more
    MemoryError,
    NameError,  # its reader of PLY leaves a variable unset
    NotImplementedError,
    RecursionError,
    struct.error,
    zipfile.BadZipFile,
    zlib.error,
)
"""What the parsers of trimesh raise for a damaged file."""


def read_triangles(source: str | Path | MeshArrays, *, up: UpAxis = "y", scale: float = 1.0) -> Triangles:
    """Corners ``(T, 3, 3)`` of all triangles of a mesh, metres, Y up.

    Args:
        source: a file that trimesh reads (OBJ, PLY, GLB, STL, ...), all its parts in place, or vertices and faces.
        up: the axis that points up in the source. ``"z"`` turns (x, y, z) into (x, z, -y), without mirroring.
        scale: metres per unit of the source, 0.01 for centimetres.

    Raises:
        MotionFileNotFoundError: there is no such file.
        SceneError: the file cannot be read or holds no triangles, or trimesh is not installed.
        InvalidInputError: wrong shapes, numbers, ``up`` or ``scale``.
    """
    checked_up(up)
    if not 0 < real(scale) < np.inf:
        raise InvalidInputError(f"scale must be a positive number of metres per unit, not {shown(scale)}")
    vertices, faces = _checked(source) if isinstance(source, list | tuple) else _load(as_path(source))
    if not len(faces):
        raise SceneError(f"{_name(source)} holds no triangles")
    if not np.isfinite(vertices).all():
        raise SceneError(f"{_name(source)} holds vertices that are not finite")
    points = vertices * scale
    if len(faces) > limits().triangles:
        raise SceneError(f"{_name(source)} holds {len(faces):,} triangles: {how_to_raise('triangles')}")
    if not np.abs(points).max(initial=0.0) <= limits().metres:
        raise SceneError(f"{_name(source)} reaches too far from its origin; check scale=, or: {how_to_raise('metres')}")
    if up == "z":
        points = points[:, [0, 2, 1]] * (1, 1, -1)
    return np.asarray(points[faces])


def _name(source: str | Path | MeshArrays) -> str:
    return str(source) if isinstance(source, str | Path) else "the mesh"


def _checked(mesh: Sequence[npt.ArrayLike]) -> tuple[Triangles, npt.NDArray[np.int64]]:
    if len(mesh) != 2:
        raise InvalidInputError(f"a mesh is a file, or vertices (V, 3) and faces (T, 3), not {shown(mesh)}")
    points = checked_array(mesh[0], "vertices", "numbers (V, 3)")
    indices = checked_array(mesh[1], "faces", "whole numbers (T, 3)").astype(np.int64)
    if points.ndim != 2 or points.shape[1] != 3 or indices.ndim != 2 or indices.shape[1] != 3:
        raise InvalidInputError(f"need vertices (V, 3) and faces (T, 3), not {points.shape} and {indices.shape}")
    if indices.size and (indices.min() < 0 or indices.max() >= len(points)):
        raise InvalidInputError(f"faces name vertices outside 0..{len(points) - 1}")
    return points, indices


def _load(path: Path) -> tuple[Triangles, npt.NDArray[np.int64]]:
    """Vertices and faces by trimesh; buffers of a ``.gltf`` are looked for in its own folder alone."""
    require_scene_file(path)
    check_claims(path)
    trimesh = scene_package("trimesh", f"reading the mesh {path.name}")
    kind = path.suffix.lower().lstrip(".")
    try:
        with path.open("rb") as file:
            mesh = trimesh.load(
                file, file_type=kind, force="mesh", skip_materials=True, process=False, resolver=Beside(path)
            )
        vertices = np.asarray(mesh.vertices, dtype=np.float64).reshape(-1, 3)
        faces = np.asarray(mesh.faces, dtype=np.int64).reshape(-1, 3)
    except SceneError:  # a file that it names is refused
        raise
    except BROKEN as error:
        raise SceneError(f"{path} cannot be read as a mesh: {shorten(str(error), 200)}") from error
    if faces.size and not (faces.min() >= 0 and faces.max() < len(vertices)):
        raise SceneError(f"{path}: its faces name vertices outside 0..{len(vertices) - 1}")
    return vertices, faces
