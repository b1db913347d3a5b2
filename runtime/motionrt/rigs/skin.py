"""The skin of a user's character: a mesh whose vertices follow joints, and what it looks like in a pose."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from motionrt.motion.skeleton import FloatArray

Indices = npt.NDArray[np.int64]
Bytes = npt.NDArray[np.uint8]
INFLUENCES = 4  # joints that move one vertex
_ROUNDS = 8


@dataclass(frozen=True, eq=False)
class Skin:
    """A mesh on a skeleton of ``J`` joints; lengths in the unit of the rig.

    A vertex stands where its joints put it: the sum over ``k`` of ``weights[k] * (place + turn @ local[k])``, with the
    place and the turn of joint ``joints[k]``.

    Attributes:
        faces: ``(T, 3)`` vertices of triangles, counter-clockwise from outside.
        colours: ``(T, 3)`` uint8, red, green and blue of every triangle.
        joints: ``(V, 4)`` joints that move each vertex.
        weights: ``(V, 4)`` float32, rows sum to 1.
        local: ``(V, 4, 3)`` float32, where the vertex is as seen from each of its joints.
    """

    faces: Indices
    colours: Bytes
    joints: Indices
    weights: FloatArray
    local: FloatArray

    def at(self, places: FloatArray, turns: FloatArray) -> FloatArray:
        """``(V, 3)`` the vertices in a pose.

        Args:
            places: ``(J, 3)`` where the joints are.
            turns: ``(J, 3, 3)`` how they are turned, globally.
        """
        seen = np.einsum("vkij,vkj->vki", turns[self.joints], self.local) + places[self.joints]
        return np.asarray((self.weights[..., None] * seen).sum(axis=1), dtype=np.float32)

    def dense_weights(self, joints: int) -> FloatArray:
        """``(V, joints)`` the weights with a column for every joint."""
        out = np.zeros((len(self.joints), joints), np.float32)
        np.add.at(out, (np.arange(len(out))[:, None], self.joints), self.weights)
        return out

    def part(self, chosen: npt.NDArray[np.bool_]) -> Skin:
        """The triangles that are chosen ``(T,)``, with the vertices that they need."""
        used, faces = np.unique(self.faces[chosen], return_inverse=True)
        return Skin(
            faces.reshape(-1, 3), self.colours[chosen], self.joints[used], self.weights[used], self.local[used]
        )  # fmt: skip

    def with_fewer_colours(self, most: int) -> Skin:
        """The same in at most so many colours."""
        return replace(self, colours=fewer_colours(self.colours, most))


def joined(skins: Sequence[Skin]) -> Skin:
    """Several meshes on one skeleton as one."""
    starts = np.cumsum([0, *(len(skin.joints) for skin in skins)])
    return Skin(
        np.concatenate([skin.faces + start for skin, start in zip(skins, starts, strict=False)]),
        np.concatenate([skin.colours for skin in skins]),
        np.concatenate([skin.joints for skin in skins]),
        np.concatenate([skin.weights for skin in skins]),
        np.concatenate([skin.local for skin in skins]),
    )


def fewer_colours(colours: Bytes, most: int) -> Bytes:
    """Colours ``(N, 3)``, each replaced by the nearest of at most ``most`` that stand for all of them.

    The first is the commonest, each further one the farthest from those before, weighed by how common it is; a few
    rounds of k-means make them means of what they stand for.
    """
    coarse, where, counts = np.unique(colours >> 3, axis=0, return_inverse=True, return_counts=True)
    where, shades = where.reshape(-1), len(coarse)
    means = np.stack([np.bincount(where, colours[:, c], shades) for c in range(3)], axis=1) / counts[:, None]
    centres = means[[int(np.argmax(counts))]]
    while len(centres) < min(most, shades):
        gaps = ((means[:, None] - centres) ** 2).sum(axis=2).min(axis=1)
        if not gaps.any():
            break
        centres = np.vstack([centres, means[int(np.argmax(gaps * np.sqrt(counts)))]])
    for _ in range(_ROUNDS):
        nearest = ((means[:, None] - centres) ** 2).sum(axis=2).argmin(axis=1)
        total = np.maximum(np.bincount(nearest, counts, len(centres)), 1e-9)
        sums = np.stack([np.bincount(nearest, counts * means[:, c], len(centres)) for c in range(3)], axis=1)
        centres = np.where((np.bincount(nearest, minlength=len(centres)) > 0)[:, None], sums / total[:, None], centres)
    nearest = ((means[:, None] - centres) ** 2).sum(axis=2).argmin(axis=1)
    return np.asarray(np.round(centres)[nearest][where], dtype=np.uint8)
