"""WalkNet: the next frames of a walk towards a goal, from the last ones  [Continual 3.3].

Frames stand in the goal's frame, as in the paper. Inside, the network looks at them from where the last one stands:
the same step in another direction then looks the same, and much less data is needed. It sees, of every frame, the
pose, its change since the frame before, and where the goal lies; it predicts changes of the last frame.

Beside a goal there may be wishes: a velocity (as of a stick; it takes the place of the goal), a facing that is
independent of the way, and the speed to arrive with.
"""

from __future__ import annotations

from typing import Any

import torch
from torch import Tensor, nn

from motionrt.motion.features.ccf219 import WIDTH
from motionrt_training.networks.motion_transformer import MotionTransformer

FRAMES = 30  # K: frames in and frames out
GOAL = 7  # direction (2), distance in three scales, heading (2)
WISHES = 8
"""Columns of a wish: 1 and a velocity (x, z) m/s, 1 and a facing (x, z) of length 1, 1 and the speed m/s to arrive
with; zeros where nothing of the kind is wished. Velocity and facing stand in the frame that the frames stand in."""
DISTANCES = (0.3, 1.0, 3.0)  # metres: scales on which the distance of the goal is seen
NEAR = 0.25  # metres: nearer than this the direction of the goal fades


class WalkNet(nn.Module):
    """(B, 30, 219) `ccf219` in the goal's frame and the wanted speed -> the next (B, 30, 219)."""

    pose_mean: Tensor  # (219,) of frames seen from the last one
    pose_std: Tensor  # (219,)
    rate_std: Tensor  # (219,) of changes between neighbours
    change_std: Tensor  # (30, 219) of changes since the last frame
    still: Tensor  # (219,) 1 for columns that never change, as those of a hinge do

    def __init__(
        self,
        d: int = 512,
        layers: int = 3,
        heads: int = 8,
        ff: int = 1024,
        dropout: float = 0.0,
        patch: int = 1,
        wishes: bool = False,
    ) -> None:
        super().__init__()
        self.config = {"d": d, "layers": layers, "heads": heads, "ff": ff, "dropout": dropout, "patch": patch}
        self.wishes = wishes
        if wishes:
            self.config["wishes"] = True
        heard = GOAL + 1 + WISHES * wishes
        self.body = MotionTransformer(2 * WIDTH + heard, WIDTH, d, layers, heads, ff, dropout, patch)
        self.register_load_state_dict_pre_hook(_widen)
        self.register_buffer("pose_mean", torch.zeros(WIDTH))
        self.register_buffer("pose_std", torch.ones(WIDTH))
        self.register_buffer("rate_std", torch.ones(WIDTH))
        self.register_buffer("change_std", torch.ones(FRAMES, WIDTH))
        self.register_buffer("still", torch.zeros(WIDTH))

    def forward(self, frames: Tensor, speed: Tensor, wish: Tensor | None = None) -> Tensor:
        """Frames (B, 30, 219) in the goal's frame, speed (B,) m/s -> the next frames (B, 30, 219), same frame.

        ``wish`` (B, 8) holds the columns of :data:`WISHES`, for a network that was made with them.
        """
        local, turn, place = to_body(frames)
        local = self.settled(local)
        changes = self.body(self.inputs(local, turn, place, speed, wish)).float() * (1.0 - self.still)
        return from_body(local[:, -1:] + changes * self.change_std, turn, place)

    def settled(self, local: Tensor) -> Tensor:
        """Columns that never change, as they always are: nothing in the data would bring them back from an error."""
        return local * (1.0 - self.still) + self.pose_mean * self.still

    def inputs(self, local: Tensor, turn: Tensor, place: Tensor, speed: Tensor, wish: Tensor | None = None) -> Tensor:
        """(B, 30, 446 or 454): normalised pose, its rate, the goal as seen from the body, the speed, the wishes."""
        pose = (local - self.pose_mean) / self.pose_std
        rate = (local[:, 1:] - local[:, :-1]) / self.rate_std
        rate = torch.cat((rate[:, :1], rate), dim=1)
        aim = torch.cat((goal_features(turn, place), speed[:, None] - 1.0), dim=1)  # (B, 8)
        if self.wishes:
            wish = aim.new_zeros(len(aim), WISHES) if wish is None else wish
            aim = torch.cat((aim * (1.0 - wish[:, :1]), turned_wish(wish, turn)), dim=1)
        return torch.cat((pose, rate, aim[:, None].expand(-1, local.shape[1], -1)), dim=2)


def heading_turn(pelvis: Tensor) -> Tensor:
    """Pelvis rotation (B, 9), row by row -> (cos, sin) (B, 2) of its yaw, from its forward axis."""
    forward = torch.stack((pelvis[:, 8], pelvis[:, 2]), dim=1)  # z and x of the third column
    return forward / forward.square().sum(1, keepdim=True).clamp(min=1e-8).sqrt()


def to_body(frames: Tensor) -> tuple[Tensor, Tensor, Tensor]:
    """Frames seen from the last one: heading +Z, above the origin; also its (cos, sin) and its place (B, 3)."""
    turn = heading_turn(frames[:, -1, :9])
    place = frames[:, -1, 216:] * frames.new_tensor([1.0, 0.0, 1.0])
    return seen_from(frames, turn, place), turn, place


def seen_from(frames: Tensor, turn: Tensor, place: Tensor) -> Tensor:
    """(B, T, 219) as a body sees it whose heading has the (cos, sin) `turn` and who stands at `place`."""
    back = turn * turn.new_tensor([1.0, -1.0])
    return torch.cat((_turned(frames, back), yawed(frames[..., 216:] - place[:, None], back)), dim=2)


def from_body(frames: Tensor, turn: Tensor, place: Tensor) -> Tensor:
    """Inverse of `seen_from`."""
    return torch.cat((_turned(frames, turn), yawed(frames[..., 216:], turn) + place[:, None]), dim=2)


def goal_features(turn: Tensor, place: Tensor) -> Tensor:
    """The goal (the origin, heading +Z) seen from a body there: (B, 7)."""
    offset = yawed(-place[:, None], turn * turn.new_tensor([1.0, -1.0]))[:, 0, ::2]  # (B, 2): to the left, ahead
    distance = (offset.square().sum(1, keepdim=True) + 1e-8).sqrt()
    scales = torch.cat([distance / (distance + scale) for scale in DISTANCES], dim=1)
    return torch.cat((offset / (distance + NEAR), scales, turn[:, :1], -turn[:, 1:]), dim=1)


def turned_wish(wish: Tensor, turn: Tensor) -> Tensor:
    """Wishes (B, 8) as a body sees them whose heading has the (cos, sin) `turn`."""
    back = turn * turn.new_tensor([1.0, -1.0])
    zero = torch.zeros_like(wish[:, :1])
    vectors = torch.cat((wish[:, 1:2], zero, wish[:, 2:3], wish[:, 4:5], zero, wish[:, 5:6]), dim=1).unflatten(
        1, (2, 3)
    )
    vectors = yawed(vectors, back)[..., ::2]  # (B, 2, 2)
    return torch.cat((wish[:, :1], vectors[:, 0], wish[:, 3:4], vectors[:, 1], wish[:, 6:]), dim=1)


def with_wishes(source: WalkNet) -> WalkNet:
    """A network that hears of wishes, and does not mind them yet; else the same."""
    made = WalkNet(**{**source.config, "wishes": True})  # type: ignore[arg-type]
    made.load_state_dict(source.state_dict())
    return made.train(source.training)


def _widen(module: nn.Module, state: dict[str, Any], prefix: str, *_: Any) -> None:
    """Weights without wishes fit a network with them: what it hears of wishes begins at zero."""
    assert isinstance(module, WalkNet)
    name, wanted = f"{prefix}body.embed.weight", module.body.embed.weight.shape[1]
    if name in state and module.wishes and state[name].shape[1] == wanted - module.body.patch * WISHES:
        columns = state[name].unflatten(1, (module.body.patch, -1))
        state[name] = nn.functional.pad(columns, (0, WISHES)).flatten(1)


def yawed(vectors: Tensor, turn: Tensor) -> Tensor:
    """Vectors (B, T, 3, ...) turned about Y by (cos, sin) (B, 2); element by element, so float32 under autocast."""
    shape = (-1, 1, *(1 for _ in vectors.shape[3:]))
    c, s = turn[:, 0].reshape(shape), turn[:, 1].reshape(shape)
    x, y, z = vectors.unbind(2)
    return torch.stack((c * x + s * z, y, c * z - s * x), dim=2)


def _turned(frames: Tensor, turn: Tensor) -> Tensor:
    """Rotations (B, T, 216) of (B, T, 219), the pelvis turned."""
    pelvis = yawed(frames[..., :9].unflatten(-1, (3, 3)), turn).flatten(2)
    return torch.cat((pelvis, frames[..., 9:216]), dim=2)
