"""Arguments as people type them: near misses get a suggestion, and places are written ``X Z`` or ``X,Z``."""

from __future__ import annotations

import argparse
import difflib
import re
from collections.abc import Iterable, Sequence
from typing import Any, NoReturn

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
        return found, left

    def error(self, message: str) -> NoReturn:
        """Usage, what is wrong, what may have been meant; exit code 2."""
        wrong = _CHOICE.match(message)
        if wrong:
            choices = re.findall(r"[\w.-]+", wrong["choices"])
            near = _meant(wrong["given"], choices)
            if wrong["what"] == "COMMAND":
                message = f"no command '{wrong['given']}'{near}; '{self.prog} --help' lists them all"
            else:
                message += near
        super().error(message)

    def _nearest_options(self, left: Iterable[str]) -> str:
        options = [one for one in left if one.startswith("-")]
        return _meant(options[0].split("=")[0], list(self._option_string_actions)) if options else ""


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


def _meant(given: str, known: Sequence[str]) -> str:
    """``; did you mean ...?``, where something is near enough."""
    near = difflib.get_close_matches(given, known, n=2, cutoff=0.6)
    same = _SYNONYMS.get(given)
    if same in known or (same or "").startswith("--"):
        near = [str(same)]
    return f"; did you mean {' or '.join(near)}?" if near else ""
