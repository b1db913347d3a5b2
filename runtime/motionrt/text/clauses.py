"""``clauses``: the acts of a text that follow one another, each in words that stand alone."""

from __future__ import annotations

from motionrt.text import lexicon as lex
from motionrt.text.parsing import parse_query
from motionrt.text.patterns import compiled, has, matches
from motionrt.text.wording import worded

_LOW = ("sitting", "kneeling", "lying", "crouching", "crawling")


def clauses(text: str) -> tuple[str, ...]:
    """The acts of a text in the order in which they happen; the text itself where there is one, or all are at once."""
    whole = worded(text)
    parts = [act for part in _split(whole, lex.THEN) for act in _ordered(part)]
    listed = len(parts) > 1 or has(whole, lex.LIST)
    parts = [act for part in parts for act in _and(part, listed)]
    parts = _merged([_bare(part) for part in parts])
    if len(parts) < 2:
        return (text,)
    return tuple(_continued(parts))


def _split(words: str, pattern: str) -> list[str]:
    return [part.strip(" ,.") for part in compiled(pattern).split(words) if part and part.strip(" ,.")]


def _ordered(words: str) -> list[str]:
    """The two acts of "this before that" and "this after that", the earlier one first."""
    for pattern, first_is_behind in ((lex.BEFORE, False), (lex.AFTER, True)):
        found = matches(words, pattern)
        if not found:
            continue
        ahead, behind = words[: found[0].start()].strip(" ,."), words[found[0].end() :].strip(" ,.")
        if not ahead:  # "before this, that"
            halves = compiled(lex.NEW_SUBJECT).split(behind, maxsplit=1)
            if len(halves) < 2:
                return [words]
            behind, ahead = (half.strip(" ,.") for half in halves)
        if _acts(ahead) and _acts(behind):
            return [behind, ahead] if first_is_behind else [ahead, behind]
    return [words]


def _and(words: str, listed: bool) -> list[str]:
    """The acts of "this and that" where somebody cannot do both at once, and of a list of them."""
    for match in matches(words, lex.AND):
        ahead, behind = words[: match.start()], _bare(words[match.end() :])
        if has(behind, lex.JOINS):
            continue
        goes, goes_on = has(ahead, lex.GOES), _goes_on(behind)
        stopped, stops = has(ahead, rf"\b{lex.STOPS}"), has(behind, rf"^(?:\w+ly )?{lex.STOPS}")
        low = parse_query(ahead).posture_end in _LOW and parse_query(behind).posture_lowest in _LOW
        follows = (stopped and goes_on and not goes) or (goes and stops and not stopped)
        named = listed and has(match.group(), ",") and has(behind, lex.VERB) and _acts(ahead) and _acts(behind)
        if not low and (follows or named):
            return [ahead, *_and(behind, listed)]
    return [words]


def _goes_on(words: str) -> bool:
    return has(words, rf"^(?:\w+ly )?(?:{lex.GOES}|carr)") and parse_query(words).travel not in (None, "none")


def _bare(words: str) -> str:
    """A clause from its verb on."""
    return compiled(lex.LEADS).sub("", words.strip(" ,.")).strip()


def _acts(words: str) -> bool:
    said = parse_query(words)
    return bool(said.action or said.turn or said.travel or said.posture_lowest or said.level or said.arms_up)


def _merged(parts: list[str]) -> list[str]:
    """Parts without an act belong to the one before; a part without a verb has that of the one before."""
    found: list[str] = []
    for part in parts:
        if found and has(part, r"^with\b|^(?:the )?(?:left|right)\b"):
            head = found[-1].split(" with ")[0].split(" the ")[0]
            found.append(f"{head} {part}")
        elif found and not _acts(part):
            found[-1] = f"{found[-1]}, {part}"
        else:
            found.append(part)
    if len(found) > 1 and not _acts(found[0]):
        found[:2] = [f"{found[0]}, {found[1]}"]
    return found


def _continued(parts: list[str]) -> list[str]:
    """The clauses, told what those before them have left: a posture, and a turn after which the way back is forward."""
    found: list[str] = []
    low: str | None = None
    turned = False
    for bare in parts:
        part, said = bare, parse_query(bare)
        goes = has(part, lex.GOES) and said.posture_lowest is None
        if turned and goes and not has(part, lex.BACKWARD):
            part = compiled(r"\bback\b").sub("forward", part)
        if low and said.level == "up":
            part = f"{part} from the floor" if low in ("lying", "kneeling", "crawling") and "from" not in part else part
        elif low and goes:
            part = f"stands up and {part}"
        elif low and said.posture_lowest is None:
            part = f"{part} while {low}"
        found.append(part)
        turned = turned or said.turn == "around"
        end = said.posture_end if said.posture_lowest or said.level else low
        low = end if end in _LOW and not goes else None
    return found
