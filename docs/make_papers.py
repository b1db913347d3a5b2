"""Write the papers' figures into docs/papers.md, from the one file that holds them.

python docs/make_papers.py
"""

from __future__ import annotations

from pathlib import Path

from motionrt_training.evaluate.published import figures, papers, retrieval_figures
from motionrt_training.evaluate.tables import markdown

PAGE = Path(__file__).with_name("papers.md")
BEGIN, END = "<!-- figures -->\n", "<!-- end -->\n"


def made(page: str) -> str:
    """The page with its tables written anew."""
    before, _, rest = page.partition(BEGIN)
    _, _, after = rest.partition(END)
    return f"{before}{BEGIN}\n{tables()}\n\n{END}{after}"


def tables() -> str:
    """The papers, every single figure, and the rows of tables of retrieval."""
    listed = "\n".join(f"* {name}: {reference}" for name, reference in papers().items())
    single = markdown(
        ["paper", "where", "what", "figure"], [[f.paper, f.place, f.what, f"{f.value:g}"] for f in figures()]
    )
    rows = [
        [row.paper, f"Table {row.table}", f"{row.row}, {name}", *(f"{value:.2f}" for value in values)]
        for row in retrieval_figures()
        for name, values in (("text to motion", row.t2m), ("motion to text", row.m2t))
    ]
    head = ["paper", "where", "row", *(f"R@{k}" for k in (1, 2, 3, 5, 10)), "MedR"]
    return "\n\n".join([listed, single, markdown(head, rows)])


def main() -> None:
    PAGE.write_text(made(PAGE.read_text(encoding="utf-8")), encoding="utf-8", newline="\n")
    print(f"written: {PAGE}")


if __name__ == "__main__":
    main()
