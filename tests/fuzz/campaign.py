"""The long run: ``python tests/fuzz/campaign.py --cases 100000`` (hours on one core; ``--minutes`` ends it earlier).

Prints counts by outcome; writes every input that is not read or refused cheaply to ``--found``, and exits with 1 then.
"""

from __future__ import annotations

import argparse
import random
import shutil
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1] / "helpers")]

from measured import Outcome, measured, warm  # noqa: E402
from mutate import mutate_folder, mutated  # noqa: E402
from seeds import write_seeds  # noqa: E402


def campaign(cases: int, seed: int, found: Path, minutes: float | None = None) -> tuple[Counter[str], list[str]]:
    """Outcomes by kind, and one line for every case that is not good."""
    warm()
    folder = Path(tempfile.mkdtemp(prefix="motionrt-fuzz-"))
    try:
        return _run(folder, cases, seed, found, minutes)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _run(folder: Path, cases: int, seed: int, found: Path, minutes: float | None) -> tuple[Counter[str], list[str]]:
    seeds = write_seeds(folder / "seeds")
    names, counts, bad = sorted(seeds), Counter[str](), []
    end = time.monotonic() + 60 * minutes if minutes else None
    for case in range(cases):
        if end is not None and time.monotonic() > end:
            break
        rng = random.Random(seed * 1_000_003 + case)
        name = names[case % len(names)]
        door, source = seeds[name]
        target = folder / "case" / source.name
        _write(source, target, rng)
        outcome = measured(door, target)
        counts[f"{outcome.kind} {outcome.error}".strip()] += 1
        if not outcome.good:
            bad.append(_kept(found, target, f"{name}-{seed}-{case}", outcome))
    return counts, bad


def _write(source: Path, target: Path, rng: random.Random) -> None:
    target.parent.mkdir(exist_ok=True)
    if source.is_dir():
        mutate_folder(source, target, rng)
    else:
        target.write_bytes(mutated(source.read_bytes(), rng))
        beside = source.with_name("map.pgm")
        if source.name == "map.yaml":
            shutil.copy(beside, target.parent)


def _kept(found: Path, target: Path, name: str, outcome: Outcome) -> str:
    found.mkdir(parents=True, exist_ok=True)
    if target.is_dir():
        shutil.copytree(target, found / name, dirs_exist_ok=True)
    else:
        shutil.copy(target, found / f"{name}-{target.name}")
    cost = f"{outcome.cpu_s:.1f} s, {outcome.memory_mb:.0f} MB"
    return f"{name}: {outcome.kind} {outcome.error} ({cost}): {outcome.message[:200]!a}"


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float)
    parser.add_argument("--found", type=Path, default=Path("fuzz-found"))
    given = parser.parse_args()
    began = time.monotonic()
    counts, bad = campaign(given.cases, given.seed, given.found, given.minutes)
    print(f"{sum(counts.values())} cases in {time.monotonic() - began:.0f} s, {len(bad)} bad")
    for kind, count in counts.most_common():
        print(f"{count:8d}  {kind}")
    print(*bad[:200], sep="\n")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
