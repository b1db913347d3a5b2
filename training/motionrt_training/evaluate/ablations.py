"""The papers' tables of ablations, each by one command: every row is trained for the same time, then measured.

    python -m motionrt_training.evaluate.ablations losses --corpus runs/mine/pairs.npz --out runs/tables --minutes 10
    python -m motionrt_training.evaluate.ablations synthetic --corpus runs/mine/recordings.npz --out runs/tables \
        --captions runs/mine/captions.jsonl --score runs/score/best.pt --minutes 10

Rows that are there already are not trained again, so that the command can be given in pieces; `--list` only prints what
would run, `--trained` only measures what is there. `--also` adds options to every row, such as `--layers 3`.
"""

from __future__ import annotations

import argparse
import shlex
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from motionrt.errors import InvalidInputError
from motionrt_training.checkpoint import load_state
from motionrt_training.command import reports_errors
from motionrt_training.evaluate import generation
from motionrt_training.evaluate.simultaneous import LONGEST
from motionrt_training.evaluate.tables import markdown

Run = Callable[[list[str]], None]
SCORES = {
    "tmr": [
        f"test_{name}" for name in ["t2m_R1", "t2m_R3", "t2m_R10", "t2m_MedR", "m2t_R1", "m2t_R10", "side", "path"]
    ],
    "transnet": ["joint_cm", "pose_cm", "skate"],
}
"""What the checkpoints of a recipe measured: search on the test split; transitions on that of validation."""


@dataclass(frozen=True)
class Row:
    """A line of a table: what is trained with which options, and how it is asked for two actions."""

    name: str
    options: str = ""
    way: str = "text"


@dataclass(frozen=True)
class Table:
    """A table of a paper: which recipe, and its lines."""

    paper: str
    recipe: str
    rows: tuple[Row, ...]


def _values(option: str, *values: object, paper: object, always: str = "") -> tuple[Row, ...]:
    """A line for every value; the paper's is the recipe's default, and so trained once for all tables."""
    return tuple(
        Row(f"{v} (the paper's)", always) if v == paper else Row(f"{v}", f"{always} {option} {v}".strip())
        for v in values
    )


OURS = "--patch 8 --batch 40 --no-rotations --contrastive-weight 0.5 --token-dropout 0.1"
PLAIN = "--no-twins --no-straightened --slots 0 --spoken 0"
POINTS = "--no-reconstruction --contrast mean --kl-weight 0 --latent-weight 0"
SINGLES = "--captions 0 --no-pairs"
LABELS = "--captions 0"
TABLES: Mapping[str, Table] = {
    "losses": Table("TMR, Table 3", "tmr", (
        Row("reconstruction, no contrast (TEMOS)", "--no-contrastive"),
        Row("contrast alone", POINTS),
        Row("margin loss", "--margin"),
        Row("InfoNCE, no filtering", "--threshold none"),
        Row("InfoNCE, filtering", "--no-directions"),
    )),
    "filtering": Table("TMR, Table 4", "tmr", (
        *_values(
            "--threshold", 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95, paper=0.8, always="--no-directions"
        ),
        Row("none", "--threshold none"),
    )),
    "temperature": Table("TMR, sweep of the temperature", "tmr", _values(
        "--temperature", 0.001, 0.01, 0.1, 1.0, paper=0.1
    )),
    "weight": Table("TMR, sweep of the weight of InfoNCE", "tmr", _values(
        "--contrastive-weight", 0.001, 0.01, 0.1, 1.0, paper=0.1
    )),
    "batch": Table("TMR, sweep of the batch", "tmr", _values("--batch", 16, 32, 64, 128, paper=32)),
    "width": Table("TMR, sweep of the latent", "tmr", _values("--d", 64, 128, 256, 512, paper=256)),
    "rivals": Table("TMR, Tables 1 and 2", "tmr", (
        Row("Guo-style: GRUs, margin loss", f"{PLAIN} {POINTS} --batch 40 --no-rotations --encoder gru --margin"),
        Row("TEMOS-style: no contrast", f"{OURS} {PLAIN} --no-contrastive"),
        Row("TMR, no choices of ours", f"{OURS} {PLAIN}"),
        Row("as shipped, small", OURS),
    )),
    "choices": Table("Search, what is not in the papers", "tmr", (
        Row("as shipped, small", OURS),
        Row("no mirror twins in the batch", f"{OURS} --no-twins"),
        Row("twins count like any negative", f"{OURS} --hard 1"),
        Row("no straightened clips", f"{OURS} --no-straightened"),
        Row("no heads for attributes", f"{OURS} --slots 0"),
        Row("no texts of what was measured", f"{OURS} --spoken 0"),
        Row("no crops, no change of speed", f"{OURS} --crop 1 --speed 0"),
    )),
    "inputs": Table("SINC, Table 2", "temos", (
        Row("single actions", f"{SINGLES} --synthetic 0"),
        Row("single actions, composed", f"{SINGLES} --synthetic 0", "compose"),
        Row("separate texts (STE)", f"{LABELS} --separate --synthetic 0.5", "separate"),
        Row("SINC", f"{LABELS} --synthetic 0.5"),
    )),
    "synthetic": Table("SINC, Table 3", "temos", (
        *(Row(f"real pairs, {100 * p:g} % synthetic", f"{LABELS} --synthetic {p:g}") for p in (0, 0.25, 0.5, 1)),
        *(Row(f"no real pairs, {100 * p:g} % synthetic", f"{SINGLES} --synthetic {p:g}") for p in (0, 0.5, 1)),
        Row("real pairs, 50 % of random parts", f"{LABELS} --synthetic 0.5 --random-parts"),
        Row("no real pairs, 100 % of random parts", f"{SINGLES} --synthetic 1 --random-parts"),
    )),
    "window": Table("Continual, choice of M", "transnet", (
        Row("M = 100", "--window 100"), Row("M = 120 (the paper's)"), Row("M = 180", "--window 180"),
    )),
    "transition": Table("Continual, training of TransNet", "transnet", (
        Row("as shipped"),
        Row("by squares of the features alone", "--loss l2"),
        Row("as published: squares, no patches, lr 1e-5", "--loss l2 --patch 1 --lr 1e-5"),
    )),
}  # fmt: skip
"""Name -> table; two rows of the same options are trained once."""


def folder_of(out: Path, table: Table, row: Row) -> Path:
    """Where a row is trained: named after its options, so that tables share what they have in common."""
    words = [word.lstrip("-") for word in row.options.split()]
    return out / f"{table.recipe}-{'-'.join(words) or 'default'}"


def command_of(table: Table, row: Row, args: argparse.Namespace) -> list[str]:
    """The command line that trains a row; its own options hold against those for every row."""
    words = [sys.executable, "-m", f"motionrt_training.recipes.{table.recipe}", "--corpus", str(args.corpus)]
    words += ["--out", str(folder_of(args.out, table, row)), "--minutes", str(args.minutes)]
    words += ["--captions-file", str(args.captions)] if table.recipe == "temos" else []
    return [*words, *shlex.split(args.also), *row.options.split()]


def train_rows(table: Table, args: argparse.Namespace, run: Run) -> None:
    """Train every row that is not there yet."""
    for row in table.rows:
        if not (folder_of(args.out, table, row) / "best.pt").is_file():
            run(command_of(table, row, args))


def trained(table: Table, args: argparse.Namespace) -> list[Row]:
    """The rows of a table that are there."""
    return [row for row in table.rows if (folder_of(args.out, table, row) / "best.pt").is_file()]


def checkpoint_page(table: Table, rows: Sequence[Row], out: Path) -> str:
    """Rows of a table as their checkpoints measured them, see `SCORES`."""
    scores = SCORES[table.recipe]
    head = ["", "steps", "minutes", *(name.removeprefix("test_").replace("_", " ") for name in scores)]
    body = []
    for row in rows:
        state = load_state(folder_of(out, table, row) / "best.pt")
        figures = (f"{state['measures'].get(name, float('nan')):.{2 if name == 'skate' else 1}f}" for name in scores)
        body.append([row.name, state["step"], f"{state['elapsed'] / 60:.1f}", *figures])
    return markdown(head, body)


def pair_page(table: Table, rows: Sequence[Row], args: argparse.Namespace) -> str:
    """Rows of a table of SINC: how long they were trained, then measured by `evaluate.generation pairs`."""
    page = args.out / f"{args.table}-pairs.md"
    words = ["pairs", "--recordings", str(args.corpus), "--captions", str(args.captions), "-o", str(page)]
    words += ["--encoder", str(args.score)] if args.score else []
    words += ["--samples", str(args.samples), "--longest", str(args.longest)]
    budget = []
    for row in rows:
        path = folder_of(args.out, table, row) / "best.pt"
        words += ["--row", f"{row.name}={row.way}:{path}"]
        state = load_state(path)
        budget.append([row.name, row.options, state["step"], f"{state['elapsed'] / 60:.1f}"])
    generation.main(words)
    return f"{markdown(['', 'options', 'steps', 'minutes'], budget)}\n\n{page.read_text(encoding='utf-8')}"


def run_command(words: list[str]) -> None:
    """Say a command and run it; CalledProcessError when it fails."""
    print(shlex.join(words), flush=True)
    subprocess.run(words, check=True)


@reports_errors
def main(arguments: Sequence[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description="Train and measure the rows of a paper's table.")
    parser.add_argument("table", choices=tuple(TABLES))
    parser.add_argument("--corpus", type=Path, required=True, help="pairs.npz for TMR, recordings.npz for others")
    parser.add_argument("--captions", type=Path, help="SINC: captions.jsonl with labels and parts")
    parser.add_argument("--score", type=Path, help="SINC: checkpoint whose motion encoder gives the TEMOS score")
    parser.add_argument("--out", type=Path, required=True, help="folder of the runs and of the page")
    parser.add_argument("--minutes", type=float, default=10.0, help="of training for each row (default: %(default)s)")
    parser.add_argument("--also", default="", help="options for every row, as one word: '--layers 3 --threads 1'")
    parser.add_argument("--samples", type=int, default=0, help="SINC: samples of every pair beside its mean latent")
    parser.add_argument("--longest", type=int, default=LONGEST, help="SINC: frames of a pair (default: %(default)s)")
    parser.add_argument("--list", action="store_true", help="only print the commands")
    parser.add_argument("--trained", action="store_true", help="train nothing, measure the rows that are there")
    args = parser.parse_args(arguments)
    table = TABLES[args.table]
    if table.recipe == "temos" and args.captions is None:
        raise InvalidInputError(f"{table.paper} needs --captions, the captions.jsonl beside the recordings")
    if args.list:
        print("\n".join(shlex.join(command_of(table, row, args)) for row in table.rows))
        return
    if not args.trained:
        train_rows(table, args, run_command)
    rows = trained(table, args)
    if not rows:
        raise InvalidInputError(f"no row of the table is trained in {args.out}; leave out --trained")
    body = pair_page(table, rows, args) if table.recipe == "temos" else checkpoint_page(table, rows, args.out)
    how = f" with `{args.also}`" if args.also else ""
    heading = f"# {table.paper}\n\nEach row was trained for at most {args.minutes:g} minutes{how}"
    page = args.out / f"{args.table}.md"
    page.write_text(f"{heading}, on {args.corpus}.\n\n{body}\n", encoding="utf-8", newline="\n")
    print(page)


if __name__ == "__main__":
    main()
