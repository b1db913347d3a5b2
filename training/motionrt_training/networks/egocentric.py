"""`sinc135` as the character feels it: how it turns and moves from frame to frame, instead of where it stands.

A walk is the same few numbers wherever it leads, and errors of single frames do not shake the body's place. Per frame:
0 turn to the next frame (radians, +Z towards +X), 1:3 step to the next frame (metres, to its left and forward), 3
height, 4:10 the pelvis without its heading as 6D, 10:136 the other 21 joints as in `sinc135`. The heading is that of
the pelvis' left axis crossed with up, which a body that lies or bends has, too.
"""

from __future__ import annotations

import torch
import torch.nn.functional as F
from torch import Tensor

from motionrt.motion import SMPL24

WIDTH = 136
TURN, STEP, HEIGHT, TILT, JOINTS = slice(0, 1), slice(1, 3), slice(3, 4), slice(4, 10), slice(10, 136)
GROUPS = (TURN, STEP, HEIGHT, TILT, JOINTS)
RATES = slice(0, 3)  # per frame: they scale with the speed of the motion


def to_egocentric(motion: Tensor) -> Tensor:
    """Raw `sinc135` (B, F, 135) -> (B, F, 136); the last frame turns and moves no further."""
    left = motion[..., :3]  # first column of the pelvis' rotation
    heading = _unit(torch.stack((-left[..., 2], left[..., 0]), dim=-1))  # (sin, cos) of the yaw
    after = torch.cat((heading[:, 1:], heading[:, -1:]), dim=1)
    turn = (after[..., :1] * heading[..., 1:] - after[..., 1:] * heading[..., :1]).clamp(-1.0, 1.0).asin()
    place = motion[..., 132:134]
    change = torch.cat((place[:, 1:], place[:, -1:]), dim=1) - place
    tilt = torch.cat((_turned(motion[..., :3], heading, -1.0), _turned(motion[..., 3:6], heading, -1.0)), dim=-1)
    return torch.cat((turn, _planar(change, heading, -1.0), motion[..., 134:], tilt, motion[..., 6:132]), dim=-1)


def from_egocentric(frames: Tensor) -> Tensor:
    """(B, F, 136) -> raw `sinc135` (B, F, 135) that starts above the origin with its heading along +Z."""
    yaw = _before(frames[..., TURN].cumsum(1))
    heading = torch.cat((yaw.sin(), yaw.cos()), dim=-1)
    place = _before(_planar(frames[..., STEP], heading, 1.0).cumsum(1))
    first = _turned(frames[..., 4:7], heading, 1.0)
    second = _turned(frames[..., 7:10], heading, 1.0)
    return torch.cat((first, second, frames[..., JOINTS], place, frames[..., HEIGHT]), dim=-1)


def mirrored(frames: Tensor) -> Tensor:
    """The mirror image of (..., F, 136) frames, left and right exchanged."""
    sign = frames.new_tensor([1.0, -1.0, -1.0, -1.0, 1.0, 1.0])
    partners = [SMPL24.mirrored_joints[joint] - 1 for joint in range(1, 22)]
    joints = frames[..., JOINTS].unflatten(-1, (21, 6))[..., partners, :] * sign
    head = frames[..., :10] * torch.cat((frames.new_tensor([-1.0, -1.0, 1.0, 1.0]), sign))
    return torch.cat((head, joints.flatten(-2)), dim=-1)


def rotations(frames: Tensor) -> Tensor:
    """(..., 136) -> local rotations (..., 24, 3, 3) with the pelvis' heading along +Z; hands as the wrists are."""
    sixd = frames[..., 4:].unflatten(-1, (22, 6))
    x = _unit(sixd[..., :3])
    y = _unit(sixd[..., 3:] - (x * sixd[..., 3:]).sum(-1, keepdim=True) * x)
    found = torch.stack((x, y, torch.linalg.cross(x, y)), dim=-1)
    hands = torch.eye(3, device=found.device).expand(*found.shape[:-3], 2, 3, 3)
    return torch.cat((found, hands), dim=-3)


def _unit(x: Tensor) -> Tensor:
    return x / (x.square().sum(-1, keepdim=True) + 1e-12).sqrt()


def _before(sums: Tensor) -> Tensor:
    """Sums over the frames before each."""
    return F.pad(sums[:, :-1], (0, 0, 1, 0))


def _planar(x: Tensor, heading: Tensor, sense: float) -> Tensor:
    """Turn (x, z) (..., 2) by the heading (sin, cos), or back with sense -1."""
    sine, cosine = sense * heading[..., 0], heading[..., 1]
    return torch.stack((cosine * x[..., 0] + sine * x[..., 1], cosine * x[..., 1] - sine * x[..., 0]), dim=-1)


def _turned(x: Tensor, heading: Tensor, sense: float) -> Tensor:
    """Turn vectors (..., 3) about Y."""
    planar = _planar(torch.stack((x[..., 0], x[..., 2]), dim=-1), heading, sense)
    return torch.stack((planar[..., 0], x[..., 1], planar[..., 1]), dim=-1)
