"""Zero-shot transfer between sources: search one source by a model that was trained on all others.

    python -m motionrt_training.evaluate.transfer --corpus runs/mocap.npz --out runs/tables --leave-out cmu --minutes 10

A network is trained without each source named, and one with all of them, for the same time; then both search the test
clips of that source. Networks that are there already are not trained again, and are shared with `evaluate.ablations`.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from motionrt.errors import InvalidInputError
from motionrt.models import SentenceEncoder, Sessions
from motionrt_training.checkpoint import load_state
from motionrt_training.command import reports_errors
from motionrt_training.contrasts import contrast_scores
from motionrt_training.evaluate.ablations import OURS, Row, Table, folder_of, run_command, train_rows
from motionrt_training.evaluate.embedders import Embedder, load_torch
from motionrt_training.evaluate.pairs import PairSet, read_pairs
from motionrt_training.evaluate.protocols import by_style
from motionrt_training.evaluate.tables import markdown
from motionrt_training.packed import load_packed, without_source

HEAD = ("searched", "trained on", "steps", "minutes", "pairs", "R@1", "R@3", "R@10", "MedR", "side", "path")


def table_of(sources: Sequence[str]) -> Table:
    """What is trained: with everything, and without each of the sources."""
    rows = (Row("all sources", OURS), *(Row(f"all but {name}", f"{OURS} --leave-out {name}") for name in sources))
    return Table("Search in a source that was not trained on", "tmr", rows)


def measured(embedder: Embedder, pairs: PairSet) -> list[str]:
    """Text to motion on pairs, all against all, mean over the places in the lists of captions; sides and paths."""
    styles = [row.text_to_motion for row in by_style(embedder, pairs)]
    recalls = [sum(scores.recall[k] for scores in styles) / len(styles) for k in (1, 3, 10)]
    rank = sum(scores.median_rank for scores in styles) / len(styles)
    contrasts = contrast_scores(pairs.texts, pairs.motions, embedder.embed_text, embedder.embed_motion)
    sides = [contrasts.get(name, float("nan")) for name in ("side", "path")]
    return [str(len(pairs)), *(f"{value:.1f}" for value in (*recalls, rank, *sides))]


def transfer_table(sources: Sequence[str], corpus: Path, out: Path, sentences: SentenceEncoder) -> str:
    """Every source, searched by the network that saw it and by the one that did not, in Markdown."""
    table, body = table_of(sources), []
    everything, *others = table.rows
    for source, other in zip(sources, others, strict=True):
        pairs = read_pairs(corpus, "test", source)
        for row in (everything, other):
            path = folder_of(out, table, row) / "best.pt"
            embedder, steps = load_torch(path, sentences)
            minutes = f"{load_state(path)['elapsed'] / 60:.1f}"
            body.append([source, row.name, str(steps), minutes, *measured(embedder, pairs)])
    return markdown(HEAD, body)


@reports_errors
def main(arguments: Sequence[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description="Search sources by models that never saw them.")
    parser.add_argument("--corpus", type=Path, required=True, help="packed corpus of several sources (.npz)")
    parser.add_argument("--leave-out", nargs="+", required=True, metavar="SOURCE", help="sources, each in its turn")
    parser.add_argument("--out", type=Path, required=True, help="folder of the runs and of the page")
    parser.add_argument("--minutes", type=float, default=10.0, help="of training for each row (default: %(default)s)")
    parser.add_argument("--also", default="", help="options for every row, as one word: '--layers 3 --threads 1'")
    parser.add_argument("--models", help="manifest of the exported models, for the sentence encoder")
    args = parser.parse_args(arguments)
    corpus = load_packed(args.corpus)
    for source in args.leave_out:
        without_source(corpus, source)
        if not any(clip.source == source for clip in corpus.split("test")):
            raise InvalidInputError(f"no test clip is of the source '{source}', so that it cannot be searched")
    del corpus
    train_rows(table_of(args.leave_out), args, run_command)
    body = transfer_table(args.leave_out, args.corpus, args.out, SentenceEncoder(Sessions(args.models)))
    page = args.out / "transfer.md"
    page.write_text(f"# Search in a source that was not trained on\n\n{body}\n", encoding="utf-8", newline="\n")
    print(page)


if __name__ == "__main__":
    main()
