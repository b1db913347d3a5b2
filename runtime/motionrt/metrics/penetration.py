"""How far limbs are inside the surfaces of a scene; the paper leaves it open.

A limb is a row of balls along its bone. It is inside a surface by as much as the surface is nearer to the bone than the
limb is thick; a bone that lies wholly behind a surface, farther than that, is not seen. Hands and feet are left out:
they are meant to touch. What somebody sits or lies on is touched as well: a body is a little thinner here than it is.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.motion.skeleton import SMPL24
from motionrt.untrusted.arguments import checked_array

THICKNESS = {
    "thigh": 0.07,
    "shin": 0.045,
    "upper arm": 0.04,
    "forearm": 0.03,
    "trunk": 0.09,
    "head": 0.08,
}
"""Metres from the bone to the skin."""
SHALLOW_CM = 1.0  # less is touching
_ALONG = 0.05  # metres between balls
_NEIGHBOURS = 9  # points of a cloud that are taken for a piece of a plane
_FLAT = 0.25  # of the spread of such a piece: what is thicker is no plane
_CHUNK = 200_000  # balls that are looked at together
_BONES = (
    *((f"{side}_{upper}", f"{side}_{lower}", kind) for side in ("left", "right") for upper, lower, kind in (
        ("hip", "knee", "thigh"), ("knee", "ankle", "shin"),
        ("shoulder", "elbow", "upper arm"), ("elbow", "wrist", "forearm"))),
    ("pelvis", "spine3", "trunk"), ("neck", "head", "head"),
)  # fmt: skip

Floats = npt.NDArray[np.float64]


def _along_bones() -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], Floats, Floats]:
    """Of every ball: the joints that its bone leads from and to, which share of the way it is at, and its radius."""
    rest, rows = SMPL24.rest_positions, []
    for first, last, kind in _BONES:
        start, end = SMPL24.index(first), SMPL24.index(last)
        count = max(2, round(float(np.linalg.norm(rest[end] - rest[start])) / _ALONG))
        rows += [(start, end, (k + 0.5) / count, THICKNESS[kind]) for k in range(count)]
    starts, ends, shares, radii = (np.array(column) for column in zip(*rows, strict=True))
    return starts, ends, shares, radii


_STARTS, _ENDS, _SHARES, _RADII = _along_bones()


@dataclass(frozen=True)
class Penetration:
    """Limbs inside surfaces, over all frames of a motion.

    Attributes:
        share: of the frames in which a limb is inside by more than 1 cm, 0 to 1.
        mean_cm: of those frames, how deep the deepest limb is, centimetres; 0 where there are none.
        max_cm: the deepest of all, centimetres.
    """

    share: float
    mean_cm: float
    max_cm: float

    def as_dict(self) -> dict[str, float]:
        """Plain numbers by name, for JSON."""
        return asdict(self)

    @classmethod
    def of(cls, depths: Floats) -> Penetration:
        """From the depths ``(F,)`` in centimetres of :func:`penetration_depths`."""
        inside = depths > SHALLOW_CM
        mean = float(depths[inside].mean()) if inside.any() else 0.0
        return cls(float(inside.mean()), mean, float(depths.max(initial=0.0)))


def penetration(positions: npt.ArrayLike, surfaces: npt.ArrayLike) -> Penetration:
    """Measure a motion in a scene.

    Args:
        positions: ``(F, 24, 3)`` global joints of ``smpl24``, metres.
        surfaces: ``(N, 3)`` points on everything that limbs shall keep out of, metres, at most about 10 cm apart; not
            the ground.

    Raises:
        InvalidInputError: other shapes, or numbers that are not finite.
    """
    return Penetration.of(penetration_depths(positions, surfaces))


def penetration_depths(positions: npt.ArrayLike, surfaces: npt.ArrayLike) -> Floats:
    """``(F,)`` centimetres: how deep the deepest limb is inside a surface in each frame, 0 where none is."""
    joints, cloud = np.asarray(positions, dtype=np.float64), checked_surfaces(surfaces)
    if joints.ndim != 3 or joints.shape[1:] != (len(SMPL24), 3) or not len(joints):
        raise InvalidInputError(f"positions must have the shape (F, {len(SMPL24)}, 3), not {joints.shape}")
    if not np.isfinite(joints).all():
        raise InvalidInputError("positions must be finite numbers")
    if not len(cloud):
        return np.zeros(len(joints))
    return np.asarray(100 * ball_depths(joints, Surfaces(cloud)).max(axis=1))


def checked_surfaces(surfaces: npt.ArrayLike) -> Floats:
    """Points ``(N, 3)`` as float64.

    Raises:
        InvalidInputError: another shape, or numbers that are not finite.
    """
    cloud = checked_array(surfaces, "surfaces", "points (N, 3) in metres")
    if cloud.ndim != 2 or cloud.shape[1] != 3 or not np.isfinite(cloud).all():
        raise InvalidInputError(f"surfaces must be finite points (N, 3) in metres, not an array of shape {cloud.shape}")
    return cloud


def ball_depths(joints: Floats, surfaces: Surfaces) -> Floats:
    """``(F, B)`` metres: how deep each ball along the bones of joints ``(F, 24, 3)`` is inside a surface."""
    balls, thick = limb_balls(joints)
    away = surfaces.distance(balls.reshape(-1, 3), float(thick.max())).reshape(balls.shape[:2])
    return np.maximum(thick - away, 0.0)


def limb_balls(joints: Floats) -> tuple[Floats, Floats]:
    """``(F, B, 3)`` middles of the balls along all bones of joints ``(F, 24, 3)``, and ``(B,)`` their radii."""
    start, end = joints[:, _STARTS], joints[:, _ENDS]
    return start + _SHARES[:, None] * (end - start), _RADII


class Surfaces:
    """Points as pieces of planes: between the points of a wall there is wall."""

    def __init__(self, cloud: Floats) -> None:
        from scipy.spatial import cKDTree

        self._cloud, self._tree = cloud, cKDTree(cloud)
        away, near = self._tree.query(cloud, k=min(_NEIGHBOURS, len(cloud)))
        near = near.reshape(len(cloud), -1)
        self._gap = np.asarray(away).reshape(len(cloud), -1)[:, 1:4].mean(axis=1) if near.shape[1] > 1 else away * 0.0
        pieces = cloud[near] - cloud[near].mean(axis=1, keepdims=True)
        spread, axes = np.linalg.eigh(np.einsum("nki,nkj->nij", pieces, pieces))
        self._normal = axes[:, :, 0]
        self._plane = (spread[:, 0] < _FLAT**2 * spread[:, 1]) & (near.shape[1] > 3)

    def distance(self, places: Floats, most: float) -> Floats:
        """``(N,)`` metres from places ``(N, 3)``; infinite where it is more than ``most`` for sure."""
        return np.asarray(self.away(places, most)[0])

    def away(self, places: Floats, most: float) -> tuple[Floats, Floats]:
        """The same, and ``(N, 3)`` the directions of length 1 that lead away from the surface; 0 where none is near."""
        parts = [self._part(places[i : i + _CHUNK], most) for i in range(0, len(places), _CHUNK)]
        distances, directions = zip(*parts, strict=True)
        return np.concatenate(distances), np.concatenate(directions)

    def _part(self, places: Floats, most: float) -> tuple[Floats, Floats]:
        reach = most + float(self._gap.max(initial=0.0))
        away, near = self._tree.query(places, distance_upper_bound=reach)
        out, ways = np.asarray(away, dtype=np.float64), np.zeros_like(places)
        found = np.flatnonzero(np.isfinite(away))
        nearest = near[found]
        offset = places[found] - self._cloud[nearest]
        across = (offset * self._normal[nearest]).sum(axis=1)
        beside = np.sqrt(np.maximum((offset**2).sum(axis=1) - across**2, 0.0))
        fits = self._plane[nearest] & (beside <= self._gap[nearest])
        out[found[fits]] = np.abs(across[fits])
        offset[fits] = np.sign(across[fits])[:, None] * self._normal[nearest[fits]]
        ways[found] = offset / np.maximum(np.linalg.norm(offset, axis=1, keepdims=True), 1e-9)
        return out, ways
