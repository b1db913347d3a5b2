"""What a phrase implies besides its verb: the way of what is carried, the stoop to what is picked up, a shoe's leg."""

from __future__ import annotations

from collections.abc import Sequence

from motionrt.motion.body_parts import LEGS
from motionrt.synthesis.parts.grammar import ADJECTIVES, DETERMINERS, LEG, LIMBS, SIDES, word_set
from motionrt.synthesis.parts.limbs import Limb
from motionrt.synthesis.parts.reading import Act, Clause
from motionrt.synthesis.parts.words import Word

_FERRY = word_set("carry bring drag haul tow lug wheel transport deliver lead guide escort usher dribble fetch")
_SHOVE = word_set("push pull shove roll heave")
_GOALS = word_set("to into onto toward towards around through past inside out")
_STRETCHES = word_set("across along")
_AWAY = word_set("forward forwards backward backwards upstairs downstairs outside indoors home away")
_SLOPES = word_set(
    "stair stairs staircase step ramp hill slope mountain street road path aisle court field pitch corridor hallway "
    "hall track lane alley driveway beach ladder bank"
)
_SMALL = word_set("table desk counter board page paper face screen string wire rail bar shelf")
_HIGH = _SMALL | word_set("phone telephone receiver hook wall pace speed guitar cup glass mug")
_FOOTWEAR = word_set("shoe sock boot slipper sandal stocking sneaker skate ski")
_DRESSING = word_set("put take pull slip tie lace untie unlace remove don change strap kick")


def travels(act: Act, limbs: Sequence[Limb], clause: Clause, words: Sequence[Word]) -> frozenset[str]:
    """Legs and global where a thing is moved along with the walker: "carry the box up the stairs", "dribble forward".

    Nothing where the thing alone moves ("push the door open") or goes to a limb ("bring the cup to the mouth").
    """
    verb = act.entry.phrase[0]
    if verb not in _FERRY | _SHOVE | {"take"} or any(limb.role == "object" for limb in limbs):
        return frozenset()
    stop = min((one.start for one in clause.acts if one.start >= act.end and not one.nominal), default=clause.end)
    if any(_goes(verb, words, place, place > act.end, stop) for place in range(act.end, stop)):
        return frozenset({*LEGS, "global"})
    return frozenset()


def _goes(verb: str, words: Sequence[Word], place: int, after_thing: bool, stop: int) -> bool:
    """Whether the word at ``place`` begins a way that one has to walk."""
    text = words[place].text
    if text in _AWAY:
        return verb in _FERRY
    goal = _noun_after(words, place, stop)
    if goal is None or any(base in LIMBS for base in goal.bases):
        return False
    if text in ("up", "down"):
        return (after_thing or verb in _FERRY) and any(base in _SLOPES for base in goal.bases)
    if text in _STRETCHES:
        return verb != "take" and (verb in _FERRY or not any(base in _SMALL for base in goal.bases))
    if text == "from":
        return verb == "fetch"
    return text in _GOALS and (verb in _FERRY or (verb == "take" and text in ("to", "into") and after_thing))


def _noun_after(words: Sequence[Word], place: int, stop: int) -> Word | None:
    """The noun of the phrase that follows a preposition, if one with an article does."""
    at = place + 1
    while at < stop and words[at].text in ADJECTIVES | {"of"}:
        at += 1
    if at >= stop or words[at].text not in DETERMINERS:
        return None
    while at < stop and words[at].text in DETERMINERS | ADJECTIVES | SIDES:
        at += 1
    return words[at] if at < stop and words[at].text.isalpha() else None


def stoops(act: Act, clause: Clause, words: Sequence[Word]) -> frozenset[str]:
    """The trunk where something is picked up; not from a table or a hook."""
    if act.entry.phrase[0] != "pick" or act.entry.kind == "still":
        return frozenset()
    bases = {base for word in words[act.start : clause.end] for base in word.bases}
    if "up" not in bases or bases & _HIGH:
        return frozenset()
    return frozenset({"torso"})


def worn_on(act: Act, clause: Clause, words: Sequence[Word]) -> frozenset[str]:
    """The side of the leg whose shoe or sock is put on or taken off: "take off the right shoe"."""
    if act.entry.phrase[0] not in _DRESSING:
        return frozenset()
    for place in range(act.start + 1, clause.end):
        if words[place - 1].text in SIDES and any(base in _FOOTWEAR for base in words[place].bases):
            return frozenset({words[place - 1].text})
    return frozenset()


def several_legs(targets: Sequence[Limb], words: Sequence[Word]) -> bool:
    """Whether the legs themselves are kicked: "kick the legs in the water", not "the legs of the opponent"."""
    legs = [limb for limb in targets if limb.region == LEG and limb.role == "object" and limb.plural]
    return any(limb.end >= len(words) or words[limb.end].text not in ("of", "from") for limb in legs)
