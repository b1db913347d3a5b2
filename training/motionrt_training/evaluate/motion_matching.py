"""Motion matching over the recorded walks, a baseline for WalkNet: the same clips, paths and measures.

    python -m motionrt_training.evaluate.motion_matching --corpus runs/recordings.npz --paths 20

Every third of a second the frame of the recordings is looked for whose feet, hips and next second fit best to what the
character does and where its path leads; what is played meanwhile is the recording. At a change the difference of the
poses fades out. It is small and plain: no search tree, no tuned weights, no correction of the way but by the search.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path as FilePath

import numpy as np
import numpy.typing as npt

from motionrt.errors import InvalidInputError
from motionrt.locomotion import Path
from motionrt.metrics import footing
from motionrt.metrics.locomotion import path_deviation
from motionrt.motion import SMPL24, Motion
from motionrt.motion.feet.lock import lock_feet
from motionrt.motion.rotations import axis_angle_to_matrix, axis_rotation, matrix_to_axis_angle
from motionrt.motion.transforms import heading
from motionrt_training.command import reports_errors
from motionrt_training.corpora.recordings import FPS, load_recordings
from motionrt_training.corpora.walks import stretches
from motionrt_training.evaluate.tables import markdown

AHEAD = (10, 20, 30)  # frames of the way that is compared
EVERY = 10  # frames between searches
FADE_S = 0.1  # seconds in which half of a difference of poses fades
SPEED = 1.2  # m/s
WAY, FEET = 1.0, 1.0  # weights of the two halves of a row
_FEET = [SMPL24.index(f"{side}_foot") for side in ("left", "right")]

Values = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Clips:
    """Recorded walks as rows to search.

    Attributes:
        motions: the walks, at 30 fps.
        rows: ``(N, 27)`` scaled: way and looks of the next second, feet, their speeds, the speed of the hips.
        places: ``(N, 2)`` clip and frame of each row.
        yaws: ``(F,)`` radians of each walk, without jumps.
        bodies: ``(F, 15)`` of each walk, see :func:`body_rows`.
        mean: ``(27,)`` of the rows before they were scaled.
        scale: ``(27,)`` that they were multiplied by.
    """

    motions: tuple[Motion, ...]
    rows: Values
    places: npt.NDArray[np.int64]
    yaws: tuple[Values, ...]
    bodies: tuple[Values, ...]
    mean: Values
    scale: Values

    @classmethod
    def of(cls, motions: Sequence[Motion]) -> Clips:
        """Rows of every frame that has a second behind it.

        Raises:
            InvalidInputError: no motion is that long.
        """
        found = [(number, clip_rows(motion)) for number, motion in enumerate(motions)]
        rows = [rows for _, rows in found if len(rows)]
        if not rows:
            raise InvalidInputError("no recording is longer than a second")
        places = [np.stack([np.full(len(r), n), np.arange(len(r))], axis=1) for n, r in found if len(r)]
        every = np.concatenate(rows)
        mean, spread = every.mean(axis=0), every.std(axis=0)
        groups = (slice(0, 6), slice(6, 12), slice(12, 18), slice(18, 24), slice(24, 27))
        scale = np.empty_like(mean)
        for group in groups:
            weight = WAY if group.stop <= 12 else FEET
            scale[group] = weight / max(float(spread[group].mean()), 1e-6)
        yaws = tuple(np.unwrap(heading(motion)).astype(np.float64) for motion in motions)
        bodies = tuple(body_rows(motion) for motion in motions)
        return cls(tuple(motions), (every - mean) * scale, np.concatenate(places), yaws, bodies, mean, scale)

    def pose(self, clip: int, frame: int) -> Values:
        """``(24, 3, 3)`` of a frame, its heading taken out of the pelvis."""
        pose = self.motions[clip].rotations[frame].astype(np.float64)
        pose[0] = axis_rotation("Y", -float(self.yaws[clip][frame])) @ pose[0]
        return pose

    def step(self, clip: int, frame: int) -> tuple[Values, float]:
        """(left, ahead) metres and radians from a frame to the next."""
        motion, yaws = self.motions[clip], self.yaws[clip]
        last = min(frame + 1, motion.frames - 1)
        way = (motion.root[last] - motion.root[frame])[[0, 2]].astype(np.float64)
        return _seen(way[None], yaws[frame : frame + 1])[0], float(yaws[last] - yaws[frame])

    def best(self, row: Values) -> tuple[int, int]:
        """Clip and frame that fit best to a row ``(27,)`` that is not scaled."""
        away = self.rows - (row - self.mean) * self.scale
        number, frame = self.places[int(np.einsum("ij,ij->i", away, away).argmin())]
        return int(number), int(frame)


def clip_rows(motion: Motion) -> Values:
    """``(F - 30, 27)`` rows of a motion at 30 fps, not scaled; none of one that is shorter."""
    count = motion.frames - AHEAD[-1]
    if count < 2:
        return np.zeros((0, 27))
    yaw, place = np.unwrap(heading(motion)).astype(np.float64), motion.root[:, [0, 2]].astype(np.float64)
    now = np.arange(count)
    ways = [_seen(place[now + k] - place[now], yaw[now]) for k in AHEAD]
    looks = [np.stack([np.sin(yaw[now + k] - yaw[now]), np.cos(yaw[now + k] - yaw[now])], axis=1) for k in AHEAD]
    return np.concatenate([*ways, *looks, body_rows(motion)[:count]], axis=1)


def body_rows(motion: Motion) -> Values:
    """``(F, 15)``: both feet and their speeds, and the speed of the hips, seen from the body."""
    yaw, joints = heading(motion).astype(np.float64), motion.positions().astype(np.float64)
    speeds = np.gradient(joints, axis=0) * FPS if motion.frames > 1 else np.zeros_like(joints)
    parts = [joints[:, foot] - joints[:, 0] for foot in _FEET] + [speeds[:, joint] for joint in (*_FEET, 0)]
    out = []
    for part in parts:
        flat = _seen(part[:, [0, 2]], yaw)
        out.append(np.stack([flat[:, 0], part[:, 1], flat[:, 1]], axis=1))
    return np.concatenate(out, axis=1)


def _seen(way: Values, yaw: Values) -> Values:
    """Ways ``(N, 2)`` in the world as somebody sees them who looks at ``yaw``: to the left, and ahead."""
    c, s = np.cos(yaw), np.sin(yaw)
    return np.stack([c * way[:, 0] - s * way[:, 1], s * way[:, 0] + c * way[:, 1]], axis=1)


def matched(clips: Clips, path: Path, speed: float = SPEED) -> Motion:
    """A walk along a path from its start to where its end is passed, or as long as the path takes and a third.

    Args:
        clips: the recordings.
        path: where to walk.
        speed: m/s wanted.
    """
    way = path.at([0.0, 0.5])
    yaw = float(np.arctan2(*(way[1] - way[0])))
    place = way[0].astype(np.float64)
    clip, frame = _start(clips, path, place, yaw, speed)
    rotations, roots, left = list[Values](), list[Values](), np.zeros((24, 3))
    most = int(1.33 * path.length / speed * FPS)
    keeps = 0.5 ** (1 / (FADE_S * FPS))
    for step in range(most):
        motion = clips.motions[clip]
        if step and (step % EVERY == 0 or frame + 1 >= motion.frames):
            before = clips.pose(clip, frame)
            clip, frame = clips.best(np.concatenate([_wanted(path, place, yaw, speed), clips.bodies[clip][frame]]))
            motion, now = clips.motions[clip], clips.pose(clip, frame)
            left = matrix_to_axis_angle(np.swapaxes(now, -1, -2) @ before @ axis_angle_to_matrix(left))
        moved, turned = clips.step(clip, frame)
        frame = min(frame + 1, motion.frames - 1)
        place = place + _turned(moved, yaw)
        yaw += turned
        left = left * keeps
        pose = clips.pose(clip, frame) @ axis_angle_to_matrix(left)
        pose[0] = axis_rotation("Y", yaw) @ pose[0]
        rotations.append(pose)
        roots.append(np.array([place[0], motion.root[frame, 1], place[1]]))
        if path.length - float(path.project([place])[0][0]) < 0.1:
            break
    return Motion(np.array(rotations, dtype=np.float32), np.array(roots, dtype=np.float32), FPS)


def _start(clips: Clips, path: Path, place: Values, yaw: float, speed: float) -> tuple[int, int]:
    """Any frame that goes the way wanted."""
    row = np.concatenate([_wanted(path, place, yaw, speed), clips.mean[12:]])
    return clips.best(row)


def _wanted(path: Path, place: Values, yaw: float, speed: float) -> Values:
    """``(12,)`` way and looks of the next second along the path, from where the character is."""
    along = float(path.project([place])[0][0])
    marks = [min(along + speed * k / FPS, path.length) for k in AHEAD]
    points = path.at(marks).astype(np.float64)
    behind = path.at([max(mark - 0.1, 0.0) for mark in marks]).astype(np.float64)
    looks = np.arctan2(*(points - behind).T) - yaw
    seen = _seen(points - place, np.full(len(points), yaw))
    return np.concatenate([seen.ravel(), np.stack([np.sin(looks), np.cos(looks)], axis=1).ravel()])


def _turned(way: Values, yaw: float) -> Values:
    c, s = np.cos(yaw), np.sin(yaw)
    return np.array([c * way[0] + s * way[1], -s * way[0] + c * way[1]])


def curves(count: int, metres: float = 18.0) -> Iterator[Path]:
    """Paths along gentle curves from the origin, each followed by its mirror image."""
    along = np.arange(0.0, metres, 0.25)
    for seed in range((count + 1) // 2):
        rng = np.random.default_rng(seed)
        a, b, phase = rng.uniform(0.2, 0.7), rng.uniform(0.15, 0.5), rng.uniform(0, 2 * np.pi)
        yaw = a * (np.sin(b * along + phase) - np.sin(phase))
        points = np.cumsum(np.stack([np.sin(yaw), np.cos(yaw)], axis=1) * 0.25, axis=0)
        for sign in (1.0, -1.0):
            yield Path((points * [sign, 1.0]).astype(np.float32))


def measured(name: str, walk: Callable[[Path], Motion], paths: Sequence[Path]) -> list[list[str]]:
    """Two rows of the table: feet as they come, and locked."""
    made = [(walk(path), path) for path in paths]
    return [
        _row(name, made),
        _row(f"{name}, feet locked", [(lock_feet(motion), path) for motion, path in made]),
    ]


def _row(name: str, made: Sequence[tuple[Motion, Path]]) -> list[str]:
    feet = [footing(motion.positions(), FPS) for motion, _ in made]
    off = [path_deviation(motion.root[:, [0, 2]], path.points) for motion, path in made]
    ends = [float(np.linalg.norm(motion.root[-1, [0, 2]] - path.points[-1])) for motion, path in made]
    speeds = [path.length / motion.duration for motion, path in made]
    figures = (
        100 * np.mean([each.mean for each in off]), 100 * max(each.max for each in off), 100 * np.mean(ends),
        np.mean(speeds), np.mean([each.skate_cm for each in feet]), np.mean([each.right_skate_cm for each in feet]),
        np.mean([each.right_tip_cm for each in feet]), np.mean([each.contact_speed for each in feet]),
    )  # fmt: skip
    digits = (1, 0, 0, 2, 2, 2, 2, 2)
    return [name, *(f"{float(value):.{places}f}" for value, places in zip(figures, digits, strict=True))]


@reports_errors
def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--corpus", type=FilePath, required=True, help="what corpora.recordings packed")
    parser.add_argument("--paths", type=int, default=20, help="walks, half of them mirrored")
    parser.add_argument("--split", default="train", help="of the recordings")
    args = parser.parse_args()
    clips = Clips.of([motion for _, motion in stretches(load_recordings(args.corpus), args.split)])
    paths = list(curves(args.paths))
    from motionrt import Runtime

    runtime = Runtime(threads=1)
    rows = measured("WalkNet", lambda path: runtime.walk(path=path, foot_lock=False).motion, paths)
    rows += measured("motion matching", lambda path: matched(clips, path), paths)
    recorded = [(motion, Path(motion.root[::15, [0, 2]])) for motion in clips.motions if motion.frames > 90]
    for name, ways in (("recorded", recorded), ("recorded, feet locked", [(lock_feet(m), p) for m, p in recorded])):
        row = _row(name, ways)
        rows.append([row[0], "", "", "", *row[4:]])
    feet = ["skate, both (cm/frame)", "right toe", "right tip", "m/s at contact"]
    header = ["", "off path (cm)", "most", "off goal (cm)", "m/s", *feet]
    print(
        f"{len(clips.rows)} frames of {len(clips.motions)} stretches, {len(paths)} paths of {paths[0].length:.0f} m\n"
    )
    print(markdown(header, rows))


if __name__ == "__main__":
    main()
