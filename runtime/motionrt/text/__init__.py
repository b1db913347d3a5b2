"""What words say about motion: one parser for search, generation and labels, and the condition vector of both."""

from __future__ import annotations

from motionrt.text.agreement import Agreement, agreement, agreements
from motionrt.text.clauses import clauses
from motionrt.text.gestures import Gestures, gestures_of_text, standing
from motionrt.text.heights import ceiling_of_text, headings_of_text, heights_of_text, strides_of_text
from motionrt.text.parsing import parse_query
from motionrt.text.query import ACTIONS, TextAttributes
from motionrt.text.slots import (
    SLOTS,
    mirror_slots,
    sideless_slots,
    slots_of_motion,
    slots_of_text,
)
from motionrt.text.targets import TARGETS, attribute_targets, mirror_known, mirror_targets, targets_of_text
from motionrt.text.ways import Way, way_of_text
from motionrt.text.wording import network_text

__all__ = [
    "ACTIONS",
    "SLOTS",
    "TARGETS",
    "Agreement",
    "Gestures",
    "TextAttributes",
    "Way",
    "agreement",
    "agreements",
    "attribute_targets",
    "ceiling_of_text",
    "clauses",
    "gestures_of_text",
    "headings_of_text",
    "heights_of_text",
    "mirror_known",
    "mirror_slots",
    "mirror_targets",
    "network_text",
    "parse_query",
    "sideless_slots",
    "slots_of_motion",
    "slots_of_text",
    "standing",
    "strides_of_text",
    "targets_of_text",
    "way_of_text",
]
