"""``parse_query``: what a text says about a motion, offline and in well under a millisecond."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from motionrt.errors import InvalidInputError
from motionrt.text import lexicon as lex
from motionrt.text.directions import path_of, speed_of, travel_of, turn_of
from motionrt.text.limbs import arms_of, feet_of, hands_of
from motionrt.text.patterns import affirmed, compiled, has, may_match
from motionrt.text.postures import postures_of
from motionrt.text.query import TextAttributes
from motionrt.text.times import jumps_of, repeats_of
from motionrt.text.wording import worded


def parse_query(text: str) -> TextAttributes:
    """What ``text`` says about a motion, whether a search word or a sentence.

    Raises:
        InvalidInputError: ``text`` is no string.
    """
    if not isinstance(text, str):
        raise InvalidInputError(f"a query is a text, not {type(text).__name__}")
    return _parsed(text)


@lru_cache(maxsize=4096)
def _parsed(text: str) -> TextAttributes:
    whole = worded(text)
    said: dict[str, Any] = {}
    for pattern, meaning in lex.NEGATED_MEANING:
        if has(whole, pattern):
            said.update(meaning)
    words = affirmed(whole)
    actions = _actions(words)
    found: dict[str, Any] = {"action": actions[0] if actions else None}
    found["actions"] = tuple(sorted(actions, key=lambda name: _place(words, name)))
    for part in (turn_of, path_of, travel_of, speed_of, arms_of, hands_of, feet_of, postures_of, jumps_of, repeats_of):
        found.update(part(words, found))
    found.update(_moves(found))
    found.update(said)
    if said.get("still") or found.get("speed") == "still":
        still = {"still": True, "travel": "none", "steps": "none", "speed": "still", "legs_move": 1}
        found.update(still, arms_move=found["arms_move"] or (None if found.get("arm") else 1))
    return TextAttributes(text=text, words=_words(words), **found)


def _actions(words: str) -> list[str]:
    """Classes of action that are named, the most telling first."""
    return [name for name, pattern in lex.ACTIONS.items() if has(words, pattern)]


def _place(words: str, action: str) -> int:
    match = compiled(lex.ACTIONS[action]).search(words)
    return match.start() if match else len(words)


def _moves(found: dict[str, Any]) -> dict[str, Any]:
    """How much arms, legs and trunk move, as far as the action says it."""
    levels = lex.MOVES.get(found["action"] or "", (0, 0, 0))
    names = ("arms_move", "legs_move", "torso_move")
    moves: dict[str, Any] = {name: level or None for name, level in zip(names, levels, strict=True)}
    if found.get("steps") == "along" and (moves["legs_move"] or 0) < 3:
        moves["legs_move"] = None
    return moves


def _words(words: str) -> tuple[str, ...]:
    """Words and phrases that some class of action or direction knows."""
    patterns = [*lex.ACTIONS.values(), *(p for _, p in lex.TRAVELS), *(p for _, p in lex.SPEEDS), lex.ANY_SIDE]
    found = (
        match.group()
        for pattern in patterns
        if may_match(words, pattern) and (match := compiled(pattern).search(words))
    )
    return tuple(dict.fromkeys(found))
