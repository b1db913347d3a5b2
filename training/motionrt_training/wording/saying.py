"""Actions in the forms that captions use: orders, third person, gerunds, joined to sentences."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

SUBJECTS = ("a person", "the person", "someone", "somebody", "a man", "a woman", "he", "she", "they", "the character")
JOINED = (" and ", " and ", " while ", ", ")
THEN = (" and then ", ", then ", " then ", ", afterwards ", " before ", ", and after that ")


def third_person(action: str) -> str:
    """``walk forward`` -> ``walks forward``."""
    return _inflected(action, "VBZ")


def gerund(action: str) -> str:
    """``walk forward`` -> ``walking forward``."""
    return _inflected(action, "VBG")


def sentence(actions: Sequence[str], rng: np.random.Generator, *, joined: str | None = None) -> str:
    """One to three actions, given as orders, in a form drawn at random."""
    link = joined or str(rng.choice(JOINED))
    form = rng.random()
    if form < 0.3:
        return link.replace("while", "and").replace("before", "and then").join(actions)
    if form < 0.55:
        return link.replace("while", "and").replace("before", "and then").join(map(gerund, actions))
    subject = str(rng.choice(SUBJECTS))
    is_plural = subject == "they"
    first = actions[0] if is_plural else third_person(actions[0])
    rest = [_after(action, link, plural=is_plural) for action in actions[1:]]
    return f"{subject} {link.join([first, *rest])}"


def _after(action: str, link: str, *, plural: bool) -> str:
    if link.strip() in ("while", "before"):
        return gerund(action)
    return action if plural else third_person(action)


@lru_cache(maxsize=4096)
def _inflected(action: str, tag: str) -> str:
    from lemminflect import getInflection

    verb, _, rest = action.partition(" ")
    found = getInflection(verb, tag=tag, inflect_oov=True)
    return f"{found[0] if found else verb} {rest}".rstrip()
