"""Files that a command passed over: some one by one, many by reason."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence

from motionrt.cli.console import say

SOME_SKIPPED = 3
"""Exit code of a command that did its work, but not on all files."""

_LISTED, _REASONS = 20, 12
_PARTICULAR = re.compile(r"'[^']*'|\d[\d.,]*")


def say_skipped(skipped: Sequence[tuple[str, str]]) -> None:
    """Name the first twenty files with their reasons, ``(path, reason)``; then, where there are more, count reasons."""
    for name, reason in skipped[:_LISTED]:
        say(f"skipped {name}: {reason}")
    count = len(skipped)
    if count > _LISTED:
        say(f"skipped {count - _LISTED} more; all of them by reason, as in the first of each:")
        for number, name, reason in by_reason(skipped)[:_REASONS]:
            say(f"  {number:5d}  {reason} ({name})")
    if count:
        say(f"motionrt: {count} {'file was' if count == 1 else 'files were'} skipped")


def by_reason(skipped: Sequence[tuple[str, str]]) -> list[tuple[int, str, str]]:
    """How many files were skipped for a reason, the first of them and its words; the most frequent reason first.

    Reasons are the same if they differ in nothing but numbers and quoted names.
    """
    kinds = Counter(_kind(reason) for _, reason in skipped)
    first = {_kind(reason): (name, reason) for name, reason in reversed(skipped)}
    return [(count, *first[kind]) for kind, count in kinds.most_common()]


def _kind(reason: str) -> str:
    return _PARTICULAR.sub("*", reason)[:120]
