"""Write the API reference: Markdown pages in docs/api/, out of signatures and docstrings.

python docs/make_api.py            # write the pages
python docs/make_api.py --check    # only say which pages are out of date; the exit code is then 1
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from apidoc.commands import commands_page
from apidoc.contents import PAGES, missing
from apidoc.prose import first_sentence
from apidoc.things import described, errors_page, public_members, shown, target_of

HERE = Path(__file__).parent / "api"


def main(argv: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="write nothing")
    check = parser.parse_args(argv).check
    if missing():
        sys.exit(f"public, but on no page: {', '.join(missing())}; add them to docs/apidoc/contents.py")
    written = pages()
    stale = [name for name, text in written.items() if _read(HERE / name) != text]
    if not check:
        HERE.mkdir(exist_ok=True)
        for name in stale:
            (HERE / name).write_text(written[name], encoding="utf-8")
    for name in stale:
        print(f"{'out of date' if check else 'written'}: docs/api/{name}", file=sys.stderr)
    return 1 if check and stale else 0


def pages() -> dict[str, str]:
    """The text of every page by its file name."""
    found = {f"{name}.md": _page(*content) for name, content in PAGES.items()}
    return {"README.md": _index(), **found, "errors.md": errors_page(), "commands.md": commands_page()}


def _read(path: Path) -> str:
    return path.read_text(encoding="utf-8") if path.is_file() else ""


def _page(title: str, about: str, places: Sequence[str]) -> str:
    parts = [f"# {title}", about, *(text for place in places for text in described(place))]
    return "\n\n".join(part.rstrip() for part in parts if part) + "\n"


def _index() -> str:
    """Every public name, with its first sentence and where it stands; of the runtime every verb."""
    lines = ["# API reference", "Written by `python docs/make_api.py` from signatures and docstrings; edit those."]
    for name, (title, about, places) in PAGES.items():
        rows = [row for place in places for row in _rows(name, place)]
        lines += [f"## [{title}]({name}.md)", about, "\n".join(["| | |", "|---|---|", *rows])]
    lines += [
        "## [Errors](errors.md)",
        "Every error that is raised on purpose; `except motionrt.MotionRTError` catches them all.",
        "## [Commands](commands.md)",
        "What the command `motionrt` understands.",
    ]
    return "\n\n".join(lines) + "\n"


def _rows(page: str, place: str) -> Iterator[str]:
    target = target_of(place)
    yield f"| [`{shown(place)}`]({page}.md#{_anchor(shown(place))}) | {first_sentence(target, place)} |"
    for name, member in public_members(target) if place == "motionrt:Runtime" else ():
        verb = f"Runtime.{name}"
        yield f"| [`{verb}`]({page}.md#{_anchor(verb)}) | {first_sentence(member)} |"


def _anchor(heading: str) -> str:
    """How GitHub names a heading."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


if __name__ == "__main__":
    sys.exit(main())
