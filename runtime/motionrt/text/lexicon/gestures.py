"""Gestures whose course is plain from their word: where the hands go, how the trunk bows, which feet are lifted."""

from __future__ import annotations

from dataclasses import dataclass

Vector = tuple[float, float, float]
_NOWHERE: Vector = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Gesture:
    """What the hands do.

    Attributes:
        pattern: of the words that mean it, in lower-case text.
        hands: ``"one"`` (the arm that the text names, the right one else), ``"both"``, ``"left"`` or ``"right"``.
        places: where the wrist goes: (share of the gesture, out, up, ahead), metres from the shoulder, or from the
            head; "out" is away from the middle of the body.
        about: ``"shoulder"`` or ``"head"``.
        swing, swirl: metres out, up, ahead that the wrist swings as a sine, and as a cosine, of `hz`.
        hz: swings a second.
        alternate: whether the hands swing against each other.
        once_s: seconds that it lasts in the middle of the motion; 0 for what is kept up.
    """

    pattern: str
    hands: str
    places: tuple[tuple[float, float, float, float], ...]
    about: str = "shoulder"
    swing: Vector = _NOWHERE
    swirl: Vector = _NOWHERE
    hz: float = 0.0
    alternate: bool = False
    once_s: float = 0.0


def _kept(out: float, up: float, ahead: float) -> tuple[tuple[float, float, float, float], ...]:
    return ((0.0, out, up, ahead),)


_THROWN = (
    (0.0, 0.1, -0.1, 0.15),
    (0.45, 0.25, 0.22, -0.22),
    (0.62, 0.0, 0.22, 0.42),
    (0.75, -0.2, -0.15, 0.4),
    (1.0, -0.05, -0.35, 0.2),
)

_SMASHED = (
    (0.0, -0.12, -0.15, 0.3),
    (0.4, -0.14, 0.45, 0.02),
    (0.52, -0.14, 0.4, 0.2),
    (0.68, -0.14, -0.25, 0.42),
    (1.0, -0.12, -0.3, 0.32),
)
_BASKET = (
    (0.0, -0.08, -0.25, 0.28),
    (0.4, -0.08, 0.05, 0.24),
    (0.6, -0.1, 0.42, 0.26),
    (0.8, -0.1, 0.4, 0.28),
    (1.0, 0.0, -0.3, 0.25),
)
_SHOVED = ((0.0, 0.02, -0.15, 0.16), (0.45, 0.02, -0.12, 0.16), (0.65, -0.02, -0.08, 0.5), (1.0, 0.02, -0.2, 0.25))
_FIVE = ((0.0, 0.05, -0.3, 0.2), (0.45, 0.08, 0.2, 0.2), (0.6, 0.02, 0.28, 0.38), (1.0, 0.05, -0.2, 0.2))
_BOWLED = (
    (0.0, 0.02, -0.35, 0.2),
    (0.4, 0.05, -0.3, -0.38),
    (0.65, 0.02, -0.35, 0.32),
    (0.8, 0.0, 0.0, 0.45),
    (1.0, 0, -0.3, 0.2),
)
_DRAWN = (
    (0.0, -0.1, -0.05, 0.45),
    (0.3, -0.12, 0.02, 0.42),
    (0.7, 0.14, 0.0, 0.05),
    (0.85, 0.14, 0.0, 0.05),
    (0.9, 0.3, 0.0, -0.1),
    (1.0, 0.1, -0.3, 0.1),
)
_SPREAD = ((0.0, 0.1, -0.4, 0.1), (0.3, 0.49, 0.0, 0.05), (1.0, 0.49, 0.02, 0.05))
_REACHED = ((0.0, 0.05, -0.3, 0.2), (0.3, -0.02, -0.02, 0.52), (1.0, -0.02, -0.02, 0.52))

GESTURES = (
    Gesture(
        r"(?:\bclap\w*|\bapplau\w*) (?:\w+ ){0,3}(?:above|over|overhead)\b|\boverhead claps?",
        "both",
        _kept(-0.05, 0.44, 0.12),
        swing=(0.09, 0.0, 0.0),
        hz=2.0,
    ),
    Gesture(
        r"\b(?:draw\w*|shoot\w*|fir\w+|pull\w*|aim\w*) (?:with )?(?:a |the |an |his |her )?(?:bow|arrow"
        r"|longbow)s?\b|\barcher\w*",
        "left",
        _kept(-0.12, 0.02, 0.52),
    ),
    Gesture(
        r"\b(?:draw\w*|shoot\w*|fir\w+|pull\w*|aim\w*) (?:with )?(?:a |the |an |his |her )?(?:bow|arrow"
        r"|longbow)s?\b|\barcher\w*",
        "right",
        _DRAWN,
        once_s=3.0,
    ),
    Gesture(
        r"\bshoot\w* (?:a |the |some )?(?:basket|basketball|hoops?|three pointer|free throw)s?\b"
        r"|\bfree throws?\b|\bjump ?shot\b",
        "both",
        _BASKET,
        once_s=2.0,
    ),
    Gesture(
        r"\boverhead (?:\w+ ){0,4}(?:swing|smash|strike|chop|slash|hit|blow)|\b(?:chop\w*"
        r"|split\w*) (?:fire)?wood\b|\bsledge ?hammer"
        r"|(?:swing|smash|slam|bring)\w* (?:\w+ ){1,4}(?:down from|over (?:the |his |her )?head)|\baxe?\b",
        "both",
        _SMASHED,
        once_s=2.0,
    ),
    Gesture(
        r"\b(?:extend|stretch|straighten|hold|rais|lift|put|mov|bring|reach)\w* (?:\w+ ){0,4}(?:arm|hand)s? (?:\w+ )?"
        r"(?:to (?:the |his |her |their )?(?:left |right )?sides?|sideways|laterally|sidewards)\b",
        "one",
        _SPREAD,
    ),
    Gesture(
        r"\b(?:extend|stretch|straighten|hold|rais|lift|put|reach|mov|bring)\w* (?:\w+ ){0,4}(?:arm|hand)s? (?:\w+ )?"
        r"(?:forwards?|in front|to the front|ahead)\b|\breach\w* (?:out|forwards?)\b",
        "one",
        _REACHED,
    ),
    Gesture(
        r"(?:\bdribbl\w*|\bbounc\w* (?:it|the ball|a ball))\b(?! (?:\w+ ){0,4}(?:foot|feet|soccer|football))",
        "one",
        _kept(0.05, -0.36, 0.34),
        swing=(0, 0.13, 0),
        hz=1.9,
    ),
    Gesture(
        r"\bflex\w* (?:\w+ ){0,3}(?:biceps?|muscles?|arms?)\b",
        "one",
        _kept(0.26, 0.14, 0.06),
        swing=(-0.06, 0.1, 0),
        hz=0.8,
    ),
    Gesture(r"\bthumbs? up\b", "one", _kept(-0.02, -0.08, 0.42)),
    Gesture(r"\bbrush\w* (?:\w+ ){0,2}teeth\b", "one", _kept(0.0, -0.06, 0.16), "head", swing=(0.06, 0, 0), hz=2.4),
    Gesture(
        r"\b(?:comb|brush)\w* (?:\w+ ){0,2}hair\b",
        "one",
        _kept(0.12, 0.1, 0.02),
        "head",
        swing=(0, -0.12, -0.05),
        hz=0.9,
    ),
    Gesture(r"\bpour\w*\b", "one", _kept(-0.02, -0.12, 0.36), swing=(0.03, 0.05, 0), hz=0.5),
    Gesture(
        r"\bslap\w*\b|\bswat\w*",
        "one",
        ((0, 0.3, 0.0, 0.1), (0.45, 0.4, 0.05, -0.05), (0.65, -0.2, 0.05, 0.4), (1, 0.0, -0.3, 0.2)),
        once_s=1.4,
    ),
    Gesture(
        r"\bkarate chops?\b",
        "one",
        ((0, 0.1, 0.1, 0.1), (0.45, 0.15, 0.35, 0.0), (0.65, -0.02, -0.1, 0.45), (1, 0.0, -0.3, 0.2)),
        once_s=1.4,
    ),
    Gesture(r"\bbeckon\w*|\bcome here\b", "one", _kept(0.0, -0.05, 0.34), swing=(0, 0.1, -0.08), hz=1.3),
    Gesture(
        r"\b(?:blow|throw)\w* (?:\w+ )?kiss\w*",
        "one",
        ((0, 0, -0.06, 0.14), (0.45, 0, -0.05, 0.13), (0.8, 0.0, 0.05, 0.5), (1, 0, -0.1, 0.4)),
        "head",
        once_s=2.0,
    ),
    Gesture(
        r"\b(?:face ?palm|hand (?:on|to|over) (?:\w+ )?(?:face|forehead))\w*", "one", _kept(-0.1, 0.0, 0.13), "head"
    ),
    Gesture(r"\bshrug\w*", "both", _kept(0.22, -0.3, 0.2)),
    Gesture(r"\bhug(?:s|ging)?\b|\bembrac\w*", "both", _kept(-0.12, -0.08, 0.34)),
    Gesture(
        r"\b(?:row|rows|rowing)\b", "both", _kept(0.0, -0.2, 0.28), swing=(0, 0.05, 0.16), swirl=(0, 0.05, 0), hz=0.6
    ),
    Gesture(
        r"\b(?:pull|tug|heav)\w* (?:\w+ ){0,3}(?:rope|lever|cord|handle)\b|\bpull\w* (?:\w+ ){1,3}towards\b",
        "both",
        _kept(0.0, -0.18, 0.3),
        swing=(0, 0, 0.15),
        hz=0.7,
    ),
    Gesture(
        r"\bcarr(?:y|ies|ying)\b|\bhold(?:s|ing)? (?:a |the )?(?:\w+ )?(?:box|tray|crate|baby)\b",
        "both",
        _kept(-0.04, -0.34, 0.3),
    ),
    Gesture(r"\btak\w+ (?:a )?(?:photo|picture|selfie)s?\b|\bbinoculars\b", "both", _kept(0.02, -0.02, 0.2), "head"),
    Gesture(r"\b(?:stop sign|signals? (?:to )?stop|hand out to stop)\b", "one", _kept(0.0, 0.05, 0.48)),
    Gesture(
        r"\bbox(?:es|ing|er)\b(?! up)|\bshadow ?box\w*",
        "both",
        _kept(-0.06, -0.06, 0.28),
        swing=(-0.03, 0.02, 0.22),
        hz=0.9,
        alternate=True,
    ),
    Gesture(
        r"(?:\b(?:punch|jab|uppercut)\w*|(?:left|right) (?:cross|hook))\b(?! (?:\w+ )?(?:button|card))",
        "one",
        _kept(-0.06, -0.06, 0.28),
        swing=(-0.03, 0.02, 0.22),
        hz=0.9,
    ),
    Gesture(
        r"\b(?:hands|arms) (?:\w+ )?(?:in the air|overhead|above|up)\b.*\b(?:wav|sway|swing)\w*"
        r"|\bwav\w* (?:\w+ ){0,3}(?:hands|arms) (?:\w+ )?(?:in the air|overhead|above)",
        "both",
        _kept(0.05, 0.44, 0.05),
        swing=(0.14, 0, 0),
        hz=0.8,
    ),
    Gesture(
        r"\b(?:pat|tap|touch)\w* (?:\w+ ){0,2}head\b", "one", _kept(0.05, 0.2, 0.02), "head", swing=(0, 0.05, 0), hz=2.0
    ),
    Gesture(
        r"\bwav(?:e|es|ing|ed)\b(?! (?:the |a |his |her )?(?:sword|stick|flag|wand|towel))",
        "one",
        _kept(0.2, 0.26, 0.16),
        swing=(0.15, 0.02, 0),
        hz=1.5,
    ),
    Gesture(r"\bhigh ?fiv\w*", "one", _FIVE, once_s=1.8),
    Gesture(r"\bbowl(?:s|ing)?\b", "one", _BOWLED, once_s=2.0),
    Gesture(r"\bclap\w*|\bapplau\w*", "both", _kept(-0.05, -0.18, 0.33), swing=(0.09, 0.0, 0.0), hz=2.0),
    Gesture(r"\bthrow\w*|\btoss\w*|\bpitch(?:es|ing)?\b|\bhurl\w*|\bfling\w*", "one", _THROWN, once_s=1.6),
    Gesture(
        r"\bshov(?:es?|ing)\b|\bpush\w* (?!ups?)(?:\w+ ){0,4}(?:away|back|forwards?|both hands|hard)\b",
        "both",
        _SHOVED,
        once_s=2.4,
    ),
    Gesture(r"\bpoint(?:s|ing)?\b", "one", _kept(-0.04, 0.03, 0.5)),
    Gesture(
        r"shak\w+ (?:\w+ ){0,3}hands?\b|hand ?shak\w*", "one", _kept(-0.1, -0.28, 0.36), swing=(0, 0.05, 0), hz=1.8
    ),
    Gesture(
        r"(?:wip|clean|polish|scrub|wash)\w* (?:\w+ ){0,3}(?:table|desk|counter|surface|floor board)s?\b",
        "one",
        _kept(-0.02, -0.3, 0.36),
        swing=(0.14, 0, 0),
        swirl=(0, 0, 0.08),
        hz=0.9,
    ),
    Gesture(
        r"(?:wip|clean|polish|scrub|wash)\w* (?:\w+ ){0,3}(?:window|wall|glass|mirror|board|door|car)s?\b",
        "one",
        _kept(-0.02, 0.05, 0.4),
        swing=(0.14, 0, 0),
        swirl=(0, 0.12, 0),
        hz=0.9,
    ),
    Gesture(r"\bguitar\b|\bbanjo\b|\bukulele\b", "left", _kept(0.18, -0.14, 0.28), swing=(0.04, 0.02, 0), hz=0.4),
    Gesture(r"\bguitar\b|\bbanjo\b|\bukulele\b", "right", _kept(-0.12, -0.34, 0.22), swing=(0, 0.06, 0), hz=2.2),
    Gesture(r"\bviolin\b|\bfiddle\b", "left", _kept(0.08, 0.0, 0.36)),
    Gesture(r"\bviolin\b|\bfiddle\b", "right", _kept(-0.08, -0.06, 0.32), swing=(0.13, -0.05, 0), hz=0.8),
    Gesture(
        r"\bpiano\b|\bkeyboard\b|\btyp(?:es|ing)\b",
        "both",
        _kept(0, -0.3, 0.36),
        swing=(0.02, 0.025, 0),
        hz=2.2,
        alternate=True,
    ),
    Gesture(r"\bdrum(?:s|ming)?\b", "both", _kept(-0.02, -0.2, 0.36), swing=(0, 0.12, 0), hz=1.8, alternate=True),
    Gesture(r"\bjuggl\w*", "both", _kept(0.0, -0.24, 0.32), swing=(0, 0.14, 0), hz=1.5, alternate=True),
    Gesture(
        r"\bsteer\w*|\bdriv(?:es|ing) (?:a |the |his |her )?(?:car|truck|bus)",
        "both",
        _kept(-0.02, -0.12, 0.4),
        swing=(0, 0.1, 0),
        hz=0.4,
        alternate=True,
    ),
    Gesture(r"\bconduct\w*", "both", _kept(0.12, 0.02, 0.34), swing=(0.12, 0, 0), swirl=(0, 0.14, 0), hz=0.9),
    Gesture(
        r"\bdrink\w*|\bsips?\b|\bsipping\b",
        "one",
        (
            (0, -0.02, -0.3, 0.3),
            (0.35, -0.02, -0.3, 0.3),
            (0.5, 0.05, -0.06, 0.15),
            (0.8, 0.05, -0.04, 0.13),
            (1, 0.0, -0.3, 0.3),
        ),
        "head",
        once_s=3.0,
    ),
    Gesture(r"\beat(?:s|ing)?\b", "one", _kept(0.04, -0.16, 0.2), "head", swing=(0, 0.12, -0.06), hz=0.5),
    Gesture(r"\bphone\b|\bcalls? (?:someone|somebody)", "one", _kept(0.12, -0.04, 0.03), "head"),
    Gesture(r"\bsalut\w*", "one", _kept(0.13, 0.06, 0.1), "head"),
    Gesture(
        r"\bscratch\w* (?:\w+ ){0,2}(?:head|hair)",
        "one",
        _kept(0.09, 0.13, 0.02),
        "head",
        swing=(0.02, 0.02, 0.02),
        hz=2.5,
    ),
    Gesture(
        r"(?:\bscratch\w*|\brub\w*|\bwip\w*|\btouch\w*|\bstrok\w*) (?:\w+ ){0,2}"
        r"(?:nose|chin|face|beard|mouth|eyes?|forehead|brow)\b",
        "one",
        _kept(0.05, -0.04, 0.13),
        "head",
        swing=(0.02, 0.01, 0),
        hz=1.5,
    ),
    Gesture(
        r"\bcover\w* (?:\w+ ){0,2}(?:ears|face|eyes)|\bhands? (?:on|to|behind) (?:\w+ )?(?:head|ears|neck)"
        r"|\bhands? over (?:\w+ )?ears",
        "both",
        _kept(0.12, 0.0, 0.02),
        "head",
    ),
    Gesture(
        r"\bcross\w* (?:\w+ ){0,2}arms|\barms (?:are )?(?:crossed|folded)|\bfold\w* (?:\w+ ){0,2}arms",
        "both",
        _kept(-0.25, -0.25, 0.2),
    ),
    Gesture(r"\bhands? on (?:\w+ )?(?:hips?|waist)|\bakimbo\b", "both", _kept(0.06, -0.42, 0.04)),
    Gesture(r"\bpray(?:s|ing|er)?\b|palms together", "both", _kept(-0.14, -0.14, 0.26)),
    Gesture(r"\bknock(?:s|ing)?\b", "one", _kept(-0.04, 0.0, 0.38), swing=(0, 0, 0.07), hz=2.8),
    Gesture(r"\bhammer\w*|\bchop(?:s|ping)?\b", "one", _kept(-0.02, 0.0, 0.3), swing=(0, 0.25, -0.06), hz=1.1),
    Gesture(r"\bsaw(?:s|ing)\b", "one", _kept(-0.02, -0.3, 0.28), swing=(0, -0.03, 0.13), hz=1.3),
    Gesture(
        r"\bstir(?:s|ring)?\b|\bmix(?:es|ing)\b",
        "one",
        _kept(-0.06, -0.3, 0.32),
        swing=(0.09, 0, 0),
        swirl=(0, 0, 0.08),
        hz=1.0,
    ),
    Gesture(r"\bflap\w*|like a bird", "both", _kept(0.4, 0.05, 0.02), swing=(-0.03, 0.24, 0), hz=1.1),
    Gesture(
        r"\barms (?:out|outstretched|spread|wide)\b|\bspread\w* (?:\w+ ){0,2}arms|\bt ?pose\b|like an? (?:air)?plane",
        "both",
        _kept(0.49, 0.02, 0.02),
    ),
    Gesture(r"jumping ?jacks?|star ?jumps?", "both", _kept(0.28, 0.02, 0.02), swing=(0, 0.4, 0), hz=1.0),
    Gesture(r"\blook\w* at (?:\w+ )?watch|\bcheck\w* (?:the time|(?:\w+ )?watch)", "left", _kept(-0.14, -0.12, 0.3)),
)
"""Hands of gestures, the first that matches first; what is not here is left to the network."""

REACHES_DOWN = Gesture(
    "",
    "one",
    ((0.0, 0.0, -0.44, 0.1), (0.35, -0.06, -0.53, 0.1), (0.6, -0.06, -0.53, 0.1), (1.0, 0.0, -0.44, 0.1)),
    once_s=2.4,
)
"""The hand of who picks something up from the floor."""

POINTS_TO = r"\bpoint(?:s|ing)? (?:\w+ ){0,2}(?P<side>left|right)\b"
"""Who points to a side does so with the hand of that side, where none is named."""

NOT_GESTURES = r"\bpoint(?:s|ed)? of\b|\bfloor|\bcartwheel|\bflip"
"""Texts in which such words mean something else."""

BOWS = (
    r"(?<!draw )(?<!a )(?<!violin )\bbow(?:s|ing|ed)?\b(?! (?:and arrow|string|tie))|tak\w+ a bow|\bcurts\w*"
    r"|\b(?:bend|lean)\w* (?:\w+ )?(?:forwards?|over|at the waist)\b"
    r"(?!.*(?:pick|floor|ground|toes|grab|tie|lift|knees))"
)
"""The trunk goes down to the front and comes up again."""
MARCHES = r"\bmarch\w*|high knees|\b(?:stomp|stamp)\w*|(?:walk\w*|step\w*) (?:on the spot|in place)"
"""Knees come up in turn, on the spot or on the way."""
BALANCES = r"(?:stand|balanc)\w* (?:\w+ ){0,3}on (?:one|his|her|the|a single) (?:left |right )?(?:foot|leg)|flamingo"
"""One foot stays lifted."""

ONE_KNEE = r"\bone knee\b|\bgenuflect\w*|\bpropos\w*|(?:left|right) knee\b"
"""Whoever kneels does so on one knee."""


@dataclass(frozen=True)
class HeadGesture:
    """What the head does, which positions of joints cannot say.

    Attributes:
        pattern: of the words that mean it, in lower-case text.
        left, down: radians that it is turned and bent.
        hz: how often a second it goes there and to the other side, or back; 0 for what is kept up.
    """

    pattern: str
    left: float = 0.0
    down: float = 0.0
    hz: float = 0.0


HEADS = (
    HeadGesture(
        r"\blook\w* (?:all )?(?:around|about)\b|\bsearch\w* around|\bscan\w* the"
        r"|\blook\w* (?:to the )?(?:left and right|right and left|both ways)",
        left=1.0,
        hz=0.3,
    ),
    HeadGesture(r"\bshak\w+ (?:\w+ ){0,2}head\b|\bhead ?shak\w*", left=0.5, hz=1.2),
    HeadGesture(r"\bnod(?:s|ding|ded)?\b", down=0.35, hz=1.2),
    HeadGesture(r"\b(?:look|glanc|star)\w* (?:\w+ )?(?:up|upwards?|at the (?:sky|ceiling))\b", down=-0.5),
    HeadGesture(r"\b(?:look|glanc|star)\w* (?:\w+ )?(?:down|downwards?|at the (?:floor|ground|feet))\b", down=0.5),
    HeadGesture(r"\b(?:look|glanc)\w* (?:\w+ ){0,3}left\b", left=0.9),
    HeadGesture(r"\b(?:look|glanc)\w* (?:\w+ ){0,3}right\b", left=-0.9),
)
"""Heads, the first that matches counts."""
