"""Do texts in other people's words do what they say? Our own prompts, judged by kinematic checks that no model makes.

    python benchmarks/other_words.py ../shared/tools/probes benchmarks/other_words/first.tsv [--seeds 2] [-v]

Each line of a list: voice, group, seconds, text, checks. The checks are those of ``probes.py`` in the folder that is
named first, and the few below. Prints for every group which share of motions passes, which share of texts the parser
understands as expected, how many frames float, and how the feet slide.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import sys
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from motionrt import Runtime
from motionrt.metrics import footing
from motionrt.motion import Motion
from motionrt.text import TextAttributes, gestures_of_text, parse_query

FPS = 30.0
FLOATS, JUMPS, JUMP_FRAMES = 0.02, 0.05, 3  # metres of the lowest toe; both toes for so many frames


@dataclass(frozen=True)
class Prompt:
    """A text, and what a motion of it must show."""

    voice: str
    group: str
    seconds: float
    text: str
    checks: tuple[str, ...]


def read(path: Path) -> list[Prompt]:
    """The prompts of a list."""
    rows = [line.split("\t") for line in path.read_text(encoding="utf-8").splitlines() if line and line[0] != "#"]
    return [Prompt(v, g, float(s), t, tuple(c.strip() for c in checks.split(";"))) for v, g, s, t, checks in rows]


def holds(probes: ModuleType, body: Any, check: str) -> bool:
    """One check, of ours or of ``probes.py``."""
    kind, *rest = check.split()
    ground = body["pelvis"][:, [0, 2]]
    far = np.linalg.norm(ground - ground[0], axis=1)
    if kind == "path":  # the way over the ground is at least so long, metres
        return float(np.linalg.norm(np.diff(ground[::5], axis=0), axis=1).sum()) >= float(rest[0])
    if kind == "returns":  # goes away by half a metre and comes back a good part of it
        return bool(far.max() >= 0.5 and far[-1] <= 0.7 * far.max())
    if kind == "zigzag":  # the way bends to one side and back again, so many times
        return body.swings(bends(ground), 30.0) >= int(rest[0])
    if kind == "eight":  # the way bends far to one side and then far to the other
        bend = bends(ground)
        return float(np.ptp(bend)) >= 180 and abs(bend[-1] - bend[0]) <= 0.6 * float(np.ptp(bend))
    if kind == "handslow":  # ends with both hands below the shoulders
        return all(body.hand_over(side, "shoulder")[-5:].mean() < 0 for side in ("left", "right"))
    return bool(probes.check(body, check.split()))


def bends(ground: np.ndarray) -> np.ndarray:
    """The direction of a way ``(F, 2)`` where it gets on, degrees."""
    steps = np.diff(ground[::5], axis=0)
    steps = steps[np.linalg.norm(steps, axis=1) > 0.05]
    return np.degrees(np.unwrap(np.arctan2(steps[:, 0], steps[:, 1]))) if len(steps) > 3 else np.zeros(2)


def understood(said: TextAttributes, check: str) -> bool:
    """Whether the parser says what a check looks for; true where it has nothing to say of it."""
    kind, *rest = check.split()
    side = rest[0] if rest and rest[0] in ("left", "right") else None
    does = gestures_of_text(said)
    hands = {one for one, _ in does.hands}
    low = said.posture_lowest not in (None, "standing") or said.lean
    rules: dict[str, Any] = {
        "turn": lambda: side in (said.turn_side, said.path_side),
        "curve": lambda: side in (said.turn_side, said.path_side) and (said.path or said.turn) is not None,
        "spin": lambda: said.path is not None or said.turn in ("around", "full"),
        "straight": lambda: said.turn in (None, "none") and said.path in (None, "straight"),
        "travel": lambda: (
            rest[1] == "-1" or said.travel == rest[0] or (said.path and rest[0] == "forward") or said.turn
        ),
        "stay": lambda: said.travel in (None, "none"),
        "hand": lambda: said.arms_up == side or side in hands,
        "hands": lambda: said.arms_up == "both" or len(hands) == 2,
        "mostly": lambda: said.arm == side or side in hands or said.arms_up == side,
        "foot": lambda: side in (said.leg, said.foot_lift, does.lifted),
        "air": lambda: bool(said.jumps),
        "low": lambda: low,
        "endlow": lambda: low and said.posture_end not in (None, "standing"),
        "crouched": lambda: low,
        "knee": lambda: said.posture_lowest == "kneeling",
        "allfours": lambda: said.posture_lowest == "crawling",
        "lying": lambda: said.posture_end == "lying",
        "startlow": lambda: said.posture_start not in (None, "standing") or said.level == "up",
        "endhigh": lambda: said.posture_end in (None, "standing"),
        "handsdown": lambda: said.hands_low,
        "lean": lambda: said.lean or does.bows,
        "clap": lambda: bool(said.claps),
        "still": lambda: said.still,
        "upsidedown": lambda: said.posture_lowest == "upside down",
    }
    return bool(rules[kind]()) if kind in rules else True


def floating(motion: Motion) -> tuple[int, int]:
    """Frames in which no toe is near the floor and nobody jumps, lies or kneels; and frames that could be so."""
    at = motion.positions()
    names = motion.skeleton.index
    toes = at[:, [names("left_foot"), names("right_foot")], 1].min(axis=1)
    upright = at[:, names("pelvis"), 1] > 0.6
    high = (toes > JUMPS).astype(int)
    runs = np.flatnonzero(np.diff(np.concatenate([[0], high, [0]])))
    for first, last in zip(runs[::2], runs[1::2], strict=True):
        if last - first >= JUMP_FRAMES:
            upright[max(first - 3, 0) : last + 3] = False
    return int((upright & (toes > FLOATS)).sum()), int(upright.sum())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("probes", type=Path, help="the folder of probes.py")
    parser.add_argument("prompts", type=Path)
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--only", help="texts that hold this")
    parser.add_argument("--parser", action="store_true", help="what the parser understands, without motions")
    parser.add_argument("--json", type=Path)
    parser.add_argument("-v", action="store_true")
    args = parser.parse_args()
    probes = loaded(args.probes / "probes.py")
    runtime = Runtime()
    table: dict[str, list[tuple[float, float]]] = defaultdict(list)
    rows, floats, skates = [], [0, 0], []
    for prompt in read(args.prompts):
        if args.only and args.only not in prompt.text:
            continue
        said = parse_query(prompt.text)
        missed = [check for check in prompt.checks if not understood(said, check)]
        failed: list[list[str]] = []
        loose = [0, 0]
        for seed in range(args.first_seed, args.first_seed + (0 if args.parser else args.seeds)):
            motion = runtime.generate(prompt.text, seconds=prompt.seconds, seed=seed)
            at = motion.positions()
            body = probes.Body(np.asarray(at, dtype=float))
            failed.append([check for check in prompt.checks if not holds(probes, body, check)])
            loose = [a + b for a, b in zip(loose, floating(motion), strict=True)]
            skates.append(footing(at, FPS).skate_cm)
        floats = [a + b for a, b in zip(floats, loose, strict=True)]
        passed = float(np.mean([not f for f in failed])) if failed else 0.0
        for name in (prompt.group, "all"):
            table[name].append((passed, not missed))
        rows.append({"text": prompt.text, "passed": passed, "failed": failed, "missed": missed, "floating": loose})
        if args.v and (missed or passed < 1 or loose[0] > 0.2 * loose[1]):
            wanted = "; ".join(prompt.checks)
            print(f"{passed:4.2f} {prompt.text} [{wanted}] parser: {missed} failed: {failed} floats {loose}")
    print("| group | texts | motions that pass, % | texts understood, % |\n|---|---|---|---|")
    for name in [*sorted(set(table) - {"all"}), "all"]:
        both = 100 * np.mean(np.array(table[name], dtype=float), axis=0)
        print(f"| {name} | {len(table[name])} | {both[0]:.1f} | {both[1]:.1f} |")
    if skates:
        print(f"floating {100 * floats[0] / floats[1]:.1f} % of frames; skate {np.mean(skates):.2f} cm/frame")
    if args.json:
        args.json.write_text(json.dumps(rows, indent=1))


def loaded(path: Path) -> ModuleType:
    """``probes.py`` as a module."""
    spec = importlib.util.spec_from_file_location("probes", path)
    if spec is None or spec.loader is None:
        raise SystemExit(f"there is no {path}")
    module = importlib.util.module_from_spec(spec)
    sys.modules["probes"] = module
    spec.loader.exec_module(module)
    return module


if __name__ == "__main__":
    main()
