"""Rounded cones into a depth buffer: what limbs are made of, pixel by pixel, in the right order of depth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from motionrt.rendering.meshes import Mesh, fragments, gradients, slopes

Floats = npt.NDArray[np.float32]
Bytes = npt.NDArray[np.uint8]
_LIGHT = (-0.420, -0.680, 0.601)  # unit vector from the upper left, before the picture; y points down
_SKY = (-0.8, 0.6)  # of y and z
_NOBODY = -1


@dataclass(frozen=True)
class Solids:
    """``N`` rounded cones (the hull of two spheres) in pixels: x to the right, y down, z towards the eye.

    Attributes:
        ends: ``(N, 2, 3)`` centres of the two spheres.
        radii: ``(N, 2)``.
        colours: ``(N, 3)``, 0 to 1.
        meshes: what is made of triangles.
    """

    ends: Floats
    radii: Floats
    colours: Floats
    meshes: tuple[Mesh, ...] = ()

    def boxes(self, width: int, height: int) -> npt.NDArray[np.int64]:
        """``(N, 4)`` pixels left, top, right, bottom that each may touch, within the picture."""
        low = (self.ends[..., :2] - self.radii[..., None]).min(axis=1)
        high = (self.ends[..., :2] + self.radii[..., None]).max(axis=1)
        edges = np.concatenate([np.floor(low), np.ceil(high)], axis=1)
        boxes: npt.NDArray[np.int64] = np.clip(edges, 0, [width, height, width, height]).astype(np.int64)
        return boxes


@dataclass(frozen=True)
class Sprite:
    """A part of a picture.

    Attributes:
        left: pixel.
        top: pixel.
        rgb: ``(h, w, 3)``.
        mask: ``(h, w)``, 255 where there is something.
    """

    left: int
    top: int
    rgb: Bytes
    mask: Bytes


def draw(solids: Solids, width: int, height: int) -> Sprite | None:
    """Solids as they are seen in a picture of that size, shaded; None where nothing is in the picture."""
    boxes = solids.boxes(width, height)
    inside = np.flatnonzero((boxes[:, 2] > boxes[:, 0]) & (boxes[:, 3] > boxes[:, 1]))
    edges = np.array([mesh.box(width, height) for mesh in solids.meshes], np.int64).reshape(-1, 4)
    around = np.concatenate([boxes[inside], edges[(edges[:, 2] > edges[:, 0]) & (edges[:, 3] > edges[:, 1])]])
    if not len(around):
        return None
    (left, top), (right, bottom) = around[:, :2].min(axis=0), around[:, 2:].max(axis=0)
    buffer = _Buffer(int(left), int(top), int(right), int(bottom))
    for number in inside:
        buffer.add(solids.ends[number], solids.radii[number], boxes[number], int(number))
    colours = [solids.colours]
    for mesh in solids.meshes:
        buffer.add_mesh(mesh, sum(map(len, colours)), width, height)
        colours.append(mesh.colours)
    return buffer.sprite(np.concatenate(colours))


class _Buffer:
    """Depth, normal and owner of every pixel of a box."""

    def __init__(self, left: int, top: int, right: int, bottom: int) -> None:
        self.left, self.top = left, top
        shape = (bottom - top, right - left)
        self.depth = np.full(shape, -np.inf, np.float32)
        self.nx = np.empty(shape, np.float32)
        self.ny = np.empty(shape, np.float32)
        self.owner = np.full(shape, _NOBODY, np.int32)

    def add(self, ends: Floats, radii: Floats, box: npt.NDArray[np.int64], number: int) -> None:
        """Draw a solid where it is nearer than what is there."""
        left, top, right, bottom = box.tolist()
        window = slice(top - self.top, bottom - self.top), slice(left - self.left, right - self.left)
        x = np.arange(left, right, dtype=np.float32)[None, :] + (0.5 - ends[0, 0])
        y = np.arange(top, bottom, dtype=np.float32)[:, None] + (0.5 - ends[0, 1])
        z, nx, ny = surface(x, y, ends[1] - ends[0], *radii.tolist())
        z += ends[0, 2]
        nearer = z > self.depth[window]
        for buffer, value in ((self.depth, z), (self.nx, nx), (self.ny, ny), (self.owner, np.int32(number))):
            np.copyto(buffer[window], value, where=nearer)

    def add_mesh(self, mesh: Mesh, first: int, width: int, height: int) -> None:
        """Draw a mesh where it is nearer than what is there; its faces are numbered from ``first`` on."""
        depth, owner = self.depth.ravel(), self.owner.ravel()
        normals = gradients(mesh, mesh.normals[mesh.faces])
        for x, y, z, face in fragments(mesh, width, height):
            place = (y - self.top) * self.depth.shape[1] + x - self.left
            np.maximum.at(depth, place, z)
            won = np.flatnonzero(z >= depth[place])
            owner[place[won]] = first + face[won]
            self.nx.ravel()[place[won]], self.ny.ravel()[place[won]] = slopes(normals, face[won], x[won], y[won])

    def sprite(self, colours: Floats) -> Sprite:
        """What the buffer holds, shaded."""
        mask = self.owner != _NOBODY
        owner = self.owner[mask]
        strength, gloss = shading(self.nx[mask], self.ny[mask])
        rgb = np.zeros((*self.owner.shape, 3), np.uint8)
        for channel in range(3):
            bright = (255 * colours[:, channel])[owner] * strength + gloss
            rgb[mask, channel] = np.clip(bright, 0, 255)
        return Sprite(self.left, self.top, rgb, mask.astype(np.uint8) * np.uint8(255))


def surface(x: Floats, y: Floats, axis: Floats, r0: float, r1: float) -> tuple[Floats, Floats, Floats]:
    """Where lines of sight along -z meet a rounded cone from the origin (radius ``r0``) to ``axis`` (``r1``).

    A rounded cone is what a sphere sweeps that moves along the axis and changes its radius evenly. What is seen at a
    pixel belongs to one of these spheres; a quadratic equation says to which.

    Args:
        x: pixels.
        y: pixels, of any shape that broadcasts with ``x``.
        axis: ``(3,)``.
        r0: radius at the origin.
        r1: radius at ``axis``.

    Returns:
        z (``-inf`` where it is missed), and x and y of the unit normal.
    """
    a, b, c = axis.tolist()
    taper = r0 - r1
    slant = a * a + b * b + c * c - taper * taper  # square of the length of the side
    flat = slant - c * c
    if slant <= 0 or (flat <= 0 and c * taper <= 0):  # one sphere is in the other, or hidden behind it
        return _sphere(x - a, y - b, c, r1) if r1 > r0 else _sphere(x, y, 0.0, r0)
    flat = flat if abs(flat) > 1e-3 else 1e-3
    along = (a * x - taper * r0) + b * y
    root = slant * (along * along - flat * (x * x + y * y - r0 * r0))
    depth = np.sqrt(np.maximum(root, 0))
    depth += c * along
    depth *= c / flat
    depth += along
    part = np.clip(depth * (1 / slant), 0, 1)  # of the axis, where the sphere stands that is seen
    radius = r0 - taper * part
    z, nx, ny = _sphere(x - a * part, y - b * part, c * part, radius)
    return z, nx, ny


def _sphere(x: Floats, y: Floats, z: Floats | float, radius: Floats | float) -> tuple[Floats, Floats, Floats]:
    left = radius * radius - x * x - y * y
    depth = np.where(left >= 0, z + np.sqrt(np.maximum(left, 0)), np.float32(-np.inf))
    inverse = 1 / radius
    return depth, x * inverse, y * inverse


def shading(nx: Floats, ny: Floats) -> tuple[Floats, Floats]:
    """How strongly a colour shines, and what gloss adds (0 to 255): light from the upper left, a little from the sky.

    Contours are darker; that parts limb from limb.

    Args:
        nx: ``(N,)`` of the unit normals, to the right.
        ny: ``(N,)``, down.
    """
    nz: Floats = np.sqrt(np.maximum(1 - nx * nx - ny * ny, 0))
    light: Floats = np.maximum(_LIGHT[0] * nx + _LIGHT[1] * ny + _LIGHT[2] * nz, 0)
    strength = 0.60 + 0.40 * light + 0.12 * (_SKY[0] * ny + _SKY[1] * nz)
    strength *= 0.60 + 0.40 * np.minimum(nz * (1 / 0.42), 1)
    light *= light
    light *= light
    return strength.astype(np.float32, copy=False), (33 * light**3).astype(np.float32, copy=False)
