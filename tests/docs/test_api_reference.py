"""The API reference: up to date, complete, and true as far as a program can tell."""

from __future__ import annotations

import ast
import inspect
import re
import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from apidoc.contents import PAGES, missing
from apidoc.prose import markdown
from apidoc.signatures import code, signature_of
from apidoc.things import public_members, target_of
from make_api import HERE, main, pages

import motionrt
from motionrt import errors

PLACES = [place for _, _, places in PAGES.values() for place in places]
TYPED = {name: value for name, value in vars(errors).items() if inspect.isclass(value)}


@pytest.mark.parametrize("name", sorted(pages()))
def test_the_committed_reference_is_what_the_docstrings_say(name: str) -> None:
    written = (HERE / name).read_text(encoding="utf-8") if (HERE / name).is_file() else ""
    assert written == pages()[name], "run: python docs/make_api.py"


def test_no_page_is_left_over() -> None:
    assert {path.name for path in HERE.iterdir()} == set(pages())


def test_every_public_name_stands_on_a_page() -> None:
    assert not missing()
    listed = "\n".join(pages().values())
    assert all(
        f"## motionrt.{name}" in listed
        for name in motionrt.__all__
        if name not in {"__version__", "errors", "MotionRTError"}
    )


def test_every_link_leads_to_a_heading() -> None:
    texts = pages()
    for name, text in texts.items():
        for page, anchor in re.findall(r"\]\(([\w.]*)#([\w-]+)\)", text):
            headings = re.findall(r"^#+ (.*)$", texts[page or name], re.MULTILINE)
            assert anchor in {re.sub(r"[^\w\- ]", "", one.lower()).replace(" ", "-") for one in headings}, (
                name,
                anchor,
            )


def test_the_check_notices_a_page_that_was_edited(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("make_api.HERE", tmp_path / "api")
    assert main(["--check"]) == 1
    assert main([]) == 0
    assert main(["--check"]) == 0
    page = tmp_path / "api" / "runtime.md"
    page.write_text(page.read_text(encoding="utf-8") + "more", encoding="utf-8")
    assert main(["--check"]) == 1


def test_a_docstring_becomes_markdown() -> None:
    text = "Do ``x`` with :class:`~motionrt.Motion`.\n\nArgs:\n    a, b: one\n        more.\n    c: two."
    text += "\n\nRaises:\n    E: bad."
    assert markdown(text) == (
        "Do `x` with `Motion`.\n\n**Arguments**\n\n* `a`, `b`: one\n  more.\n* `c`: two.\n\n**Raises**\n\n* `E`: bad."
    )


def test_signatures_are_as_they_are_written() -> None:
    def short(a: int, *rest: str, b: dict[str, int] | None = None, **more: float) -> list[int]: ...

    assert signature_of(short) == "(a: int, *rest: str, b: dict[str, int] | None = None, **more: float) -> list[int]"
    assert code("f", "(a: dict[str, int], *, b: int)").splitlines()[1] == "f(a: dict[str, int], *, b: int)"
    broken = code("f", f"(a: dict[str, int], *, {'b' * 100}: int) -> int").splitlines()
    assert broken[1:4] == ["f(", "    a: dict[str, int],", "    *,"]
    assert broken[-2] == ") -> int"


# -- docstrings


def _documented() -> Iterator[tuple[str, Any, type | None]]:
    """Every public thing: its name, itself, the class that it belongs to."""
    for place in PLACES:
        target = target_of(place)
        if inspect.isclass(target):
            yield place, target, None
            for name, member in public_members(target):
                yield (
                    f"{place}.{name}",
                    getattr(member, "fget", None) or getattr(member, "func", None) or member,
                    target,
                )
        elif callable(target):
            yield place, target, None


THINGS = {name: (target, owner) for name, target, owner in _documented()}


@pytest.mark.parametrize("name", THINGS)
def test_everything_public_has_a_docstring(name: str) -> None:
    target, _ = THINGS[name]
    text = inspect.getdoc(target) or ""
    assert len(text) > 10 or name.endswith(("__len__", "__iter__"))
    assert not text.startswith(f"{getattr(target, '__name__', '')}("), (
        "that is what dataclass writes where there is none"
    )


@pytest.mark.parametrize("name", THINGS)
def test_errors_that_are_raised_are_in_the_docstring(name: str) -> None:
    """What a function raises itself stands in its docstring, by name or by the name of a base, or in its class's."""
    target, owner = THINGS[name]
    told = " ".join([inspect.getdoc(target) or "", (inspect.getdoc(owner) or "") if owner else ""])
    for error in _raised(target):
        names = [base.__name__ for base in TYPED[error].__mro__]
        assert any(one in told for one in names if one in TYPED), (
            f"{name} raises {error}; its docstring does not say so"
        )


def _raised(target: Any) -> set[str]:
    """Names of the typed errors in the ``raise`` statements of a function, or of a dataclass's own check."""
    function = vars(target).get("__post_init__") if inspect.isclass(target) else target
    if function is None or not inspect.isfunction(function):
        return set()
    tree = ast.parse(textwrap.dedent(inspect.getsource(function)))
    raised = [node.exc for node in ast.walk(tree) if isinstance(node, ast.Raise)]
    calls = [exc.func for exc in raised if isinstance(exc, ast.Call)]
    return {call.id for call in calls if isinstance(call, ast.Name) and call.id in TYPED}


@pytest.mark.parametrize("name", THINGS)
def test_arguments_in_a_docstring_are_those_of_the_signature(name: str) -> None:
    """An ``Args`` section names arguments that there are, and leaves none out."""
    target, _ = THINGS[name]
    found = re.search(r"^Args:\n(.*?)(?=^\S|\Z)", inspect.getdoc(target) or "", re.MULTILINE | re.DOTALL)
    if not found:
        return
    entries = re.findall(r"^ {4}([\w*][\w*, ]*?):", found[1], re.MULTILINE)
    told = {word.strip().lstrip("*") for entry in entries for word in entry.split(",")}
    assert told == set(inspect.signature(target).parameters) - {"self", "cls"}
