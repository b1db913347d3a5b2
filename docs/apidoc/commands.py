"""The page of the command line."""

from __future__ import annotations

import argparse
from collections.abc import Iterator

ABOUT = """\
`motionrt COMMAND --help` says the same. Every command that prints data takes `--json`; every command takes `--quiet`
(`-q`) and `--verbose` (`-v`). `motionrt completion bash` prints what a shell needs to complete them.

| exit code | |
|---:|---|
| 0 | done |
| 1 | an error, one line on stderr; or what was checked did not pass |
| 2 | wrong usage |
| 3 | done, but some files or prompts were skipped, with reasons on stderr |
| 70 | a mistake of the program; `--verbose` shows where |
| 130 | interrupted |
| 141 | whoever read the output has gone |"""


def commands_page() -> str:
    """The command line, command by command."""
    from motionrt.cli import _parser

    parts = ["# Commands", ABOUT]
    for name, parser in _leaves(_parser(), "motionrt"):
        text = parser.description or ""
        head, _, rest = text.partition("\n")
        parts += [f"## {name}", head[:1].upper() + head[1:], f"```text\n{rest.strip()}\n```" if rest.strip() else ""]
        parts.append("\n".join(_option(action) for action in actions_of(parser) if _is_shown(action)))
    return "\n\n".join(part.rstrip() for part in parts if part) + "\n"


def _is_shown(action: argparse.Action) -> bool:
    return action.dest not in {"help", "quiet", "verbose"} and action.help not in {None, argparse.SUPPRESS}


def actions_of(parser: argparse.ArgumentParser) -> list[argparse.Action]:
    """What a parser understands; argparse has no public way to ask."""
    return parser._actions  # noqa: SLF001


def _leaves(parser: argparse.ArgumentParser, name: str) -> Iterator[tuple[str, argparse.ArgumentParser]]:
    below = [action for action in actions_of(parser) if isinstance(action.choices, dict)]
    if not below:
        yield name, parser
    for action in below:
        for word, child in action.choices.items():
            yield from _leaves(child, f"{name} {word}")


def _option(action: argparse.Action) -> str:
    value = action.metavar or ("|".join(map(str, action.choices)) if action.choices else "")
    value = " ".join(value) if isinstance(value, tuple) else value
    takes = value if action.nargs != 0 else ""
    words = ", ".join(action.option_strings) or value or action.dest
    shown = f"{words} {takes}".strip() if action.option_strings else words
    return f"* `{shown}`: {(action.help or '').replace('|', chr(92) + '|')}"
