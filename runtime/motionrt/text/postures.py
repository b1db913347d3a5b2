"""Postures in a text: where it starts, where it ends, how low it gets."""

from __future__ import annotations

from typing import Any

from motionrt.motion.attributes import POSTURES
from motionrt.text import lexicon as lex
from motionrt.text.patterns import has, matches, without

Found = dict[str, Any]
_UPRIGHT = frozenset({"walk", "run", "jog", "march", "wave", "turn", "clap", "kick", "punch", "throw"})
_RISE = "rise"


def postures_of(words: str, found: Found) -> Found:
    """``posture_start``, ``posture_end``, ``posture_lowest`` and ``level``."""
    words = without(words, lex.NOT_POSTURES)
    events = _events(words)
    low = [name for _, name in events if name not in (_RISE, "standing")]
    if not low:
        return _upright(events, found)
    deepest = max(low, key=POSTURES.index)
    if all(name in lex.DIP_POSTURES or name == "upside down" for name in low):
        return _dip(words, deepest, events)
    start, end = _start(words, events), _end(words, events)
    return {"posture_start": start, "posture_end": end, "posture_lowest": deepest, "level": _level(start, end)}


def _events(words: str) -> list[tuple[int, str]]:
    """Postures and risings in the order in which they happen; what somebody rises from stands before the rising."""
    found: list[tuple[int, str]] = []
    rises = [match.span() for match in matches(words, lex.RISES)]
    for name, pattern in lex.POSTURE_STATES:
        for match in matches(words, pattern):
            place = match.start()
            if name == "standing" and any(start <= place < end for start, end in rises):
                continue
            risen = (
                start for start, end in rises if end <= place <= end + 30 and has(words[end - 5 : place + 5], lex.FROM)
            )
            place = next(risen, place + 1) - 1
            found.append((place, name))
    found += [(start, _RISE) for start, _ in rises]
    return sorted(found)


def _upright(events: list[tuple[int, str]], found: Found) -> Found:
    names = [name for _, name in events]
    if _RISE in names:
        return {"posture_end": "standing", "level": "up"}
    if "standing" in names or found["action"] in _UPRIGHT:
        return {"posture_start": "standing", "posture_end": "standing", "level": "level"}
    return {}


def _dip(words: str, deepest: str, events: list[tuple[int, str]]) -> Found:
    """Bows, squats and cartwheels: down and up again, unless it stays there."""
    ends = {"posture_end": "standing"} if events[-1][1] == _RISE else {}
    if deepest == "bent":  # `lean` says it
        return ends
    if has(words, lex.CROUCHED) and not has(words, lex.SEVERAL_CLAUSES):
        return {"posture_start": deepest, "posture_end": deepest, "posture_lowest": deepest}
    if has(words, lex.STAY_WORDS):
        down = {"posture_start": "standing", "level": "down"} if deepest == "crouching" and _goes_down(words) else {}
        return {"posture_end": deepest, "posture_lowest": deepest, **down}
    down = {"level": "down and up"} if deepest == "crouching" and not has(words, lex.SEVERAL_CLAUSES) else {}
    return {"posture_lowest": deepest, **down, **ends}


def _goes_down(words: str) -> bool:
    return has(words, lex.DOWN_WORDS) or has(words, r"\binto (?:a|the) \w*")


def _start(words: str, events: list[tuple[int, str]]) -> str | None:
    place, name = events[0]
    walked = any(match.start() < place for match in _walks(words))
    if name == _RISE:
        return None
    if name == "standing" or walked or any(m.start() <= place < m.end() for m in matches(words, lex.DOWN_WORDS)):
        return "standing"
    return None if name in lex.DIP_POSTURES else name


def _end(words: str, events: list[tuple[int, str]]) -> str | None:
    place, name = events[-1]
    if name in (_RISE, "standing") or any(match.start() > place for match in _walks(words)):
        return "standing"
    return None if name in lex.DIP_POSTURES or name == "upside down" else name


def _walks(words: str) -> list[Any]:
    return [match for match in matches(words, lex.GOES) if not match.group().startswith("crawl")]


def _level(start: str | None, end: str | None) -> str | None:
    high = {name: name == "standing" for name in (start, end) if name}
    if end == "standing":
        return "down and up" if start == "standing" else "up"
    if start == "standing":
        return "down" if end else None
    return "level" if start and start == end and not high[start] else None
