"""Slips of the keyboard: the known word that is one slip away from an unknown one."""

from __future__ import annotations

from collections.abc import Iterable

SHORTEST = 4  # letters; shorter words are left alone
SHORTEST_BOLD = 5
LONGEST = 30  # no word that is known has more


class Spelling:
    """An index of words and their forms by what remains when a letter is left out (symmetric deletion).

    The first letter is taken to be right. Two letters exchanged are always mended; a letter too many, too few or wrong
    only boldly, in words of five letters or more: too many ordinary words are one letter away from an action ("stool",
    "stood").
    """

    def __init__(self, bases: Iterable[str]) -> None:
        self._by_rest: dict[str, list[str]] = {}
        for form in dict.fromkeys(form for base in bases for form in _forms(base)):
            for rest in (form, *_rests(form)):
                self._by_rest.setdefault(rest, []).append(form)

    def mended(self, word: str, *, boldly: bool) -> str | None:
        """The known form that is one slip away from ``word``, or None."""
        if not SHORTEST <= len(word) <= LONGEST or not word.isalpha():
            return None
        near = dict.fromkeys(form for rest in (word, *_rests(word)) for form in self._by_rest.get(rest, ()))
        near_first = [form for form in near if form[0] == word[0]]
        exchanged = next((form for form in near_first if _exchanged(word, form)), None)
        if exchanged or not boldly or len(word) < SHORTEST_BOLD:
            return exchanged
        return next((form for form in near_first if _one_letter_off(word, form)), None)


def _forms(base: str) -> list[str]:
    """A word with the endings of verbs and nouns; some are no words, which does no harm."""
    stem = base.removesuffix("e")
    doubled = base + base[-1]
    return [base, base + "s", stem + "ing", stem + "ed", doubled + "ing", doubled + "ed"]


def _rests(word: str) -> list[str]:
    """``word`` without one letter, the first excepted."""
    return [word[:i] + word[i + 1 :] for i in range(1, len(word))]


def _exchanged(word: str, form: str) -> bool:
    apart = [i for i, (one, other) in enumerate(zip(word, form, strict=False)) if one != other]
    if len(word) != len(form) or len(apart) != 2 or apart[1] != apart[0] + 1:
        return False
    return word[apart[0]] == form[apart[1]] and word[apart[1]] == form[apart[0]]


def _one_letter_off(word: str, form: str) -> bool:
    """Whether one letter is wrong, too many or too few."""
    if len(word) == len(form):
        return sum(one != other for one, other in zip(word, form, strict=True)) == 1
    long, short = (word, form) if len(word) > len(form) else (form, word)
    return len(long) == len(short) + 1 and short in _rests(long)
