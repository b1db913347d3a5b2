"""TransNet against spherical interpolation and against real motion, on held-out windows.

    python -m motionrt_training.evaluate.transitions --corpus runs/recordings.npz --checkpoint runs/transnet/best.pt

Every window shows 60 frames and the pose of frame 119; frames 60 to 118 are filled. Foot skate is that of the filled
frames, by the same code for all rows.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
import numpy.typing as npt

from motionrt.locomotion.bearings import joined
from motionrt.locomotion.goal_frame import canonicalise
from motionrt.locomotion.stepped_transitions import with_steps
from motionrt.locomotion.transitions import goal_of, locked
from motionrt.metrics.locomotion import foot_skate, keypoint_error
from motionrt.models import Sessions
from motionrt.models.transnet import SEED, WINDOW, TransitionModel
from motionrt.motion import Motion
from motionrt.motion.features import ccf219
from motionrt.motion.features.ccf219 import FPS
from motionrt.motion.rotations import matrix_to_quaternion, quaternion_to_matrix, slerp
from motionrt.motion.skeleton import FloatArray
from motionrt_training.checkpoint import load_state
from motionrt_training.corpora.recordings import Recordings, load_recordings
from motionrt_training.evaluate.tables import markdown

FAR = 0.5  # metres between frames 59 and 119: the person goes somewhere
CHUNK = 50  # windows that are filled at once

Infill = Callable[[FloatArray, npt.NDArray[np.bool_]], FloatArray]
Fill = Callable[[list[Motion]], list[Motion]]


@dataclass(frozen=True)
class Row:
    """Means over windows. Steps at the seams are changes of the root's velocity from frame to frame, m/s."""

    windows: int
    joint_cm: float
    pose_cm: float  # joints about the pelvis
    skate: float  # cm per frame
    seed_step: float
    end_step: float
    end_cm: float  # joints of the last frame against the target


def held_out(recordings: Recordings, split: str, count: int) -> list[Motion]:
    """Up to ``count`` windows of 120 frames, evenly over a split, each seen from its last frame."""
    windows = list(_windows(recordings, split))
    pick = np.unique(np.linspace(0, len(windows) - 1, min(count, len(windows))).round().astype(int))
    return [windows[i]() for i in pick]


def _windows(recordings: Recordings, split: str) -> Iterator[Callable[[], Motion]]:
    for _, motion in recordings.split(split):
        for start in range(motion.frames - WINDOW + 1):
            yield partial(_from_the_end, motion, start)


def _from_the_end(motion: Motion, start: int) -> Motion:
    window = motion[start : start + WINDOW]
    return canonicalise(window, goal_of(window[WINDOW - 1 :]))


def interpolate(window: Motion) -> Motion:
    """The gap filled by spherical interpolation of the rotations, the root on a straight line."""
    share = (np.arange(WINDOW - SEED + 1) / (WINDOW - SEED)).astype(np.float32)
    ends = matrix_to_quaternion(window.rotations[[SEED - 1, WINDOW - 1]])
    between = quaternion_to_matrix(slerp(ends[:1], ends[1:], share[:, None])).astype(np.float32)
    root = window.root[SEED - 1] + share[:, None] * (window.root[WINDOW - 1] - window.root[SEED - 1])
    rotations, roots = window.rotations.copy(), window.root.copy()
    rotations[SEED:], roots[SEED:] = between[1:], root[1:]
    return dataclasses.replace(window, rotations=rotations, root=roots)


def filled(model: Infill, windows: Sequence[Motion]) -> list[Motion]:
    """The gaps of all windows filled by TransNet."""
    hidden = (np.arange(WINDOW) >= SEED) & (np.arange(WINDOW) < WINDOW - 1)
    out = []
    for first in range(0, len(windows), CHUNK):
        frames = np.stack([ccf219.encode(window) for window in windows[first : first + CHUNK]])
        seen = np.where(hidden[:, None], 0, frames).astype(np.float32)
        out += [ccf219.decode(x) for x in model(seen, np.tile(hidden, (len(frames), 1)))]
    return out


def stepped(window: Motion) -> Motion:
    """A window whose feet step in the gap, as in performances."""
    return joined([window[:SEED], with_steps(window[:SEED], window[SEED:])])


def measure(found: Sequence[Motion], truth: Sequence[Motion]) -> Row:
    """Means over windows of one way to fill them."""
    rows = np.array([_measures(a, b) for a, b in zip(found, truth, strict=True)])
    return Row(len(rows), *(float(x) for x in rows.mean(axis=0)))


def _measures(found: Motion, truth: Motion) -> list[float]:
    a, b = found.positions()[SEED:-1], truth.positions()[SEED:-1]
    velocity = np.diff(found.root, axis=0) * FPS
    step = np.linalg.norm(np.diff(velocity, axis=0), axis=1)  # step[i]: at frame i + 1
    return [
        keypoint_error(a, b),
        keypoint_error(a - a[:, :1], b - b[:, :1]),
        foot_skate(found.positions()[SEED - 1 :]),
        float(step[SEED - 2]),
        float(step[WINDOW - 3]),
        keypoint_error(found.positions()[-1], truth.positions()[-1]),
    ]


def goes_somewhere(window: Motion) -> bool:
    """Whether the root travels further than FAR in the gap."""
    return bool(np.linalg.norm((window.root[-1] - window.root[SEED - 1])[[0, 2]]) > FAR)


def compare(fills: dict[str, Fill], windows: list[Motion]) -> dict[str, dict[str, Row]]:
    """For all windows and for those that go somewhere, a row for each way to fill them."""
    far = [goes_somewhere(window) for window in windows]
    parts = {"all": np.full(len(windows), True), f"root travels > {FAR} m": np.array(far)}
    found = {name: fill(windows) for name, fill in fills.items()}
    return {
        part: {
            name: measure(*([m for m, keep in zip(group, chosen, strict=True) if keep] for group in (motions, windows)))
            for name, motions in found.items()
        }
        for part, chosen in parts.items()
    }


def table(result: dict[str, dict[str, Row]]) -> str:
    """The comparison in Markdown."""
    head = ["windows", "filled by", *(field.name for field in dataclasses.fields(Row)[1:])]
    body = [
        [f"{part} ({row.windows})", name, *(f"{value:.2f}" for value in dataclasses.astuple(row)[1:])]
        for part, rows in result.items()
        for name, row in rows.items()
    ]
    return markdown(head, body)


def torch_model(checkpoint: Path) -> Infill:
    """The network of a checkpoint of the trainer."""
    import torch

    from motionrt_training.networks.transnet import TransNet

    state = load_state(checkpoint)
    net = TransNet(**state["notes"]["network"])
    net.load_state_dict(state["model"])
    net.eval()

    def infill(frames: FloatArray, hidden: npt.NDArray[np.bool_]) -> FloatArray:
        with torch.no_grad():
            return np.asarray(net(torch.from_numpy(frames), torch.from_numpy(hidden)).numpy())

    return infill


def parser() -> argparse.ArgumentParser:
    """Every option with its default."""
    result = argparse.ArgumentParser(description="Compare TransNet with interpolation and with real motion.")
    result.add_argument("--corpus", type=Path, required=True, help="recordings (.npz)")
    result.add_argument("--checkpoint", type=Path, help="checkpoint of the trainer; otherwise the exported model")
    result.add_argument("--models", type=Path, help="manifest of exported models (default: the shipped ones)")
    result.add_argument("--variant", help="variant of the exported model")
    result.add_argument("--split", default="test", help="train, val or test")
    result.add_argument("--count", type=int, default=500, help="windows")
    result.add_argument("--json", action="store_true", help="print JSON instead of a table")
    return result


def main(arguments: Sequence[str] | None = None) -> None:
    """The command line."""
    args = parser().parse_args(arguments)
    model = torch_model(args.checkpoint) if args.checkpoint else TransitionModel(Sessions(args.models), args.variant)
    fills: dict[str, Fill] = {
        "real motion": list,
        "interpolation": lambda windows: [interpolate(window) for window in windows],
        "TransNet": lambda windows: filled(model, windows),
        "TransNet, feet locked": lambda windows: [locked(motion) for motion in filled(model, windows)],
        "TransNet, with steps, locked": lambda windows: [locked(stepped(m)) for m in filled(model, windows)],
    }
    result = compare(fills, held_out(load_recordings(args.corpus), args.split, args.count))
    if args.json:
        print(json.dumps({k: {n: dataclasses.asdict(r) for n, r in rows.items()} for k, rows in result.items()}))
    else:
        print(table(result))


if __name__ == "__main__":
    main()
