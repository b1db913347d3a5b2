"""Texts and motions of simultaneous actions: two labels in one sentence, and synthetic pairs (SINC 3.1)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import torch
from torch import Tensor

from motionrt.motion.body_parts import PARTS
from motionrt.synthesis.composing import Combination, combination, compatible
from motionrt_training.corpora.actions import Action
from motionrt_training.networks.egocentric import WIDTH

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


def combined(first: Tensor, second: Tensor, parts: Combination) -> Tensor:
    """Compose two egocentric motions (F, 136) as on `sinc135`: each joint from its source, the path with the pelvis."""
    frames = min(len(first), len(second))
    return torch.where(_columns(parts), second[:frames], first[:frames])


def _columns(parts: Combination) -> Tensor:
    joints = torch.from_numpy(np.array(parts.joints[:22]) == 1)
    whole = joints[0].expand(WIDTH - 6 * 22)  # turn, step, height
    return torch.cat((whole, joints.repeat_interleave(6)))


def random_combination(rng: np.random.Generator) -> Combination:
    """Parts dealt out at random, whatever the labels say: the control of SINC's table of synthetic data."""
    count = int(rng.integers(1, len(PARTS)))
    chosen = [PARTS[i] for i in rng.permutation(len(PARTS))[:count]]
    return combination([part for part in PARTS if part not in chosen], chosen, override=True)


def partners(actions: Sequence[Action], first: Action) -> list[int]:
    """The numbers of the actions that may be combined with `first`."""
    return [number for number, other in enumerate(actions) if compatible(first.parts, other.parts)]
