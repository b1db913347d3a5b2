"""One call for the body parts of an action text, whoever labels it."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

from motionrt.errors import InvalidInputError
from motionrt.motion.body_parts import checked_parts
from motionrt.synthesis.parts.endpoint import Complete, Endpoint
from motionrt.synthesis.parts.prompting import PromptLabeller
from motionrt.synthesis.parts.rules import RulesLabeller
from motionrt.untrusted.arguments import check_kind

Labeller = Callable[[str], frozenset[str]]
LABELLERS = ("rules", "llm")


def body_parts(
    text: str, *, labeller: str | Labeller = "rules", complete: Complete | None = None, endpoint: Endpoint | None = None
) -> frozenset[str]:
    """The parts of :data:`motionrt.motion.body_parts.PARTS` that an action text involves.

    Args:
        text: a phrase or a sentence, as in "walk while waving the right hand".
        labeller: ``"rules"`` (offline), ``"llm"`` (a language model of the caller's), or any ``text -> parts``.
        complete: for ``"llm"``: any ``prompt -> answer``.
        endpoint: for ``"llm"``: an OpenAI-compatible endpoint, instead of ``complete``.

    Raises:
        InvalidInputError: empty text, an unknown labeller, ``"llm"`` without a model, or a callable that returns
            something else than names of parts.
        LabellingError: the language model gives no answer, or one that names no part.

    What a callable of yours raises comes out as it is.
    """
    if not isinstance(text, str) or not text.strip():
        raise InvalidInputError("the action text is empty; say what somebody does, as in 'wave the right hand'")
    if not (isinstance(labeller, str) and labeller == "llm") and (complete is not None or endpoint is not None):
        raise InvalidInputError("complete and endpoint are for labeller='llm'; say so, or leave them out")
    if callable(labeller):
        return _checked(labeller(text))
    check_kind(labeller, str, "labeller", "a name or a function")
    if labeller == "rules":
        return _rules()(text)
    if labeller == "llm":
        return PromptLabeller(complete, endpoint=endpoint)(text)
    raise InvalidInputError(f"unknown labeller {labeller!r}; there are 'rules' and 'llm', or pass a callable")


@lru_cache(maxsize=1)
def _rules() -> RulesLabeller:
    return RulesLabeller()


def _checked(answer: object) -> frozenset[str]:
    """The answer of somebody's callable as a set of known parts."""
    if not isinstance(answer, (str, frozenset, set, list, tuple)):
        raise InvalidInputError(f"the labeller must return names of body parts, not {type(answer).__name__}")
    return checked_parts(answer)
