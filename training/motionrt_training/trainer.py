"""One training loop for every recipe: resumable, budgeted by steps or minutes, the same on CPU and CUDA."""

from __future__ import annotations

import hashlib
import json
import math
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import torch
from torch import Tensor, nn
from tqdm import tqdm

from motionrt_training.average import Average
from motionrt_training.checkpoint import load_any, load_state, save_atomically
from motionrt_training.data_record import DataRecord
from motionrt_training.options import option
from motionrt_training.stop_signal import StopSignal

Losses = dict[str, Tensor]


@dataclass(frozen=True)
class Schedule:
    """How to train; nothing here depends on what is trained."""

    steps: int = option(20000, "optimiser steps")
    minutes: float | None = option(None, "time budget over all runs of the folder, if before --steps")
    lr: float = option(1e-4, "peak learning rate")
    final_lr: float = option(0.02, "learning rate at the end, as a fraction of the peak")
    warmup: int = option(200, "steps of linear warm-up")
    weight_decay: float = option(0.01, "AdamW weight decay (matrices only)")
    clip: float = option(1.0, "largest norm of the gradient")
    ema: float = option(0.999, "decay of the averaged weights that are validated and released")
    bf16: bool | None = option(None, "bfloat16 autocast: true, false, or none to use it where it is fast")
    seed: int = option(1, "seed of the weights, the batches and the dropout")
    threads: int | None = option(None, "CPU threads; none leaves torch's choice")
    device: str = option("auto", "cpu, cuda, or auto")
    validate_every: int = option(200, "steps between validations")
    save_seconds: float = option(300.0, "seconds between checkpoints")
    log_every: int = option(20, "steps between log lines")


class Task(Protocol):
    """What is trained. `batch` depends on (seed, step) alone, so that a resumed run sees the same data."""

    model: nn.Module

    def batch(self, step: int) -> Any:
        """The batch of a step, on the CPU."""

    def losses(self, model: nn.Module, batch: Any) -> Losses:
        """Named losses of a batch; "loss" is minimised."""

    def validate(self, model: nn.Module) -> dict[str, float]:
        """Named measures of the averaged model; the best "score" (higher is better) is kept."""


class Trainer:
    """Trains `task` into `folder`: last.pt (to go on from), best.pt (averaged weights), log.jsonl.

    A run begins from the weights of `init`, a checkpoint or a release of the same network, where one is given. `data`
    says whose data it is trained on; it is kept in the checkpoints.
    """

    def __init__(
        self,
        task: Task,
        schedule: Schedule,
        folder: str | Path,
        notes: dict[str, Any] | None = None,
        init: Path | None = None,
        data: DataRecord | None = None,
    ) -> None:
        self.task, self.schedule, self.folder, self.notes = task, schedule, Path(folder), notes or {}
        self.data = data or []
        self.device = _device(schedule.device)
        if init is not None:
            task.model.load_state_dict(load_any(init, type(task.model)).state_dict())
            self.notes = {**self.notes, "init": hashlib.sha256(init.read_bytes()).hexdigest()}
        self.bf16 = _bf16(schedule.bf16, self.device)
        self.model = task.model.to(self.device)
        self.average = Average(self.model, schedule.ema)
        self.optimiser = _optimiser(self.model, schedule)
        self.step, self.elapsed, self.best = 0, 0.0, -math.inf

    def run(self) -> dict[str, float]:
        """Train until the budget is spent or a signal asks to stop; returns the last validation."""
        torch.manual_seed(self.schedule.seed)
        if self.schedule.threads:
            torch.set_num_threads(self.schedule.threads)
        self.folder.mkdir(parents=True, exist_ok=True)
        self._resume()
        measures: dict[str, float] = {}
        with StopSignal() as stop, tqdm(total=self.schedule.steps, initial=self.step, unit="step") as bar:
            measures = self._loop(stop, bar)
        self._save()
        return measures

    def _loop(self, stop: StopSignal, bar: Any) -> dict[str, float]:
        clock, saved, before = time.monotonic(), time.monotonic(), self.elapsed
        window: list[Losses] = []
        measures: dict[str, float] = {}
        mark = (clock, self.step)
        while not stop.asked and self.progress() < 1.0:
            window.append(self._train_step())
            self.elapsed = before + time.monotonic() - clock
            bar.update()
            if self.step % self.schedule.log_every == 0:
                mark = self._log_losses(window, mark, bar)
                window = []
            if self.step % self.schedule.validate_every == 0 or self.progress() >= 1.0:
                measures = self._validate(bar)
                mark = (time.monotonic(), self.step)
            if time.monotonic() - saved > self.schedule.save_seconds:
                self._save()
                saved = time.monotonic()
        return measures

    def progress(self) -> float:
        """Part of the budget that is spent, by steps or by time, whichever is more."""
        by_time = self.elapsed / (60.0 * self.schedule.minutes) if self.schedule.minutes else 0.0
        return max(self.step / self.schedule.steps, by_time)

    def learning_rate(self) -> float:
        """Linear warm-up, then a cosine over the budget."""
        low = self.schedule.final_lr
        cosine = low + (1.0 - low) * 0.5 * (1.0 + math.cos(math.pi * min(1.0, self.progress())))
        return self.schedule.lr * min(1.0, (self.step + 1) / max(1, self.schedule.warmup)) * cosine

    def _train_step(self) -> Losses:
        self.model.train()
        for group in self.optimiser.param_groups:
            group["lr"] = self.learning_rate()
        batch = _to(self.task.batch(self.step), self.device)
        with torch.autocast(self.device.type, torch.bfloat16, enabled=self.bf16):
            losses = self.task.losses(self.model, batch)
        losses["loss"].backward()
        losses["gradient"] = nn.utils.clip_grad_norm_(self.model.parameters(), self.schedule.clip)
        if bool(torch.isfinite(losses["gradient"])):
            self.optimiser.step()
            self.average.update(self.model, self.step)
        self.optimiser.zero_grad(set_to_none=True)
        self.step += 1
        return {name: value.detach() for name, value in losses.items()}

    def _log_losses(self, window: list[Losses], mark: tuple[float, int], bar: Any) -> tuple[float, int]:
        now = time.monotonic()
        means = {name: float(torch.stack([row[name] for row in window]).mean()) for name in window[-1]}
        milliseconds = 1000.0 * (now - mark[0]) / max(1, self.step - mark[1])
        bar.set_postfix(loss=f"{means['loss']:.4f}", ms=f"{milliseconds:.0f}")
        self._log({**means, "lr": self.learning_rate(), "ms_per_step": round(milliseconds, 1)})
        return now, self.step

    def _validate(self, bar: Any) -> dict[str, float]:
        with self.average.applied_to(self.model):
            self.model.eval()
            with torch.no_grad():
                measures = {name: float(value) for name, value in self.task.validate(self.model).items()}
            if measures.get("score", -math.inf) > self.best:
                self.best = measures["score"]
                self._save_best(measures)
        self._log({"validation": measures, "best": self.best})
        spoken = "  ".join(f"{name} {value:.4g}" for name, value in measures.items())
        bar.write(f"step {self.step}: {spoken}")
        return measures

    def _save_best(self, measures: dict[str, float]) -> None:
        state = {
            "model": self.model.state_dict(),
            "measures": measures,
            "step": self.step,
            "elapsed": self.elapsed,
            "seed": self.schedule.seed,
            "notes": self.notes,
            "data": self.data,
        }
        save_atomically(state, self.folder / "best.pt")

    def _save(self) -> None:
        state = {
            "model": self.model.state_dict(),
            "average": self.average.state(),
            "optimiser": self.optimiser.state_dict(),
            "random": _random_state(self.device),
            "step": self.step,
            "elapsed": self.elapsed,
            "best": self.best,
            "seed": self.schedule.seed,
            "notes": self.notes,
            "data": self.data,
        }
        save_atomically(state, self.folder / "last.pt")

    def _resume(self) -> None:
        path = self.folder / "last.pt"
        if not path.exists():
            return
        state = load_state(path)
        if any(self.notes.get(name, value) != value for name, value in state["notes"].items()):
            raise ValueError(f"{path} was trained with other settings; give them, or another --out")
        self.model.load_state_dict(state["model"])
        self.average.load(state["average"])
        self.optimiser.load_state_dict(state["optimiser"])
        self.step, self.elapsed, self.best = state["step"], state["elapsed"], state["best"]
        _set_random_state(state["random"], self.device)

    def _log(self, row: dict[str, Any]) -> None:
        with (self.folder / "log.jsonl").open("a", encoding="utf-8") as file:
            file.write(json.dumps({"step": self.step, "minutes": round(self.elapsed / 60, 3), **row}) + "\n")


def _device(name: str) -> torch.device:
    if name == "auto":
        name = "cuda" if torch.cuda.is_available() else "cpu"
    return torch.device(name)


def _bf16(wanted: bool | None, device: torch.device) -> bool:
    if wanted is not None:
        return wanted
    if device.type == "cuda":
        return torch.cuda.is_bf16_supported()
    return bool(getattr(torch.cpu, "_is_avx512_bf16_supported", lambda: False)())


def _optimiser(model: nn.Module, schedule: Schedule) -> torch.optim.AdamW:
    matrices = [p for p in model.parameters() if p.requires_grad and p.ndim >= 2]
    others = [p for p in model.parameters() if p.requires_grad and p.ndim < 2]
    groups = [
        {"params": matrices, "weight_decay": schedule.weight_decay},
        {"params": others, "weight_decay": 0.0},
    ]
    return torch.optim.AdamW(groups, lr=schedule.lr, fused=True)


def _to(batch: Any, device: torch.device) -> Any:
    if isinstance(batch, Tensor):
        return batch.to(device, non_blocking=True)
    if isinstance(batch, dict):
        return {name: _to(value, device) for name, value in batch.items()}
    return batch


def _random_state(device: torch.device) -> dict[str, Tensor]:
    state = {"cpu": torch.get_rng_state()}
    return {**state, "cuda": torch.cuda.get_rng_state(device)} if device.type == "cuda" else state


def _set_random_state(state: dict[str, Tensor], device: torch.device) -> None:
    torch.set_rng_state(state["cpu"])
    if device.type == "cuda" and "cuda" in state:
        torch.cuda.set_rng_state(state["cuda"], device)
