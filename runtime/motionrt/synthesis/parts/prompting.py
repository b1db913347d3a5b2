"""`PromptLabeller`: body parts by asking a language model (SINC 3.1 and appendix B)."""

from __future__ import annotations

import re

from motionrt.errors import InvalidInputError, LabellingError
from motionrt.motion.body_parts import ARMS, LEGS, PARTS
from motionrt.synthesis.parts.endpoint import Complete, Endpoint

ASKED = (*ARMS, *LEGS, "torso", "neck", "buttocks", "waist")  # the list that the model chooses from
EXAMPLES = (
    ("wave with the right hand", "right arm"),
    ("walk forward", "left leg, right leg, buttocks"),
    ("look around", "neck"),
    ("pick up a box with both hands", "left arm, right arm, torso, waist"),
    ("balance on the left leg while clapping", "left leg, right leg, left arm, right arm"),
    ("turn around on the spot", "left leg, right leg, waist"),
)
_GLOBAL = "global|buttocks?|butt|bottom|waist|hips?|pelvis|whole[- ]body|root"
_TORSO = "torso|trunk|neck|head|chest|spine|back|upper[- ]body|belly|abdomen|abs|stomach|face|eyes?"
_ARM = "arms?|hands?|elbows?|wrists?|shoulders?|forearms?|fingers?|fists?|palms?|thumbs?"
_LEG = "legs?|foot|feet|knees?|ankles?|toes?|thighs?|cal(?:f|ves)|heels?|shins?"
_SIDES = r"(?:\b(?P<sides>left and right|right and left|left/right|left|right|both|each)[\s_-]+(?:the\s+|of\s+)?)?"
_NAMED = re.compile(rf"{_SIDES}\b(?:(?P<arm>{_ARM})|(?P<leg>{_LEG})|(?P<torso>{_TORSO})|(?P<all>{_GLOBAL}))\b")
_READ = 10_000  # characters of an answer; whatever follows is talk
_NOTHING = re.compile(r"\b(?:none|nothing|no (?:body )?parts?)\b")
_DENIED = re.compile(r"\b(?:no|not|nor|without|except|excluding)\b(?:(?! but )[^.;\n])*")


STYLES = ("free", "list", "examples")
"""The three prompts of SINC's Table 1: (a) an open question, (b) a list to choose from, (c) the list and examples."""


def prompt_for(text: str, style: str = "examples") -> str:
    """The prompt about an action, of one of the :data:`STYLES`; the default did best in SINC's Table 1.

    Raises:
        InvalidInputError: an unknown style.
    """
    if style not in STYLES:
        raise InvalidInputError(f"there is no style of prompt {style!r}; there are {', '.join(STYLES)}")
    action = " ".join(text.split())
    if style == "free":
        return f"Which parts of the body does a person need for the action '{action}'? Name them."
    lines = [
        "Which parts of the body does a person need for the action? Choose only from this list:",
        *(f"- {part}" for part in ASKED),
        "Answer with the names of the parts alone, separated by commas. Name 'buttocks' or 'waist' when the whole body"
        " moves to another place or turns, and 'neck' when the head moves.",
        "",
    ]
    if style == "examples":
        lines += [f"Action: {example}\nParts: {parts}" for example, parts in EXAMPLES]
    return "\n".join([*lines, f"Action: {action}\nParts:"])


def parts_in_answer(answer: str) -> frozenset[str]:
    """The parts that a free-form answer names: hands are arms, neck and head torso, waist, hips and buttocks global.

    Limbs without a side are both. "none" is the empty set; what is denied ("not the left arm") does not count.

    Raises:
        LabellingError: nothing in it names a part; the message quotes the answer.
    """
    if not isinstance(answer, str):
        raise LabellingError(f"the language model must answer with text, not {type(answer).__name__}: {answer!r}")
    plain = _answer_alone(answer)
    denied = {match.start() for match in _DENIED.finditer(plain)}
    kept = _DENIED.sub(" ", plain)
    found = frozenset().union(*(_parts(match) for match in _NAMED.finditer(kept)))
    if not found and not _NOTHING.search(plain) and not (denied and _NAMED.search(plain)):
        raise LabellingError(f"no body part in the language model's answer {answer[:300]!r}")
    return found


def _answer_alone(answer: str) -> str:
    """Lower case, without marks, and of an answer that goes on with further actions only the first."""
    plain = re.sub(r"[*`\"'()\[\]{}_]+", " ", answer.strip()[:_READ].lower())
    plain = re.sub(r"\A\s*(?:parts|answer)\s*:", " ", plain)
    return re.split(r"\n\s*action\s*:", plain, maxsplit=1)[0]


def _parts(match: re.Match[str]) -> frozenset[str]:
    if match["torso"]:
        return frozenset({"torso"})
    if match["all"]:
        return frozenset(PARTS) if match["all"].startswith("whole") else frozenset({"global"})
    said = match["sides"] or "both"
    sides = [side for side in ("left", "right") if side in said] or ["left", "right"]
    return frozenset(f"{side} {'arm' if match['arm'] else 'leg'}" for side in sides)


class PromptLabeller:
    """Action text -> body parts by the caller's own language model; nothing is sent unless it is called.

    Args:
        complete: any ``prompt -> answer``.
        endpoint: an OpenAI-compatible endpoint, instead of ``complete``.
        style: which of the :data:`STYLES` of prompt.

    Raises:
        InvalidInputError: neither or both are given, or ``complete`` cannot be called; an unknown style.
    """

    def __init__(
        self, complete: Complete | None = None, *, endpoint: Endpoint | None = None, style: str = "examples"
    ) -> None:
        if (complete is None) == (endpoint is None):
            raise InvalidInputError(
                "labeller 'llm' needs a language model: complete=(any prompt -> answer) or endpoint=Endpoint(...)"
            )
        model = complete if complete is not None else endpoint
        if not callable(model):
            raise InvalidInputError(f"complete must be callable, prompt -> answer, not {type(model).__name__}")
        self._complete, self._style = model, style
        prompt_for("stand", style)  # an unknown style is refused at once

    def __call__(self, text: str) -> frozenset[str]:
        """The parts of one action.

        Raises:
            InvalidInputError: empty text.
            LabellingError: the model gives no answer, or one that names no part.

        What ``complete`` raises comes out as it is.
        """
        if not isinstance(text, str) or not text.strip():
            raise InvalidInputError("the action text is empty; say what somebody does, as in 'wave the right hand'")
        return parts_in_answer(self._complete(prompt_for(text, self._style)))
