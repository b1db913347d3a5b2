"""How long one call of every variant takes, beside torch: the benchmark figures of the manifest."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import torch

from motionrt.bench.graphs import called_with, graph_call, graph_case
from motionrt.bench.timing import Call, Contest, Turns, timed
from motionrt.models import Manifest, Sessions
from motionrt_export.measured import Rows
from motionrt_export.torch_graphs import graph_cases
from motionrt_training.networks.minilm import MiniLM
from motionrt_training.networks.transformer import set_fused_attention

TORCH = "torch"
THREADS, TURNS = 1, Turns(rounds=10, calls=10)
Found = dict[str, dict[str, dict[str, Any]]]


@dataclass(frozen=True)
class Stopwatch:
    """Times the variants of a manifest that are built, and the torch module beside them, turn by turn."""

    manifest: Path
    checkpoints: Path
    turns: Turns = TURNS

    def __call__(self, say: Callable[[str], None]) -> Rows:
        """Figures of every variant: p50 and p95 of one call, torch's p50, the call in words, the number of threads."""
        torch.set_num_threads(THREADS)
        sessions, rivals = Sessions(self.manifest, threads=THREADS), self._rivals()
        found: Found = {}
        for name in sessions.manifest.models:
            found[name] = self._model(sessions, name, rivals[graph_case(name)])
            say(", ".join(f"{name} {variant} {row['p50_ms']} ms" for variant, row in found[name].items()))
        return found

    def _rivals(self) -> dict[str, Call]:
        backbone = MiniLM.from_package()
        set_fused_attention(backbone.eval(), fused=True)
        return graph_cases(str(self.manifest), backbone, self.checkpoints)

    def _model(self, sessions: Sessions, name: str, rival: Call) -> dict[str, dict[str, Any]]:
        built = _built(sessions.manifest, name)
        contenders = {variant: graph_call(sessions, name, variant) for variant in built}
        times = timed({name: Contest({**contenders, TORCH: rival})}, self.turns)[name]
        call = called_with(sessions.model(name))
        return {
            variant: {
                "p50_ms": _rounded(times[variant].p50_ms),
                "p95_ms": _rounded(times[variant].p95_ms),
                "torch_p50_ms": _rounded(times[TORCH].p50_ms),
                "call": call,
                "threads": THREADS,
            }
            for variant in built
        }


def _built(manifest: Manifest, model: str) -> list[str]:
    variants = manifest.model(model).variants.values()
    return [variant.name for variant in variants if manifest.locate(variant.file).is_file()]


def _rounded(milliseconds: float) -> float:
    """Three digits that count."""
    return float(f"{milliseconds:.3g}")
