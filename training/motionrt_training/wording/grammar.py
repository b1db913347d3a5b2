"""A grammar of things that people do: sentences without motion, for networks that learn to read from another network.

Dense where words are few and matter much: sides, turns, paths, ways, speeds, counts, order.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from motionrt_training.wording.saying import THEN, sentence

_LISTS = {
    "side": "left right left right other",
    "way": "forward|backward|ahead|back|to the left|to the right|sideways|in reverse|diagonally",
    "manner": "slowly|quickly|carefully|happily|angrily|sadly|lazily|nervously|proudly|with small steps|with big steps"
    "|on tiptoe|with a limp|like an old person|like a robot|drunkenly|calmly|in a hurry|with bent knees",
    "often": "once|twice|three times|four times|several times|again and again|a few times",
    "angle": "a quarter turn|a half turn|a full turn|ninety degrees|180 degrees|45 degrees|360 degrees",
    "sense": "clockwise|counterclockwise|to the left|to the right|left|right|around to the left|around to the right",
    "arm": "arm|hand|fist|elbow|wrist",
    "leg": "leg|foot|knee|heel",
    "object": "ball|box|bag|stick|cup|bottle|book|chair|rope|bucket|broom|stone|phone|suitcase|tray|hat|door|drawer"
    "|wheel|hammer|wrench|umbrella|flag|sword|racket|bat",
    "place": "floor|ground|table|shelf|chair|sofa|bed|stool|bench|wall|step|box",
    "dance": "salsa|waltz|ballet|hip hop|charleston|breakdance|an Indian dance|a folk dance|tango|jazz",
    "animal": "chicken|bear|cat|dog|monkey|elephant|snake|bird|penguin|frog",
    "sport": "basketball|tennis|golf|football|baseball|boxing|karate|volleyball|bowling|badminton|cricket",
    "person": "a child|a soldier|a zombie|a model|a clown|a fighter|an old man|a ballerina|a sailor|a waiter",
}
_SLOT = re.compile(r"\{(\w+)\}")
CHOICES = {name: text.split("|" if "|" in text else " ") for name, text in _LISTS.items()}
TEMPLATES = tuple(Path(__file__).with_name("actions.txt").read_text(encoding="utf-8").splitlines())


def actions(rng: np.random.Generator) -> Iterator[str]:
    """Actions as orders, endlessly: "kick with the left foot"."""
    while True:
        yield _SLOT.sub(lambda slot: str(rng.choice(CHOICES[slot[1]])), str(rng.choice(TEMPLATES)))


def sentences(count: int, rng: np.random.Generator) -> list[str]:
    """`count` different sentences of one to three actions, at once or in order."""
    found: dict[str, None] = {}
    drawn = actions(rng)
    while len(found) < count:
        many = int(rng.choice([1, 1, 1, 2, 2, 3]))
        joined = str(rng.choice(THEN)) if many > 1 and rng.random() < 0.4 else None
        found.setdefault(sentence([next(drawn) for _ in range(many)], rng, joined=joined))
    return list(found)
