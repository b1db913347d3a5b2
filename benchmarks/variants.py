"""Are the small files as good as the float32 ones? Walking and generation with each, by the same measures and seeds.

    python benchmarks/variants.py SCENES [--recordings runs/recordings.npz] [--variants fp32 int8] [--json out.json]

Walking: the routes of ``benchmarks/walks.py``, each several times with other paths. Generation: the prompts of
``motionrt_training.evaluate.prompts``, the same noise for every variant, judged by the float32 retrieval model. With
``--recordings`` also the transitions of ``motionrt_training.evaluate.transitions``. The first variant is what the
others are compared with; variants that are not shipped are built by ``python -m motionrt_export all``. Prints a
Markdown table; exit code 1 when a measure of another variant is worse by more than 5 %.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
import numpy.typing as npt
from walk_tables import together
from walks import ROUTES, walked

from motionrt import Runtime
from motionrt.models import Sessions, TransitionModel
from motionrt.motion.feet.lock import lock_feet
from motionrt_export.measured import Measured
from motionrt_training.corpora.recordings import load_recordings
from motionrt_training.evaluate import prompts, transitions

AGAIN = 1000  # added to the seed of a route for another path
WORSE = 0.05  # share that a measure may be worse by


@dataclass(frozen=True)
class Measure:
    """A row of the table.

    Attributes:
        name: with its unit.
        better: 1 where more is better, -1 where less is, 0 where it only should stay alike.
        values: one for every variant.
        least: changes are shares of at least so much: values near zero have no percents.
        noise: of every variant, the standard error of its change, as a share: how much of it is chance, as another
            footfall changes all that follows. Empty where it is not known.
    """

    name: str
    better: int
    values: tuple[float, ...]
    least: float = 0.0
    noise: tuple[float, ...] = ()

    def change(self, column: int) -> float:
        """Of a variant against the first one, as a share of its value."""
        first = self.values[0]
        return (self.values[column] - first) / max(abs(first), self.least, 1e-12)

    def worse(self, column: int) -> float:
        """By what share a variant is worse; 0 for one that is better."""
        change = self.change(column)
        return abs(change) if self.better == 0 else max(0.0, -self.better * change)


WALKING = (  # field of a row of walks, name, which way is better, scale, least
    ("waypoints", "waypoints reached (%)", 1, 100, 0.0),
    ("goal_m", "distance from the goal (cm)", -1, 100, 10.0),
    ("off_path_m", "distance from the path, mean (cm)", -1, 100, 0.0),
    ("skate_cm", "foot skate (cm/frame)", -1, 1, 0.0),
    ("skate_unlocked_cm", "foot skate, feet not locked (cm/frame)", -1, 1, 0.0),
    ("jerk", "jerk (m/s³)", -1, 1, 0.0),
    ("height_m", "height of the pelvis (cm)", 0, 100, 0.0),
    ("height_drift_cm", "drift of the pelvis' height (cm)", 0, 1, 10.0),
)
PROMPTS = (
    ("recall_1", "R@1 of 32 prompts (%)", 1),
    ("recall_3", "R@3 (%)", 1),
    ("median_rank", "median rank", -1),
    ("skate_cm", "foot skate (cm/frame)", -1),
    ("jerk", "jerk (m/s³)", -1),
    ("diversity", "diversity", 1),
    ("multimodality", "multimodality", 1),
)
OWNERS = {"walking": "walknet", "generation": "latent_denoiser", "transitions": "transnet"}
TRANSITIONS = (
    ("joint_cm", "joints off the recording (cm)"),
    ("skate", "foot skate (cm/frame)"),
    ("seed_step", "root's change of speed at the seam (m/s)"),
)


def main() -> int:
    """Measure every variant, print, and say by the exit code whether none is worse."""
    args = parser().parse_args()
    rows = walking(args.variants, args)
    rows += generation(args.variants, args)
    if args.recordings:
        rows += transition(args.variants, args)
    print(table(args.variants, rows))
    faults = [
        f"{variant}, {row.name}: worse by {100 * row.worse(column):.1f} %"
        for row in rows
        for column, variant in enumerate(args.variants)
        if row.worse(column) > WORSE
    ]
    print("\n" + ("\n".join(faults) or f"Nothing is worse by more than {100 * WORSE:.0f} %."))
    if args.json:
        found = {"variants": args.variants, "rows": [asdict(row) for row in rows], "worse": faults}
        args.json.write_text(json.dumps(found, indent=1), encoding="utf-8")
    if args.figures:
        note(args.figures, args.variants, rows)
    return 1 if faults else 0


def note(path: Path, variants: Sequence[str], rows: Sequence[Measure]) -> None:
    """Into the file that the manifest's quality figures come from: of each part, at the model that it is about."""
    measured = Measured.read(path)
    quality = {model: {name: dict(row) for name, row in found.items()} for model, found in measured.quality.items()}
    for row in rows:
        part, _, name = row.name.partition(": ")
        for variant, value in zip(variants, row.values, strict=True):
            quality.setdefault(OWNERS[part], {}).setdefault(variant, {})[name] = float(f"{value:.3g}")
    made = {**measured.made, "quality": "python benchmarks/variants.py"}
    replace(measured, quality=quality, made=made).write(path)


def parser() -> argparse.ArgumentParser:
    """The options."""
    result = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    result.add_argument("scenes", type=Path, help="folder with the scenes of benchmarks/walks.py")
    result.add_argument("--recordings", type=Path, help="recordings (.npz) whose test split has gaps to fill")
    result.add_argument(
        "--variants", nargs="+", default=["fp32", "int8"], help="the first is the measure of the others"
    )
    result.add_argument("--models", type=Path, help="models manifest or folder (default: the shipped models)")
    result.add_argument("--samples", type=int, default=5, help="motions of every prompt (default: %(default)s)")
    result.add_argument("--repeats", type=int, default=3, help="paths of every route (default: %(default)s)")
    result.add_argument("--first", type=int, help="only so many routes and prompts, for a trial")
    result.add_argument("--metres", type=float, help="walk only so far, for a trial")
    result.add_argument("--json", type=Path, help="write all figures here, too")
    result.add_argument("--figures", type=Path, help="models/figures.yaml: put the figures in for the next export")
    return result


def walking(variants: Sequence[str], args: argparse.Namespace) -> list[Measure]:
    """All routes as one, and how much the change differs from walk to walk."""
    routes = [
        replace(route, seed=route.seed + AGAIN * repeat)
        for repeat in range(args.repeats)
        for route in ROUTES[: args.first]
    ]
    rows = []
    for variant in variants:
        runtime = Runtime(args.models, threads=1, variant=variant)
        rows.append([walked(runtime, route, args.scenes, args.metres) for route in routes])
        print(f"walked with {variant}", file=sys.stderr, flush=True)
    found = [together(walks) for walks in rows]
    measures = []
    for key, name, better, scale, least in WALKING:
        values = tuple(scale * getattr(row, key) for row in found)
        each = scale * np.array([[getattr(walk, key) for walk in walks] for walks in rows])
        noise = standard_errors(each - each[0]) / max(abs(values[0]), least, 1e-12)
        measures.append(Measure(f"walking: {name}", better, values, least, tuple(float(x) for x in noise)))
    return measures


def standard_errors(differences: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Of the means of rows ``(V, N)``."""
    count = differences.shape[1]
    return differences.std(axis=1, ddof=1) / np.sqrt(count) if count > 1 else np.zeros(len(differences))


def generation(variants: Sequence[str], args: argparse.Namespace) -> list[Measure]:
    """The prompts, as the default sampler makes them, feet locked, and the skate of free feet."""
    asked = prompts.read_prompts()[: args.first]
    judge, texts = (
        Runtime(args.models, threads=1, variant=variants[0], text_tower="full"),
        [prompt.text for prompt in asked],
    )
    locked, free = [], []
    for variant in variants:
        runtime = Runtime(args.models, threads=1, variant=variant)
        motions = prompts.generated(runtime, asked, args.samples, "diffusion", foot_lock=False)
        free.append(prompts.moved([motion for group in motions for motion in group])[0])
        locked.append(prompts.judged(judge, texts, [[lock_feet(motion) for motion in group] for group in motions]))
        print(f"generated with {variant}", file=sys.stderr, flush=True)
    rows = [
        Measure(f"generation: {name}", better, tuple(float(getattr(row, key) or 0.0) for row in locked))
        for key, name, better in PROMPTS
    ]
    return [*rows, Measure("generation: foot skate, feet not locked (cm/frame)", -1, tuple(free))]


def transition(variants: Sequence[str], args: argparse.Namespace) -> list[Measure]:
    """Gaps of held-out recordings."""
    windows = transitions.held_out(load_recordings(args.recordings), "test", 500)
    sessions, found = Sessions(args.models, threads=1), []
    for variant in variants:
        fill = partial(transitions.filled, TransitionModel(sessions, variant))
        found.append(transitions.measure(fill(windows), windows))
    return [Measure(f"transitions: {name}", -1, tuple(getattr(row, key) for row in found)) for key, name in TRANSITIONS]


def table(variants: Sequence[str], rows: Sequence[Measure]) -> str:
    """Every measure with every variant, and the change against the first one."""
    head = ["", variants[0], *(part for name in variants[1:] for part in (name, "change"))]
    lines = [head, ["---", *["---:"] * (len(head) - 1)]]
    for row in rows:
        cells = [figure(row.values[0])]
        for column in range(1, len(variants)):
            spread = f" ± {100 * row.noise[column]:.1f}" if row.noise else ""
            cells += [figure(row.values[column]), f"{100 * row.change(column):+.1f}{spread} %"]
        lines.append([row.name, *cells])
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def figure(value: float) -> str:
    """Three digits that count."""
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:.1f}" if abs(value) >= 10 else f"{value:.2f}"


if __name__ == "__main__":
    sys.exit(main())
