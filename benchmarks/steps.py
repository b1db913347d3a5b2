"""Short moves and streams of random goals: are feet lifted, do they slide, is every goal reached, does nothing leap.

    python benchmarks/steps.py --tasks 100 --streams 500 --frames 1000
    python benchmarks/steps.py --tasks 0 --streams 1 --frames 100000

Prints two tables: 100 random moves of 0.1 to 2 m with any heading, backward and sideways ways of 3 m, and streams whose
goals change at random moments, near and far. A stream's goal counts as due once distance / 1.2 m/s + 3 s have passed.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from motionrt import SMPL24, Goal, Motion, Runtime
from motionrt.locomotion.goal_frame import uncanonicalise
from motionrt.locomotion.stepping import step_to
from motionrt.metrics import footing
from motionrt.metrics.locomotion import foot_skate
from motionrt.motion.rotations import wrapped
from motionrt.motion.transforms import heading

FPS, SPEED, GRACE_S = 30.0, 1.2, 3.0
ANKLES = [SMPL24.index("left_ankle"), SMPL24.index("right_ankle")]
LIFTED, DISPLACED = 0.04, 0.05  # metres
Floats = NDArray[np.float64]


def tasks(runtime: Runtime, count: int, seed: int = 0) -> Iterator[tuple[Motion, Goal]]:
    """(motion, goal) of random short moves from a stand."""
    rng, stand = np.random.default_rng(seed), runtime.character_models.standing
    for _ in range(count):
        far, way, facing = rng.uniform(0.1, 2.0), rng.uniform(-np.pi, np.pi), rng.uniform(-np.pi, np.pi)
        goal = Goal(float(far * np.sin(way)), float(far * np.cos(way)), float(facing))
        yield step_to(stand, uncanonicalise(stand, goal)).motion, goal


def lifted(motion: Motion) -> float:
    """Share of the displaced feet that were lifted by 4 cm."""
    ankles = motion.positions()[:, ANKLES]
    moved = np.linalg.norm((ankles[-1] - ankles[0])[:, [0, 2]], axis=1) > DISPLACED
    high = ankles[:, :, 1].max(axis=0) - ankles[0, :, 1] > LIFTED
    return float(high[moved].mean()) if moved.any() else 1.0


def stream(runtime: Runtime, frames: int, seed: int) -> tuple[Motion, list[bool]]:
    """A stream with random goals, and of the goals that were due, whether they were reached within 5 cm."""
    rng, goal = np.random.default_rng(seed), Goal(0.0, 2.0)
    character, made, reached = runtime.stream(goal, start=Goal(0.0, 0.0)), [], list[bool]()
    since, left, due = 0, int(rng.integers(5, 200)), 2.0 / SPEED + GRACE_S
    for frame in range(frames):
        if frame - since < left:
            made.append(next(character))
            continue
        x, _, z = (float(value) for value in made[-1].root[0])
        if (frame - since) / FPS >= due:
            reached.append(float(np.hypot(goal.x - x, goal.z - z)) < 0.05)
        far, way = rng.choice([0.3, 1.0, 3.0, 8.0]) * rng.uniform(0.2, 1.0), rng.uniform(-np.pi, np.pi)
        goal = Goal(x + far * float(np.sin(way)), z + far * float(np.cos(way)), float(rng.uniform(-np.pi, np.pi)))
        since, due = frame, far / SPEED + GRACE_S
        left = int(rng.integers(5, 60)) if rng.random() < 0.5 else int(due * FPS) + 1
        made.append(character.send(goal))
    rotations, root = (np.concatenate([getattr(each, name) for each in made]) for name in ("rotations", "root"))
    return Motion(rotations, root, FPS), reached


def aside(runtime: Runtime, velocity: tuple[float, float], metres: float = 3.0) -> Motion:
    """A way that a stick leads, looking along +Z all the time."""
    character, made = runtime.stream(Goal(0.0, 0.0), start=Goal(0.0, 0.0)), list[Motion]()
    while not made or np.hypot(*made[-1].root[0, [0, 2]]) < metres:
        made.append(character.steer(velocity, facing=0.0))
    made += [character.steer((0.0, 0.0), facing=0.0) for _ in range(60)]
    rotations, root = (np.concatenate([getattr(each, name) for each in made]) for name in ("rotations", "root"))
    return Motion(rotations, root, FPS)


def fastest(motion: Motion) -> tuple[float, float]:
    """m/s of the pelvis and degrees/s of its heading, the highest between two frames."""
    speed = np.linalg.norm(np.diff(motion.root, axis=0), axis=1).max() * FPS
    turn = np.degrees(np.abs(wrapped(np.diff(heading(motion)))).max()) * FPS
    return float(speed), float(turn)


@dataclass(frozen=True)
class Row:
    """One stream: m/s and degrees/s at their worst, foot skate in cm/frame, which of its goals were in time."""

    speed: float
    turn: float
    skate: float
    reached: list[bool]


def measured(motion: Motion, reached: list[bool]) -> Row:
    return Row(*fastest(motion), foot_skate(motion.positions()), reached)


def told(rows: list[Row], frames: int) -> str:
    """What streams add up to."""
    due, skates = [each for row in rows for each in row.reached], [row.skate for row in rows]
    return (
        f"{len(rows)} streams of {frames} frames: at most {max(row.speed for row in rows):.2f} m/s and "
        f"{max(row.turn for row in rows):.0f} degrees/s; foot skate {np.mean(skates):.3f} (worst {max(skates):.3f}) "
        f"cm/frame; {sum(due)} of {len(due)} goals reached in time"
    )


def streams(runtime: Runtime, count: int, frames: int, first: int = 0) -> None:
    """Measure and tell, every four streams."""
    rows = list[Row]()
    for seed in range(first, first + count):
        rows.append(measured(*stream(runtime, frames, seed)))
        if len(rows) % 4 == 0 or len(rows) == count:
            print(told(rows, frames), flush=True)


def main() -> None:
    """Both tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tasks", type=int, default=100)
    parser.add_argument("--streams", type=int, default=500)
    parser.add_argument("--frames", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0, help="number of the first stream")
    args = parser.parse_args()
    runtime = Runtime(threads=1)
    if args.tasks:
        moves(runtime, args.tasks)
    if args.streams:
        streams(runtime, args.streams, args.frames, args.first)


def moves(runtime: Runtime, count: int) -> None:
    """Short moves, backward and sideways ways."""
    short = [(motion, goal, foot_skate(motion.positions())) for motion, goal in tasks(runtime, count)]
    off = [float(np.hypot(goal.x - m.root[-1, 0], goal.z - m.root[-1, 2])) for m, goal, _ in short]
    turned = [float(abs(wrapped(goal.heading - heading(m)[-1]))) for m, goal, _ in short]
    print(f"{len(short)} short moves: lifted {100 * np.mean([lifted(m) for m, *_ in short]):.0f} % of displaced feet, ")
    print(f"  foot skate {np.mean([s for *_, s in short]):.3f} (worst {max(s for *_, s in short):.3f}) cm/frame, ")
    print(f"  arrival at most {100 * max(off):.2f} cm and {np.degrees(max(turned)):.2f} degrees off")
    feet = [footing(motion.positions(), FPS) for motion, *_ in short]
    left, right, speed = (
        np.mean([getattr(foot, name) for foot in feet]) for name in ("left_skate_cm", "right_skate_cm", "contact_speed")
    )
    print(f"  left foot {left:.3f}, right foot {right:.3f} cm/frame; {speed:.3f} m/s at contact")
    for name, velocity in (("backward", (0.0, -0.7)), ("sideways", (0.6, 0.0))):
        way = aside(runtime, velocity)
        print(f"3 m {name}: {way.duration - 2:.1f} s, foot skate {foot_skate(way.positions()):.3f} cm/frame, ")
        print(f"  turned by at most {np.degrees(np.abs(heading(way)).max()):.1f} degrees")


if __name__ == "__main__":
    main()
