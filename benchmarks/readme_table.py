"""Put a benchmark's figures into documents, between the markers that stand there.

    motionrt bench --against torch --json > bench.json
    python benchmarks/readme_table.py README.md bench.json                        # <!-- bench --> ... <!-- /bench -->
    python benchmarks/readme_table.py docs/performance.md bench.json --all        # every figure, not the chosen ones

Measures nothing; says so when a document has no markers, and changes nothing then.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from motionrt.bench.markdown import between, performance_tables, readme_table
from motionrt.errors import InvalidInputError

MARKER = "bench"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("document", type=Path)
    parser.add_argument("figures", type=Path, help="what motionrt bench --json printed")
    parser.add_argument("--all", action="store_true", help="every figure")
    args = parser.parse_args()
    found = json.loads(args.figures.read_text(encoding="utf-8"))
    try:
        write(args.document, found, everything=args.all)
    except InvalidInputError as error:
        print(f"{args.document}: {error}", file=sys.stderr)
        return 1
    return 0


def write(document: Path, found: Mapping[str, Any], *, everything: bool) -> None:
    """Put the tables of a benchmark between the document's markers."""
    tables = performance_tables(found) if everything else readme_table(found)
    text = document.read_text(encoding="utf-8")
    document.write_text(between(text, MARKER, tables), encoding="utf-8", newline="\n")


if __name__ == "__main__":
    sys.exit(main())
