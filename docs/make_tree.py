"""Write the table of files and median lines of the runtime's folders into docs/architecture.md.

python docs/make_tree.py
"""

from __future__ import annotations

import re
from pathlib import Path
from statistics import median

PAGE = Path(__file__).with_name("architecture.md")
ROOT = PAGE.parents[1] / "runtime" / "motionrt"


def counts(folder: Path) -> str:
    """Python files below a folder, and their median lines."""
    lines = [len(path.read_text(encoding="utf-8").splitlines()) for path in folder.rglob("*.py")]
    return f"{len(lines)} / {median(lines):.0f}"


def made(page: str) -> str:
    """The page with the last column of its table counted anew; rows of folders that are new are added."""
    head, table, rest = re.split(r"(?<=\| folder \| before \| after \|\n)|(?=\nImport circles)", page, maxsplit=2)
    rows = dict(re.findall(r"^\| (\S+) \|(.*?)\|[^|\n]*\|$", table, flags=re.MULTILINE))
    rows.pop("---", None)
    folders = {f"`{path.name}`": path for path in ROOT.iterdir() if any(path.rglob("*.py")) and path.name[0] != "_"}
    lines = [f"| {name} |{rows.get(name, ' ')}| {counts(folders[name])} |" for name in sorted(folders)]
    return head + "\n".join(["|---|---|---|", *lines, f"| all |{rows['all']}| {counts(ROOT)} |", rest])


if __name__ == "__main__":
    PAGE.write_text(made(PAGE.read_text(encoding="utf-8")), encoding="utf-8", newline="\n")
    print(f"written: {PAGE}")
