"""Instructions: from a sentence such as "grab from the shelf at 1.2 m" to what is meant by it."""

from __future__ import annotations

import re
from dataclasses import dataclass

from motionrt.errors import InvalidInputError
from motionrt.locomotion.words.vocabulary import FILLERS, PLACES, VERBS, normal
from motionrt.untrusted.arguments import check_kind

_NUMBER = r"(?P<number>\d+(?:[.,]\d+)?|[.,]\d+)"
_UNIT = r"(?P<unit>m|cm|met(?:er|re)s?|centimet(?:er|re)s?)"
_HEIGHT = re.compile(
    rf"(?:\b(?:at|in))?(?:\s+(?:a|the))?(?:\s*height of)?\s*(?<![\w.,]){_NUMBER}\s*{_UNIT}\b(?:\s+high|\s+up)?"
)
_HAND = re.compile(r"\b(?:with|using|by)(?:\s+(?:the|your|his|her|its|their|my))?\s+(left|right)(?:\s+hand)?\b")
_HIGHEST = 3.0  # metres; more is a slip of the unit


@dataclass(frozen=True)
class Instruction:
    """What a character is told to do.

    Attributes:
        verb: one of ``sit``, ``lie``, ``grab``, ``reach``, ``touch``, ``open``, ``lean``, ``look``, ``stand``.
        object: the thing or place, as it was called.
        height: metres above the ground, or None where it was not said.
        hand: ``left`` or ``right``, or None where it was not said.
        item: what is taken from the object ("the cup" in "take the cup from the table"), or None.
    """

    verb: str
    object: str
    height: float | None = None
    hand: str | None = None
    item: str | None = None


def parse_instruction(text: str) -> Instruction:
    """Understand one instruction in English.

    Raises:
        InvalidInputError: an unknown verb (lists the verbs), no object, or a height beyond 3 m.
    """
    check_kind(text, str, "an instruction", "a text")
    rest, height = _height(text.lower())
    rest, hand = _hand(normal(rest))
    words = re.findall(r"[^\W_]+", rest)
    verb, words = _verb(words, text)
    item, place = _things(words)
    if not place:
        raise InvalidInputError(f"'{text}' names no object; say what to {verb} at, as in '{verb} {_EXAMPLES[verb]}'")
    return Instruction(verb, place, height, hand, item or None)


_EXAMPLES = {
    "sit": "on the sofa",
    "lie": "on the bed",
    "grab": "from the shelf at 1.2 m",
    "reach": "the lamp",
    "touch": "the wall with the left hand",
    "open": "the door",
    "lean": "on the table",
    "look": "at the picture",
    "stand": "at the window",
}


def _height(text: str) -> tuple[str, float | None]:
    found = _HEIGHT.search(text)
    if found is None:
        return text, None
    metres = float(found["number"].replace(",", ".")) * (0.01 if found["unit"].startswith("c") else 1.0)
    if metres > _HIGHEST:
        raise InvalidInputError(f"a height of {metres:g} m in '{text}' is out of reach; give metres or cm up to 3 m")
    return text[: found.start()] + " " + text[found.end() :], metres


def _hand(text: str) -> tuple[str, str | None]:
    found = _HAND.search(text)
    return (text, None) if found is None else (text[: found.start()] + " " + text[found.end() :], found[1])


def _verb(words: list[str], text: str) -> tuple[str, list[str]]:
    """The verb, by the longest phrase that the sentence begins with, and the words behind it."""
    spoken = {phrase: verb for verb, phrases in VERBS.items() for phrase in phrases}
    while words and words[0] in FILLERS and words[0] != "go":
        words = words[1:]
    for length in (3, 2, 1):
        phrase = " ".join(words[:length])
        if phrase in spoken:
            return spoken[phrase], words[length:]
    raise InvalidInputError(f"no known verb in '{text}'; begin with one of: {', '.join(sorted(spoken))}")


def _things(words: list[str]) -> tuple[str, str]:
    """(item, place): what stands before the last preposition and what behind it; one thing alone is the place."""
    parts: list[list[str]] = [[]]
    for word in words:
        if word in PLACES or word == "front":
            parts.append([])
        elif word not in FILLERS:
            parts[-1].append(word)
    things = [" ".join(part) for part in parts if part]
    return (things[0] if len(things) > 1 else ""), (things[-1] if things else "")
