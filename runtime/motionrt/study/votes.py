"""What votes add up to: the share of each side and its binomial interval."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from motionrt.errors import FormatError, InvalidInputError, MotionFileNotFoundError
from motionrt.untrusted import json_text
from motionrt.untrusted.files import as_path, read_bytes

Z = 1.959963984540054  # of a normal distribution: 95 % lie within
KIND = "motionrt study"
_LARGEST = 16_000_000  # bytes of a file of votes


@dataclass(frozen=True)
class Count:
    """Votes of one study, of as many people as gave files.

    Attributes:
        a, b: what the two sides are called.
        people: files that were counted.
        votes: all votes.
        for_a: those for the first side.
        share: of the first side, 0 to 1.
        low, high: Wilson's 95 % interval of that share; it treats every vote as independent.
    """

    a: str
    b: str
    people: int
    votes: int
    for_a: int
    share: float
    low: float
    high: float

    def as_dict(self) -> dict[str, str | int | float]:
        """Plain values by name, for JSON."""
        return asdict(self)


def wilson(won: int, of: int) -> tuple[float, float]:
    """Wilson's 95 % interval of a share: lowest and highest, 0 to 1; (0, 1) where nothing was counted.

    Raises:
        InvalidInputError: fewer than 0, or more won than there were.
    """
    if not 0 <= won <= of:
        raise InvalidInputError(f"{won} of {of} is no count; give 0 <= won <= of")
    if of == 0:
        return 0.0, 1.0
    share, weight = won / of, Z * Z / of
    middle = (share + weight / 2) / (1 + weight)
    half = Z * math.sqrt(share * (1 - share) / of + weight / (4 * of)) / (1 + weight)
    return max(0.0, middle - half), min(1.0, middle + half)


def count_votes(files: Sequence[str | Path]) -> Count:
    """Add up the files that the page of one study saved (JSON).

    Raises:
        MotionFileNotFoundError: a file is missing.
        FormatError: a file is none of these.
        InvalidInputError: no files, no votes, or files of different studies.
    """
    read = [_read(as_path(file)) for file in files]
    if not read:
        raise InvalidInputError("give at least one file of votes, as the page saves it")
    names = {(each["a"], each["b"], each["study"]) for each in read}
    if len(names) > 1:
        raise InvalidInputError(f"these are votes of {len(names)} different studies; count those of one alone")
    ((a, b, _),) = names
    chosen = [vote["chosen"] for each in read for vote in each["votes"]]
    if not chosen:
        raise InvalidInputError("nobody has voted in these files")
    won = chosen.count("a")
    low, high = wilson(won, len(chosen))
    return Count(a, b, len(read), len(chosen), won, won / len(chosen), low, high)


def write_votes(files: Sequence[str | Path], out: str | Path) -> Path:
    """All votes as a table (CSV): file, pair, left, chosen, seconds."""
    path = as_path(out)
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(["file", "pair", "left", "chosen", "seconds"])
        for name in files:
            for vote in _read(as_path(name))["votes"]:
                table.writerow([Path(name).name, vote["pair"], vote["left"], vote["chosen"], vote["seconds"]])
    return path


def _read(path: Path) -> dict[str, Any]:
    if not path.is_file():
        raise MotionFileNotFoundError(f"there is no file {path}")
    if path.stat().st_size > _LARGEST:
        raise FormatError(path, "is no file of votes: too large")

    def fail(reason: str, line: int | None) -> FormatError:
        return FormatError(path, f"is no file of votes: {reason}", line)

    found = json_text.parse(read_bytes(path, fail), fail)
    if not _is_study(found):
        raise FormatError(path, "is no file of votes; save one with the button of the page")
    return dict(found)


def _is_study(found: object) -> bool:
    if not isinstance(found, dict) or found.get("kind") != KIND:
        return False
    named = all(isinstance(found.get(key), str) for key in ("a", "b", "study"))
    votes = found.get("votes")
    return named and isinstance(votes, list) and all(_is_vote(vote) for vote in votes)


def _is_vote(vote: object) -> bool:
    return (
        isinstance(vote, dict)
        and isinstance(vote.get("pair"), str)
        and vote.get("left") in ("a", "b")
        and vote.get("chosen") in ("a", "b")
        and isinstance(vote.get("seconds"), int | float)
    )
