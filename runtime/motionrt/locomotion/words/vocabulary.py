"""The words that instructions are made of."""

from __future__ import annotations

VERBS: dict[str, tuple[str, ...]] = {
    "sit": ("sit", "seat yourself", "have a seat", "take a seat", "be seated", "rest"),
    "lie": ("lie", "lie down", "lay down", "lay", "sleep", "stretch out", "go to bed"),
    "grab": ("grab", "pick", "pick up", "take", "grasp", "fetch", "get", "hold", "collect"),
    "reach": ("reach", "reach out", "stretch"),
    "touch": (
        "touch",
        "press",
        "push",
        "tap",
        "knock",
        "feel",
        "wipe",
        "switch",
        "turn on",
        "turn off",
    ),
    "open": ("open", "close", "pull open", "push open", "shut"),
    "lean": ("lean", "lean on", "prop"),
    "look": ("look", "watch", "face", "gaze", "turn to"),
    "stand": ("stand", "stand up", "wait", "stop", "go", "walk", "stay"),
}
"""What a character can do, and how people say it."""

ALIKE: tuple[frozenset[str], ...] = tuple(
    frozenset(group.split(", "))
    for group in (
        "sofa, couch, settee, loveseat",
        "chair, armchair, seat, office chair",
        "bed, mattress, cot, bunk, daybed",
        "stool, bar stool, ottoman, pouf",
        "shelf, bookshelf, bookcase, rack, shelving, shelving unit",
        "cupboard, cabinet, wardrobe, closet",
        "table, desk, dining table, coffee table",
        "lamp, light, floor lamp, table lamp",
        "tv, television, screen, monitor",
        "fridge, refrigerator",
        "sink, basin, washbasin",
        "door, doorway",
        "bin, trash can, garbage can, wastebasket",
        "counter, countertop, worktop",
        "picture, painting, poster",
        "switch, light switch",
    )
)
"""Names that stand for each other where the cloud lacks the one that was said."""

_FILLERS = (
    "please, now, then, and, go, over, a, an, the, this, that, some, one, your, my, his, her, its, their, up, down"
)
_PLACES = "on, onto, at, from, in, into, inside, off, to, towards, toward, for, by, near, beside, before, against, of"
FILLERS, PLACES = frozenset(_FILLERS.split(", ")), frozenset(_PLACES.split(", "))
FLOORS = frozenset({"floor", "ground", "carpet", "rug"})


def normal(name: str) -> str:
    """A label or a phrase as it is compared: lower case, single spaces for underscores and hyphens."""
    return " ".join(name.lower().replace("_", " ").replace("-", " ").split())


def singular(word: str) -> str:
    """The singular of a plain English plural; other words as they are."""
    if word.endswith("shelves"):
        return word[:-3] + "f"
    if word.endswith(("ches", "shes", "sses", "xes")):
        return word[:-2]
    return word[:-1] if word.endswith("s") and not word.endswith("ss") and len(word) > 3 else word


def find_label(name: str, labels: tuple[str, ...]) -> str | None:
    """The label that ``name`` means: itself, without its adjectives, in the singular, or another word for it."""
    known = {singular(normal(label)): label for label in labels} | {normal(label): label for label in labels}
    words = normal(name).split()
    phrases = [" ".join(words[i:]) for i in range(len(words))]
    for phrase in [form for whole in phrases for form in (whole, singular(whole))]:
        if phrase in known:
            return known[phrase]
        for other in sorted(set().union(*(group for group in ALIKE if phrase in group))):
            if other in known:
                return known[other]
    return None
