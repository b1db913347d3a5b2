"""What a joint's name says: the body side and part, whatever the naming convention.

Names are not looked up in one table per product. They are taken apart (namespace, camel case, separators,
side tokens) and the words that are left are looked up in one list of synonyms, so that
``mixamorig:LeftUpLeg``, ``Bip01 L Thigh``, ``thigh_l``, ``lfemur``, ``LeftUpperLeg`` and ``L_Hip`` all come
out as the left thigh.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

_SYNONYMS: dict[str, str] = {
    "pelvis": "pelvis pelv",
    "hip": "hip hips hipcenter hipcentre spinebase",
    "hipjoint": "hipjoint",
    "thigh": "upleg upperleg legupper thigh thighbone femur uleg hiprotation",
    "leg": "leg",
    "shin": "lowerleg lowleg leglower loleg shin shinbone shank calf tibia crus knee",
    "foot": "foot",
    "ankle": "ankle",
    "toe": "toebase toe toes ball football forefoot",
    "clavicle": "clavicle clav collar collarbone scapula innershoulder inshoulder",
    "shoulder": "shoulder",
    "upperarm": "upperarm uparm armupper arm humerus shldr bicep uarm",
    "forearm": "forearm lowerarm lowarm loarm armlower radius ulna elbow farm",
    "hand": "hand",
    "wrist": "wrist",
    "middle": "middle mid handmiddle middlefinger handmid middleproximal fingermiddle fmiddle",
    "fingers": "fingers fingerbase handfingers",
    "index": "index handindex indexfinger indexproximal fingerindex findex finger",
    "neck": "neck",
    "head": "head",
}
_PART_OF = {word: part for part, words in _SYNONYMS.items() for word in words.split()}
_SIDES = {
    **dict.fromkeys(("left", "l", "lft", "lf"), "left"),
    **dict.fromkeys(("right", "r", "rgt", "rt"), "right"),
}
_JAPANESE = {
    "左": "left",
    "右": "right",
    "足首": "ankle",
    "つま先": "toe",
    "ひざ": "knee",
    "膝": "knee",
    "足": "thigh",
    "手首": "wrist",
    "ひじ": "elbow",
    "肘": "elbow",
    "腕捩": "twist",
    "手捩": "twist",
    "捩": "twist",
    "腕": "upperarm",
    "肩": "clavicle",
    "首": "neck",
    "頭": "head",
    "中指": "middle",
    "人指": "index",
    "人差指": "index",
    "親指": "thumb",
    "薬指": "ring",
    "小指": "little",
    "下半身": "pelvis",
    "ＩＫ": "ik",
    "先": "tip",
    "目": "eye",
    "髪": "hair",
}
_SIGNS = re.compile("|".join(sorted(_JAPANESE, key=len, reverse=True)))
_NOISE = {"bone", "joint", "jnt", "jt", "bend", "bind", "def", "sk", "skel", "c"}
_HELPERS = frozenset(
    {
        "ik",
        "pole",
        "target",
        "twist",
        "twst",
        "roll",
        "ctrl",
        "control",
        "end",
        "nub",
        "effector",
        "eff",
        "tip",
    }
    | {"eye", "jaw", "ear", "tongue", "cheek", "brow", "lip", "hair", "skirt", "cloth", "breast", "bust"}
    | {"buttock", "butt", "thumb", "ring", "pinky", "little", "metacarpal", "metatarsal", "metatarsals"}
    | {"prop", "weapon", "helper", "hlp", "socket", "camera", "vb", "mch", "proxy", "aim", "offset", "dummy"}
)
_ATTACHMENTS = frozenset(
    {"ik", "pole", "target", "twist", "twst", "roll", "ctrl", "control", "prop", "weapon", "socket", "camera"}
)
_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")
_GLUED = re.compile(r"^(left|right|l|r)([a-z]{3,})$|^([a-z]{3,})(left|right)$")


@dataclass(frozen=True)
class NameReading:
    """One reading of a joint name: side ``"left"``, ``"right"`` or ``""``, body part, and how forced it is
    (0: not).
    """

    side: str
    part: str
    doubt: int


def read_joint_name(name: str) -> NameReading | None:
    """The side and part that ``name`` states, or ``None`` where it states none (numbers, helpers, foreign
    words).
    """
    words = words_of(name)
    if not words or _HELPERS & set(words):
        return None
    side, rest = _take_side(words)
    number = int(rest[-1]) if rest and rest[-1].isdigit() else 0
    letters = [word for word in rest if not word.isdigit()]
    for tail in (letters, _without_noise(letters)):
        for skipped in range(len(tail)):
            part = _PART_OF.get("".join(tail[skipped:]))
            if part is not None:
                return NameReading(side, part, 100 * skipped + min(number, 99))
    return None


def side_of(name: str) -> str:
    """``"left"``, ``"right"`` or ``""``: the side that ``name`` states, whatever else it says."""
    return _take_side(words_of(name))[0]


def is_attachment(name: str) -> bool:
    """Whether a joint of that name is held by a body or steers it (weapon, twist bone, target) but is no part of it."""
    return not _ATTACHMENTS.isdisjoint(words_of(name))


def words_of(name: str) -> list[str]:
    """The words of a joint's name: ``"mixamorig:LeftUpLeg"`` -> ``["left", "up", "leg"]``.

    Glued sides are split: ``"lfemur"`` -> ``["l", "femur"]``. Those of MMD are translated: ``"左足"`` -> ``["left",
    "thigh"]``.
    """
    bare = _SIGNS.sub(lambda sign: f" {_JAPANESE[sign.group()]} ", re.split(r"[:|]", name)[-1])
    return [part for word in _WORD.findall(bare) for part in _split_glued(word.lower())]


def _split_glued(word: str) -> list[str]:
    match = _GLUED.match(word)
    if word in _PART_OF or word in _SIDES or match is None:
        return [word]
    first = match.group(1) or match.group(3)
    second = match.group(2) or match.group(4)
    known = _HELPERS | _NOISE | _PART_OF.keys()
    return [first, second] if (first in known or second in known) else [word]


def _take_side(words: list[str]) -> tuple[str, list[str]]:
    """Split off the side: the whole words ``left`` / ``right`` win over single letters."""
    for candidates in (("left", "right"), tuple(_SIDES)):
        for place, word in enumerate(words):
            if word in candidates:
                return _SIDES[word], words[:place] + words[place + 1 :]
    return "", words


def _without_noise(words: list[str]) -> list[str]:
    while words and words[-1] in _NOISE:
        words = words[:-1]
    return words
