"""The long run: ``python tests/fuzz/campaign.py --cases 100000`` (hours on one core; ``--minutes`` ends it earlier).

Prints counts by outcome; writes every input that is not read or refused cheaply to ``--found``, and exits with 1 then.
What is done stands in ``FOUND/done-SEED.json``: the same command goes on from there. A case depends on its number and
the seed alone.
"""

from __future__ import annotations

import argparse
import json
import random
import shutil
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1] / "helpers")]

from measured import Outcome, measured_all, warm  # noqa: E402
from mutate import mutate_folder, mutated  # noqa: E402
from seeds import BESIDE, write_seeds  # noqa: E402

EVERY = 500


@dataclass
class Done:
    """What a campaign has done: cases, outcomes by kind, and one line for every case that is not good."""

    cases: int = 0
    counts: Counter[str] = field(default_factory=Counter)
    bad: list[str] = field(default_factory=list)

    @staticmethod
    def read(path: Path) -> Done:
        """As it was left; nothing is done where there is no such file."""
        if not path.exists():
            return Done()
        kept = json.loads(path.read_text(encoding="utf-8"))
        return Done(kept["cases"], Counter(kept["counts"]), kept["bad"])

    def write(self, path: Path) -> None:
        """Leave it, whole or not at all."""
        path.parent.mkdir(parents=True, exist_ok=True)
        new = path.with_suffix(".new")
        new.write_text(json.dumps(vars(self), indent=1), encoding="utf-8")
        new.replace(path)


def campaign(cases: int, seed: int, found: Path, minutes: float | None = None) -> Done:
    """Run the cases that are not done yet."""
    warm()
    folder = Path(tempfile.mkdtemp(prefix="motionrt-fuzz-"))
    try:
        return _run(folder, cases, seed, found, minutes)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _run(folder: Path, cases: int, seed: int, found: Path, minutes: float | None) -> Done:
    seeds, state = write_seeds(folder / "seeds"), found / f"done-{seed}.json"
    names, done = sorted(seeds), Done.read(state)
    end = time.monotonic() + 60 * minutes if minutes else None

    def prepared(case: int) -> tuple[str, Path]:
        door, source = seeds[names[case % len(names)]]
        target = folder / "case" / source.name
        _write(source, target, random.Random(seed * 1_000_003 + case))
        return door, target

    for case, outcome in measured_all(range(done.cases, cases), prepared):
        done.cases += 1
        done.counts[f"{outcome.kind} {outcome.error}".strip()] += 1
        if not outcome.good:
            name = f"{names[case % len(names)]}-{seed}-{case}"
            done.bad.append(_kept(found, prepared(case)[1], name, outcome))
        if done.cases % EVERY == 0:
            done.write(state)
        if end is not None and time.monotonic() > end:
            break
    done.write(state)
    return done


def _write(source: Path, target: Path, rng: random.Random) -> None:
    target.parent.mkdir(exist_ok=True)
    if source.is_dir():
        mutate_folder(source, target, rng)
    else:
        target.write_bytes(mutated(source.read_bytes(), rng))
        if source.name in BESIDE:
            shutil.copy(source.with_name(BESIDE[source.name]), target.parent)


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
    done = campaign(given.cases, given.seed, given.found, given.minutes)
    print(f"{done.cases} cases, the last of them in {time.monotonic() - began:.0f} s, {len(done.bad)} bad")
    for kind, count in done.counts.most_common():
        print(f"{count:8d}  {kind}")
    print(*done.bad[:200], sep="\n")
    return 1 if done.bad else 0


if __name__ == "__main__":
    sys.exit(main())
