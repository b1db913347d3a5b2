"""Ask a gallery of CMU trials the queries of ``queries.txt`` and print what comes back as a Markdown table.

    python benchmarks/queries.py --gallery DIR [--index index.csv] [--first 10]

With ``--index`` (CMU's list of trials) the database's own description of each trial stands behind its name.
"""

from __future__ import annotations

import argparse
import csv
from pathlib import Path

from motionrt import Runtime

QUERIES = Path(__file__).with_name("queries.txt")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--gallery", required=True)
    parser.add_argument("--index", type=Path, help="index.csv with the columns trial and description")
    parser.add_argument("--first", type=int, default=None, help="only so many queries")
    args = parser.parse_args()
    known = descriptions(args.index) if args.index else {}
    queries = QUERIES.read_text(encoding="utf-8").splitlines()[: args.first]
    print("| query | best three hits (score, CMU's own description) |\n|---|---|")
    for query, hits in zip(queries, Runtime().retrieve(queries, 3, args.gallery), strict=True):
        cells = [f"{Path(hit.id).stem} ({hit.score:.2f}{known.get(Path(hit.id).stem, '')})" for hit in hits]
        print(f"| {query} | {' · '.join(cells)} |")


def descriptions(index: Path) -> dict[str, str]:
    """Trial -> its description, with a comma in front."""
    with index.open(encoding="utf-8", newline="") as file:
        return {row["trial"]: f", {row['description']}" for row in csv.DictReader(file)}


if __name__ == "__main__":
    main()
