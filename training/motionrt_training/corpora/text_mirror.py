"""What a caption becomes when its motion is mirrored: left and right, and the senses of rotation, change places."""

from __future__ import annotations

import re

_SWAPS = {
    "left": "right",
    "right": "left",
    "leftward": "rightward",
    "rightward": "leftward",
    "leftwards": "rightwards",
    "rightwards": "leftwards",
    "clockwise": "counterclockwise",
    "counterclockwise": "clockwise",
    "anticlockwise": "clockwise",
    "counter-clockwise": "clockwise",
    "anti-clockwise": "clockwise",
    "lefty": "righty",
    "righty": "lefty",
}
# "right away", "right angle", "then, right after that" and "left the room" name no side; "turns right before ..." does.
_NO_SIDE = re.compile(
    r"\bright (?:away|there|here|angles?)\b|(?:^|[,;.] |\band |\bthen |\bis |\bwas )right (?:after|before|now)\b"
    r"|\bleft the (?:room|house|area|scene|ground|floor)\b",
    re.IGNORECASE,
)
_SIDED = re.compile(
    r"\b(?:counter-|anti-)?(?:clockwise|counterclockwise|anticlockwise|(?:left|right)(?:wards?|y)?)\b", re.IGNORECASE
)


def mirror_text(text: str) -> str:
    """``text`` for the mirrored motion, keeping capitals: "Left hand, clockwise" -> "Right hand, counterclockwise"."""
    named = {match.start() for match in _sided(text)}

    def swap(match: re.Match[str]) -> str:
        if match.start() not in named:
            return match.group()
        swapped = _SWAPS[match.group().lower()]
        return swapped.capitalize() if match.group()[0].isupper() else swapped

    return _SIDED.sub(swap, text)


def side_words(text: str) -> list[str]:
    """The words that name a side or a sense of rotation, in lower case; "right away" is none."""
    return [match.group().lower() for match in _sided(text)]


def _sided(text: str) -> list[re.Match[str]]:
    kept = [match.span() for match in _NO_SIDE.finditer(text)]
    return [match for match in _SIDED.finditer(text) if not any(start <= match.start() < end for start, end in kept)]
