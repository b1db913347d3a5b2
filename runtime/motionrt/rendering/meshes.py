"""Triangles as pixels with depths: a user's character among the rounded cones."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from motionrt.rendering.camera import Camera
from motionrt.rendering.colours import Colours

Floats = npt.NDArray[np.float32]
Indices = npt.NDArray[np.int64]
_AT_ONCE = 1_000_000  # pixels that are looked at together
_THIN = 0.01  # square pixels: a triangle that is next to a line


@dataclass(frozen=True)
class Mesh:
    """A mesh in a picture: x to the right, y down, z towards the eye.

    Attributes:
        points: ``(V, 3)`` pixels and depth.
        normals: ``(V, 3)`` unit vectors.
        faces: ``(T, 3)``.
        colours: ``(T, 3)``, 0 to 1.
    """

    points: Floats
    normals: Floats
    faces: Indices
    colours: Floats

    def box(self, width: int, height: int) -> tuple[int, int, int, int]:
        """Pixels left, top, right, bottom that it may touch, within the picture."""
        low, high = np.floor(self.points[:, :2].min(axis=0)), np.ceil(self.points[:, :2].max(axis=0))
        left, top = np.clip(low, 0, (width, height)).astype(int).tolist()
        right, bottom = np.clip(high, 0, (width, height)).astype(int).tolist()
        return left, top, right, bottom


def seen(
    camera: Camera, vertices: Floats, faces: Indices, colours: npt.NDArray[np.uint8], look: Colours, fade: float = 0.0
) -> Mesh:
    """A mesh as a camera sees it.

    Args:
        camera: the camera.
        vertices: ``(V, 3)`` metres.
        faces: ``(T, 3)``.
        colours: ``(T, 3)``, 0 to 255.
        look: the picture's colours.
        fade: how far it is faded into the floor, 0 to 1.
    """
    ground = np.array(look.rgb("floor"), np.float32) / 255
    clear = colours.astype(np.float32) / 255
    turned = normals_of(vertices, faces) @ camera.turn.T * np.array([1, -1, 1], np.float32)
    tints = (clear + fade * (ground - clear)).astype(np.float32)
    return Mesh(camera.project(vertices)[0], turned.astype(np.float32), faces, tints)


def normals_of(vertices: Floats, faces: Indices) -> Floats:
    """``(V, 3)`` unit normals, means of those of the triangles around, weighed by their areas."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    across = np.cross(b - a, c - a)
    sums = np.empty((len(vertices), 3), np.float32)
    for axis in range(3):
        sums[:, axis] = np.bincount(faces.ravel(), np.repeat(across[:, axis], 3), len(vertices))
    lengths = np.linalg.norm(sums, axis=1, keepdims=True)
    return np.asarray(sums / np.maximum(lengths, 1e-12), np.float32)


def fragments(mesh: Mesh, width: int, height: int) -> Iterator[tuple[Indices, Indices, Floats, Indices]]:
    """The pixels of a picture of that size whose middles lie in a triangle, hidden ones among them, bit by bit.

    Returns:
        x, y, depth and face, ``(N,)`` each.
    """
    corners = mesh.points[mesh.faces]
    planes = gradients(mesh, corners[..., 2:])[:, 0]
    ys = corners[..., 1]
    top = np.clip(np.ceil(ys.min(axis=1) - 0.5), 0, height).astype(np.int64)
    bottom = np.clip(np.floor(ys.max(axis=1) - 0.5) + 1, 0, height).astype(np.int64)
    rows = np.maximum(bottom - top, 0)
    rough = np.cumsum(rows * (1 + np.clip(np.ptp(corners[..., 0], axis=1), 0, width)))
    steps = np.arange(_AT_ONCE, rough[-1] if len(rough) else 0, _AT_ONCE)
    cuts = np.searchsorted(rough, steps)
    for part in np.split(np.arange(len(rows)), cuts):
        x, y, face = _pixels(corners, part, top, rows, width)
        yield x, y, _along(planes[face], x, y), face


def _pixels(
    corners: Floats, part: Indices, top: Indices, rows: Indices, width: int
) -> tuple[Indices, Indices, Indices]:  # fmt: skip
    """Pixels of some triangles, and the triangle of each: row by row, from edge to edge."""
    face, row = _counted(part, rows[part])
    y = top[face] + row
    points = corners[face]
    first, last = np.full(len(face), np.inf, np.float32), np.full(len(face), -np.inf, np.float32)
    for a, b in ((0, 1), (1, 2), (2, 0)):
        tall = points[:, b, 1] - points[:, a, 1]
        share = (y + np.float32(0.5) - points[:, a, 1]) / np.where(tall == 0, 1, tall)
        cut = points[:, a, 0] + share * (points[:, b, 0] - points[:, a, 0])
        meets = (share >= 0) & (share <= 1) & (tall != 0)
        first, last = np.where(meets, np.minimum(first, cut), first), np.where(meets, np.maximum(last, cut), last)
    left = np.clip(np.ceil(np.nan_to_num(first, posinf=width) - 0.5), 0, width).astype(np.int64)
    right = np.clip(np.floor(np.nan_to_num(last, neginf=-1) - 0.5) + 1, 0, width).astype(np.int64)
    span, along = _counted(np.arange(len(face)), np.maximum(right - left, 0))
    return left[span] + along, y[span], face[span]


def _counted(items: Indices, counts: Indices) -> tuple[Indices, Indices]:
    """Every item as often as its count says, and the numbers 0, 1, 2 ... within each."""
    repeated = np.repeat(items, counts)
    starts = np.repeat(np.cumsum(counts) - counts, counts)
    return repeated, np.arange(len(repeated)) - starts


def gradients(mesh: Mesh, values: Floats) -> Floats:
    """``(T, K, 3)``: how ``K`` values at the corners of triangles ``(T, 3, K)`` go on in the picture.

    At the middle of pixel (x, y) a value is ``[0] + [1] * (x + 0.5) + [2] * (y + 0.5)``; on a triangle that is next to
    a line it is the mean.
    """
    points = mesh.points[mesh.faces].astype(np.float64)
    (ux, uy), (vx, vy) = ((points[:, k, :2] - points[:, 0, :2]).T for k in (1, 2))
    area = ux * vy - vx * uy
    thin = np.abs(area) < _THIN
    over = np.where(thin, 0, 1 / np.where(thin, 1, area))[:, None]
    du, dv = (values[:, k] - values[:, 0] for k in (1, 2))
    along_x = (du * vy[:, None] - dv * uy[:, None]) * over
    along_y = (dv * ux[:, None] - du * vx[:, None]) * over
    at = points[:, 0]
    origin = np.where(thin[:, None], values.mean(axis=1), values[:, 0]) - along_x * at[:, :1] - along_y * at[:, 1:2]
    return np.asarray(np.stack([origin, along_x, along_y], axis=-1), np.float32)


def _along(planes: Floats, x: Indices, y: Indices) -> Floats:
    """Values ``(N,)`` of planes ``(N, 3)`` at pixels."""
    at_x, at_y = x.astype(np.float32) + np.float32(0.5), y.astype(np.float32) + np.float32(0.5)
    return np.asarray(planes[:, 0] + planes[:, 1] * at_x + planes[:, 2] * at_y, np.float32)


def slopes(planes: Floats, face: Indices, x: Indices, y: Indices) -> tuple[Floats, Floats]:
    """The x and y of the unit normals ``(N,)`` at pixels of faces, turned towards the eye.

    Args:
        planes: ``(T, 3, 3)`` of :func:`gradients` for the normals.
        face: ``(N,)``.
        x: ``(N,)``.
        y: ``(N,)``.
    """
    nx, ny, nz = (_along(planes[face, axis], x, y) for axis in range(3))
    towards = np.where(nz < 0, -1, 1) / np.maximum(np.sqrt(nx * nx + ny * ny + nz * nz), 1e-9)
    return nx * towards, ny * towards  # the inside of a coat is seen, too
