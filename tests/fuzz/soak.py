"""The same calls for a long time, and from many threads: memory stays flat, answers stay equal.

    python tests/fuzz/soak.py --calls 100000 [VERB ...]      (``--minutes`` ends it earlier)

Prints MiB of memory before and after by verb, and exits with 1 if any grew by more than 2 MiB or a thread's answer
differed from the one that was found alone.
"""
# ruff: noqa: PLW0108  # that the call is made is the point

from __future__ import annotations

import argparse
import gc
import sys
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1] / "helpers")]

from fake_embedder import FakeEmbedder  # noqa: E402
from motions import walking  # noqa: E402

from motionrt.formats import load_motion, load_target  # noqa: E402
from motionrt.locomotion import Goal, canonicalise  # noqa: E402
from motionrt.locomotion import Path as Route  # noqa: E402
from motionrt.locomotion.scene import Scene  # noqa: E402
from motionrt.locomotion.words.instruction import parse_instruction  # noqa: E402
from motionrt.retrieval import Gallery, motion_features  # noqa: E402
from motionrt.synthesis.composing import Layer, compose  # noqa: E402
from motionrt.synthesis.parts import body_parts  # noqa: E402
from motionrt.text import parse_query  # noqa: E402

GROWTH_MB = 2.0
Verb = Callable[[], bytes]


def verbs(folder: Path) -> dict[str, Verb]:
    """Cheap calls by name; each gives bytes that can be compared."""
    clip = walking(12)
    file = clip.save(folder / "clip.npz")
    gallery = Gallery.from_motions([clip, walking(20, speed=2.0)], ["a", "b"], FakeEmbedder())
    query = gallery.embeddings[0].copy()
    scene = Scene.from_polygons([[(-2, -2), (2, -2), (2, 2), (-2, 2)]], [[(0, 0), (1, 0), (1, 1), (0, 1)]], cell=0.2)
    saved, rig = gallery.save(folder / "gallery"), load_target(clip.save(folder / "rig.bvh"))
    standing = [Layer(clip, ["left arm"]), Layer(clip.mirror(), ["torso"])]
    goal = Goal(1.0, 2.0, 0.5)
    return {
        "positions": lambda: clip[1:].positions().tobytes(),
        "canonical": lambda: clip.canonical().root.tobytes(),
        "grounded": lambda: clip[1:].grounded().root.tobytes(),
        "features": lambda: motion_features(clip).tobytes(),
        "goal frame": lambda: canonicalise(clip, goal).root.tobytes(),
        "compose": lambda: compose(standing).rotations.tobytes(),
        "retarget": lambda: clip[:2].retarget_to(rig).clip.rotations.tobytes(),
        "clip": lambda: saved.motion("a").root.tobytes(),
        "query": lambda: repr(parse_query("turns left twice, quickly")).encode(),
        "clearance": lambda: scene.clearance([(0, 1), (1, 1)]).tobytes(),
        "load": lambda: load_motion(file).root.tobytes(),
        "resample": lambda: clip.resample(30).root.tobytes(),
        "mirror": lambda: clip.mirror().rotations.tobytes(),
        "search": lambda: repr([(hit.id, hit.score) for hit in gallery.search(query, 2)]).encode(),
        "plan": lambda: scene.plan((-1, -1), (-1, 1)).points.tobytes(),
        "path": lambda: Route(np.array([[0, 0], [1, 2], [3, 3]], np.float32)).waypoints(1.0).positions.tobytes(),
        "parts": lambda: ",".join(sorted(body_parts("wave the right hand"))).encode(),
        "words": lambda: repr(parse_instruction("sit on the sofa")).encode(),
    }


def memory_mb() -> float:
    """Resident memory of this process, MiB."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * 4096 / 2**20


def growth(verb: Verb, calls: int, until: float | None) -> tuple[int, float]:
    """How many calls were made, and by how many MiB the process grew after some first ones."""
    warm = max(50, min(calls // 100, 200))
    for _ in range(warm):
        verb()
    gc.collect()
    before, done = memory_mb(), 0
    while done < calls and (until is None or time.monotonic() < until):
        verb()
        done += 1
    gc.collect()
    return done, memory_mb() - before


def differing(made: dict[str, Verb], threads: int, rounds: int) -> list[str]:
    """Verbs whose answer from several threads at once is not the one that was found alone."""
    alone = {name: verb() for name, verb in made.items()}
    jobs = [name for _ in range(rounds) for name in made]
    with ThreadPoolExecutor(threads) as pool:
        answers = list(pool.map(lambda name: made[name](), jobs))
    return sorted({name for name, answer in zip(jobs, answers, strict=True) if answer != alone[name]})


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("verbs", nargs="*", metavar="VERB", help="default: all")
    parser.add_argument("--calls", type=int, default=100_000)
    parser.add_argument("--minutes", type=float)
    parser.add_argument("--threads", type=int, default=16)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        made = verbs(Path(folder))
        bad = differing(made, given.threads, 20)
        print(f"{given.threads} threads x {len(made)} verbs x 20: {len(bad)} differ {bad}")
        chosen = {name: verb for name, verb in made.items() if not given.verbs or name in given.verbs}
        for name, verb in chosen.items():
            until = None if given.minutes is None else time.monotonic() + 60 * given.minutes / len(chosen)
            done, grown = growth(verb, given.calls, until)
            print(f"{name:10s} {done:8d} calls  {grown:+.2f} MiB", flush=True)
            bad += [name] if grown > GROWTH_MB else []
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
