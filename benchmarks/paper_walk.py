"""The whole step of one walking character, against the paper's network (30 tokens, all outputs) in torch eager.

    python benchmarks/paper_walk.py --threads 1

Both do the same around the network: history seen from the goal, next frame back into the world, nearest rotations. The
weights of the rival are random, which costs the same. Ten calls of each in turn, one process; medians.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable

import numpy as np
import torch

from motionrt import Runtime
from motionrt.locomotion.crowd import Crowd, NextFrame, history_of
from motionrt.motion.skeleton import FloatArray
from motionrt_training.networks.walknet import WalkNet

GOAL = np.array([[0.0, 5.0, 0.0]])


def eager(network: WalkNet) -> NextFrame:
    """The network as a model of next frames."""

    def call(frames: FloatArray, speed: FloatArray) -> FloatArray:
        with torch.inference_mode():
            return np.asarray(network(torch.from_numpy(frames), torch.from_numpy(np.array(speed)))[:, 0])

    return call


def timed(step: Callable[[], object], calls: int) -> float:
    """Milliseconds a call."""
    started = time.perf_counter()
    for _ in range(calls):
        step()
    return 1000 * (time.perf_counter() - started) / calls


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--rounds", type=int, default=60)
    args = parser.parse_args()
    torch.set_num_threads(args.threads)
    runtime = Runtime(threads=args.threads)
    history = history_of(runtime.character_models.stride)[None]
    models = {"motionrt": runtime.character_models.walk}
    models |= {f"torch eager, patch={patch}": eager(WalkNet(patch=patch).eval()) for patch in (1, 5)}
    times: dict[str, list[float]] = {name: [] for name in models}
    for _ in range(args.rounds):
        for name, model in models.items():
            crowd = Crowd(model, history)
            crowd.step(GOAL)
            times[name].append(timed(lambda crowd=crowd: crowd.step(GOAL), 10))  # type: ignore[misc]
    ours = float(np.median(times["motionrt"]))
    for name, found in times.items():
        print(f"{name}: {np.median(found):.2f} ms a step, {np.median(found) / ours:.1f} x; least {min(found):.2f} ms")
    least = {name: min(found) for name, found in times.items()}
    print(f"least against least: {least['torch eager, patch=1'] / least['motionrt']:.1f} x")


if __name__ == "__main__":
    main()
