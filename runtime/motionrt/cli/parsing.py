"""Arguments as people type them: near misses get a suggestion, and places are written ``X Z`` or ``X,Z``."""

from __future__ import annotations

import argparse
import difflib
import re
from collections.abc import Iterable, Sequence
from typing import Any, NoReturn

from motionrt.cli.console import complain
from motionrt.errors import InvalidInputError

_SYNONYMS = {
    "search": "retrieve",
    "find": "retrieve",
    "query": "retrieve",
    "index": "gallery",
    "build": "gallery",
    "create": "generate",
    "make": "generate",
    "blend": "compose",
    "mix": "compose",
    "play": "view",
    "show": "view",
    "open": "view",
    "gui": "studio",
    "draw": "render",
    "export": "convert",
    "cut": "trim",
    "mapping": "rig",
    "character": "retarget",
    "benchmark": "bench",
    "caption": "describe",
    "version": "--version",
    "help": "--help",
}
"""What a command may be called elsewhere -> what it is called here."""

_CHOICE = re.compile(r"(?s)argument (?P<what>.*?): invalid choice: '(?P<given>.*?)' \(choose from (?P<choices>.*)\)$")
_SAID = [
    (re.compile(f"(?s){pattern}"), words)
    for pattern, words in (
        (r"the following arguments are required: (.*)", r"missing: \1"),
        (r"one of the arguments (.*) is required", r"missing: one of \1"),
        (r"argument (.*?): invalid int value: (.*)", r"\1: a whole number is wanted, not \2"),
        (r"argument (.*?): invalid float value: (.*)", r"\1: a number is wanted, not \2"),
        (r"argument (.*?): expected one argument", r"\1: a value is missing"),
        (r"argument (.*?): expected (\d+) arguments", r"\1: \2 values are wanted"),
        (r"argument (.*?): expected at least one argument", r"\1: a value is missing"),
        (r"argument (.*?): not allowed with argument (.*)", r"\1 and \2 do not go together"),
        (r"argument (.*?): ignored explicit argument (.*)", r"\1 takes no value, but has \2"),
        (r"ambiguous option: (.*?) could match (.*)", r"\1: which of these is meant: \2?"),
        (r"unrecognized arguments: (.*)", r"unknown: \1"),
        (r"argument (.*)", r"\1"),
    )
]
"""What argparse says -> what is said instead."""

_PLACES = ("--to", "--from")
_NUMBER = r"-?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_PLACE = re.compile(f"({_NUMBER})\\s*,\\s*({_NUMBER})")


class WrongUsageError(InvalidInputError):
    """Arguments that each are right but do not go together; the command ends with exit code 2."""


class Parser(argparse.ArgumentParser):
    """An argument parser whose errors name the nearest command or option."""

    def parse_known_args(self, args: Sequence[str] | None = None, namespace: Any = None) -> Any:  # type: ignore[override]
        """Parse; arguments left over are an error of this command, not of the program."""
        found, left = super().parse_known_args(args, namespace)
        if left:
            self.error(f"unrecognized arguments: {' '.join(left)}{self._nearest_options(left)}")
        named = {action.dest: _longest(action.option_strings) for action in self._actions if action.option_strings}
        found.options = {**named, **getattr(found, "options", {})}
        return found, left

    def error(self, message: str) -> NoReturn:
        """One line: what is wrong, what may have been meant, where it is explained; exit code 2."""
        wrong, after = _CHOICE.match(message), f"see '{self.prog} --help'"
        if wrong:
            choices = re.findall(r"[\w.-]+", wrong["choices"])
            near, known = _meant(wrong["given"], choices), ", ".join(choices)
            if wrong["what"] == "COMMAND":
                message, after = f"no command '{wrong['given']}'{near}", f"'{self.prog} --help' lists them all"
            else:
                message = f"{wrong['what']} cannot be '{wrong['given']}'{near or f'; can be: {known}'}"
        else:
            message = _in_plain_words(message)
        complain(f"motionrt: error: {message} ({after})")
        self.exit(2)

    def _nearest_options(self, left: Iterable[str]) -> str:
        options = [one for one in left if one.startswith("-")]
        return _meant(options[0].split("=")[0], list(self._option_string_actions)) if options else ""


def _in_plain_words(message: str) -> str:
    """What argparse says, in the words of somebody who types."""
    for pattern, words in _SAID:
        found = pattern.fullmatch(message)
        if found:
            return found.expand(words)
    return message


def split_places(arguments: Sequence[str]) -> list[str]:
    """``--to 3,-2`` and ``--to=3,-2`` as ``--to 3 -2``."""
    found: list[str] = []
    for one in arguments:
        name, given, value = one.partition("=")
        if given and name in _PLACES and (place := _PLACE.fullmatch(value)):
            found += [name, *place.groups()]
        elif found and found[-1] in _PLACES and (place := _PLACE.fullmatch(one)):
            found += place.groups()
        else:
            found.append(one)
    return found


def _longest(spellings: Sequence[str]) -> str:
    return next((one for one in spellings if one.startswith("--")), spellings[0])


def _meant(given: str, known: Sequence[str]) -> str:
    """``; did you mean ...?``, where something is near enough."""
    near = difflib.get_close_matches(given, known, n=2, cutoff=0.6)
    same = _SYNONYMS.get(given)
    if same in known or (same or "").startswith("--"):
        near = [str(same)]
    return f"; did you mean {' or '.join(near)}?" if near else ""
