"""Limbs that a text says stay as they are, and what is done on the spot."""

from __future__ import annotations

from collections.abc import Sequence

from motionrt.synthesis.parts.grammar import ARM, LEG, STILL, word_set
from motionrt.synthesis.parts.limbs import Limb
from motionrt.synthesis.parts.reading import Act, Clause
from motionrt.synthesis.parts.words import Word

_IDLE = word_set("hanging dangling relaxed limp slack tied bound")  # of arms
_STEPPING = word_set("walk step run jog march dance tap salsa shuffle pace stroll trot")
_SPOTS = (
    *("in place", "on the spot", "on spot", "on the same spot", "in the same spot", "in one place"),
    *("in the same place", "on a treadmill", "on the treadmill"),
)


def kept_still(limb: Limb, clause: Clause, words: Sequence[Word]) -> bool:
    """Whether the words around a limb say that it does not move: "arms still", "keep still the head"."""
    near = words[limb.end : min(limb.end + 2, clause.end)]
    inside = words[limb.start : limb.end]
    return any(word.text in STILL for word in (*near, *inside)) or _idle(limb, near) or _in_place(limb, clause, words)


def _idle(limb: Limb, near: Sequence[Word]) -> bool:
    """Whether arms only hang: "with the arms hanging down"."""
    return limb.region == ARM and any(word.text in _IDLE for word in near[:1])


def keeps(act: Act, quiet: Sequence[Limb]) -> bool:
    """Whether a verb only says that a limb stays as it is: "keeping the torso still"."""
    verb = act.entry.phrase[0]
    if verb in ("hang", "dangle", "relax", "tie", "bind"):
        return act.inflected and any(act.start == limb.end for limb in quiet)
    return verb in ("keep", "hold", "stay", "remain") and any(
        (limb.start - 2 <= act.start and act.end <= limb.start) or act.start == limb.end for limb in quiet
    )


def _in_place(limb: Limb, clause: Clause, words: Sequence[Word]) -> bool:
    after = [word.text for word in words[limb.end : min(limb.end + 2, clause.end)]]
    return after == ["in", "place"] and any(
        "keep" in word.bases or "hold" in word.bases for word in words[clause.start : limb.start]
    )


def on_the_spot(act: Act, clause: Clause, words: Sequence[Word]) -> bool:
    """Whether steps lead nowhere: "march in place", "tap dance on the spot"."""
    if act.entry.kind != "gait" and not (act.entry.kind == "act" and act.entry.phrase[0] in _STEPPING):
        return False
    text = f" {' '.join(word.text for word in words[clause.start : clause.end])} "
    return any(f" {spot} " in text for spot in _SPOTS)


def on_one_leg(limbs: Sequence[Limb], words: Sequence[Word]) -> bool:
    """Whether somebody stands on one leg, which is no mere posture: "stand on the left leg"."""
    return any(
        limb.region == LEG and not limb.plural and len(limb.sides) == 1 and words[limb.start - 1].text == "on"
        for limb in limbs
        if limb.start
    )
