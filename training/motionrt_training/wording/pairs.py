"""Two action labels said at once, as SINC says them (3.3, Table A.3)."""

from __future__ import annotations

import numpy as np

# {0} and {1} as they are, {1g} the second as a gerund. The simple "and" is what people type most.
CONJUNCTIONS = (
    "{0} and {1}",
    "{0} and {1}",
    "{0} while {1g}",
    "{0} while {1g}",
    "{0}, {1}",
    "while {1g}, {0}",
    "{0} and at the same time {1}",
    "{0} and simultaneously {1}",
    "simultaneously {0} and {1}",
    "{0} during {1g}",
    "{0g} while {1g}",
    "{0g} and {1g}",
)
_VERBS_AFTER = ("and", "then", "or")
_NO_VERBS = ("left", "right")  # what stands first in "left arm up"


def sentence(first: str, second: str, rng: np.random.Generator) -> str:
    """Two labels said at once, in random order, with a random conjunction."""
    pair = (first, second) if rng.random() < 0.5 else (second, first)
    return joined(*pair, CONJUNCTIONS[int(rng.integers(len(CONJUNCTIONS)))])


def joined(first: str, second: str, form: str) -> str:
    """Two labels in one of the forms of `CONJUNCTIONS`."""
    for index, label in enumerate((first, second)):
        form = form.replace(f"{{{index}g}}", gerund(label)).replace(f"{{{index}}}", label)
    return form


def gerund(label: str) -> str:
    """An imperative label as a gerund: "walk and turn left" -> "walking and turning left"."""
    words = label.split()
    for index, word in enumerate(words):
        if word.lower() not in _NO_VERBS and (index == 0 or words[index - 1] in _VERBS_AFTER):
            words[index] = _inflected(word)
    return " ".join(words)


def _inflected(word: str) -> str:
    from lemminflect import getAllLemmas, getInflection

    lemma = word.lower()
    if lemma.endswith("ing") or "VERB" not in getAllLemmas(lemma):
        return word
    found = getInflection(lemma, tag="VBG")
    return str(found[0]) if found else word
