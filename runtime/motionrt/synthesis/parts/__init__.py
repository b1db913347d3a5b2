"""Body parts of actions: from text by rules or by a language model, from motion by speed."""

from __future__ import annotations

from motionrt.errors import LabellingError
from motionrt.synthesis.parts.endpoint import Complete, Endpoint
from motionrt.synthesis.parts.labelling import Labeller, body_parts
from motionrt.synthesis.parts.prompting import PromptLabeller, parts_in_answer, prompt_for
from motionrt.synthesis.parts.rules import Reason, RulesLabeller
from motionrt.synthesis.parts.speeds import part_speeds, relative_velocity_parts, velocity_parts

__all__ = [
    "Complete",
    "Endpoint",
    "Labeller",
    "LabellingError",
    "PromptLabeller",
    "Reason",
    "RulesLabeller",
    "body_parts",
    "part_speeds",
    "parts_in_answer",
    "prompt_for",
    "relative_velocity_parts",
    "velocity_parts",
]
