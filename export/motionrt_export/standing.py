"""Frames seen from where a body stands, in columns that make it cheap: all x that turn, all z that turn, the rest."""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor

from motionrt_training.networks.walknet import goal_features, turned_wish

TURNING = 4  # vectors of a frame that turn with it: three columns of the pelvis, and the root
_X, _Y, _Z = ([*range(3 * axis, 3 * axis + 3), 216 + axis] for axis in range(3))
ORDER = (*_X, *_Z, *_Y, *range(9, 216))
"""The columns of `ccf219` in that order; the first 12 are those of pelvis and root."""


def ordered(frames: Tensor) -> Tensor:
    """(B, T, 219) with the columns in `ORDER`: few are picked, the rest is cut out in pieces, which is faster."""
    turning = frames[:, :, torch.tensor(ORDER[: 2 * TURNING])]
    return joined(turning, frames[:, :, 3:6], frames[:, :, 217:218], frames[:, :, 9:216])


def in_columns(frames: Tensor) -> Tensor:
    """Inverse of `ordered`."""
    x, root_x, z, root_z, y, root_y, joints = frames.split((3, 1, 3, 1, 3, 1, 207), dim=2)
    return joined(x, y, z, joints, root_x, root_y, root_z)


class Standing(NamedTuple):
    """Heading and place of a body on the ground: cos and sin (B, 1, 1), x and z (B, 1, 4) of what turns, or 0."""

    cos: Tensor
    sin: Tensor
    x: Tensor | float
    z: Tensor | float

    @classmethod
    def of(cls, frame: Tensor) -> Standing:
        """Of a frame (B, 1, >= 8) in `ORDER`; the place counts for the root alone."""
        cos, sin = frame[:, :, TURNING + 2 : TURNING + 3], frame[:, :, 2:3]
        length = (cos * cos + sin * sin).clamp(min=1e-8).sqrt()
        root = torch.tensor([0.0] * (TURNING - 1) + [1.0])
        return cls(cos / length, sin / length, frame[:, :, :TURNING] * root, frame[:, :, TURNING : 2 * TURNING] * root)

    def turn(self) -> Standing:
        """The heading alone."""
        return self._replace(x=0.0, z=0.0)

    def wish(self, wish: Tensor) -> Tensor:
        """What is wished (B, 8), as it is seen from here."""
        return turned_wish(wish, torch.cat((self.cos, self.sin), dim=2)[:, 0])

    def goal(self) -> Tensor:
        """The origin as it is seen from here, (B, 7)."""
        x, z = self.x[:, 0, -1:], self.z[:, 0, -1:]
        return goal_features(
            torch.cat((self.cos, self.sin), dim=2)[:, 0], torch.cat((x, torch.zeros_like(x), z), dim=1)
        )


def seen(frames: Tensor, body: Standing) -> Tensor:
    """(B, T, >= 8) in `ORDER` as the body sees it."""
    x, z = frames[:, :, :TURNING] - body.x, frames[:, :, TURNING : 2 * TURNING] - body.z
    return joined(body.cos * x - body.sin * z, body.cos * z + body.sin * x, frames[:, :, 2 * TURNING :])


def unseen(frames: Tensor, body: Standing) -> Tensor:
    """Inverse of `seen`."""
    x, z = frames[:, :, :TURNING], frames[:, :, TURNING : 2 * TURNING]
    x, z = body.cos * x + body.sin * z + body.x, body.cos * z - body.sin * x + body.z
    return joined(x, z, frames[:, :, 2 * TURNING :])


def joined(*parts: Tensor) -> Tensor:
    """Columns beside each other."""
    return torch.cat(parts, dim=2)
