"""Words that put one act behind another."""

from __future__ import annotations

THEN = (
    r",? ?\b(?:and |but )?(?:then|afterwards?|after (?:that|this|a (?:while|moment|second|bit))|next"
    r"|finally|subsequently"
    r"|later|followed by|after which|before (?:finally )?(?=going on to\b))\b,?|;|\.(?= ?\w)"
)
"""Between two acts, the first of which comes first."""

BEFORE = r",? ?\b(?:right |just |shortly )?before\b"
"""Before the act that comes second."""

AFTER = r",? ?\b(?:right |just |shortly )?(?:after|once)\b(?= (?:\w+ing|(?:he|she|they|having)\b))"
"""Before the act that comes first."""

AND = r",? and | and |, "
"""Between two acts that may be at once."""

LEADS = (
    r"^(?:(?:and|then|but|first|he|she|they|it|the (?:man|woman|person|figure|character)|having|to|going on to|finally"
    r"|quickly|slowly) )*"
)
"""What a clause may begin with before its verb."""

STOPS = (
    r"(?:sits?|sat|lies|lays?|kneels?|kneel|stops?|halts?|pauses?|bows?|turns? (?:a?round|about)|picks?"
    r"|squats?|crouch(?:es)?"
    r"|falls?|collapses?|stands? up|gets? (?:up|down)|rises?|salutes?|claps?|cartwheels?|sitting|kneeling"
    r"|lying|stopping)\b"
)
"""An act for which somebody who goes stops."""

JOINS = r"^(?:up|down|forwards?|backwards?|left|right|over|back|around|in|out|on|to|at|by)\b"
"""Behind an "and", what belongs to the act before it."""

LIST = r",[^,]+, (?:and )?"
"""Acts with commas between them, three at least."""

NEW_SUBJECT = r", ?| (?=(?:the |a )?(?:person|man|woman|figure|character|someone|somebody|he|she|they)\b)"
"""Where the main clause begins behind "before doing this"."""

VERB = r"^(?!with|while|as|his|her|their|the|to|in|at|on)\w+(?<!ing)\b"
"""A clause that begins with its verb and is at the same time as nothing."""
