"""Groups of words that patterns share, sides, negations and numbers."""

from __future__ import annotations

GROUPS = {
    "the": r"(?:(?:the|a|an|his|her|their|your|my|its|one'?s?) )?",
    "the2": r"(?:(?:the|a|an|his|her|their|your|my|its|of|one'?s?|both|two) )*",
    "hand": r"(?:hands?|biceps?|triceps|thumbs?|arms?|fists?|elbows?|wrists?|palms?|forearms?|shoulders?|fingers?)",
    "foot": r"(?:foot|feet|legs?|knees?|ankles?|toes?|heels?|thighs?|shins?)",
    "armact": (
        r"(?:hook|jab|cross|uppercut|punch|punches|swing|block|forehand|backhand|wave|throw|slap"
        r"|strike|reach|salute|point|serve|chop)"
    ),
    "legact": r"(?:kick|kicks|lunge|lunges|hop|hops|roundhouse|front kick|side kick|high kick|stomp|step ?up)",
    "limbs": r"(?:arms?|hands?|fists?|head|legs?|feet|foot|knees?|elbows?|fingers?|shoulders?)",
    "go": (
        r"(?:walk|run|jog|step|move|go|goes|stroll|stride|march|sprint|jump|hop|leap|creep|sneak|crawl"
        r"|advance|shuffle|skip|pace|travel|trot|dash|limp|trudge|stagger|shamble|lunge|wander|saunter"
        r"|amble|dribble|strut|hike|plod|hobble|slide|dance|skate|drift|charge|retreat|scoot|rush"
        r"|hurry)\w*(?: \w+ing)?"
    ),
    "turn": (
        r"(?:turn|rotate|rotat|pivot|veer|swerv|swing|curv|twist|bend|arc|spin|twirl|swivel|loop|circl"
        r"|spiral|cut|bear|wheel|reel|angl|whip|flip|corner|orbit)\w*"
    ),
    "unseated": (  # not behind words that say how somebody is on the floor
        r"(?<!sit )(?<!sits )(?<!sitting )(?<!sat )(?<!down )(?<!seated )(?<!crawl )(?<!crawls"
        r" )(?<!crawling )(?<!fours )"
        r"(?<!knees )(?<!kneel )(?<!kneels )(?<!kneeling )(?<!legged )(?<!something )(?<!foot )(?<!feet"
        r" )(?<!hands )(?<!hand )"
    ),
    "side": r"(?P<side>left|right)",
    "up": (
        r"(?:rais|lift|put|hold|held|thrust|throw|stretch|reach|punch|wav|shoot|swing|bring|point"
        r"|fling|extend)\w*"
    ),
    "high": r"(?:up\b|high|overhead|above|over|skyward|in the air|to the (?:sky|ceiling)|upward|aloft|into the air)",
    "rise": (
        r"(?:stands? up\b|standing up|stood up|gets? up\b|getting up|got up|(?:ris(?:e|es|ing)"
        r"|rose) (?:from|up\b|to (?:his|her|their) feet|again)|climbs? to (?:his|her|their) feet"
        r"|gets? (?:back )?to (?:his|her|their|the) feet|straightens? (?:back )?up|comes? (?:back )?up"
        r"|push\w* (?:\w+ )?up from|stand(?:s|ing)? (?:back )?up\b|get(?:s|ting)? (?:back )?(?:up"
        r"|on (?:his|her|their) feet)|(?:rise|get|stand|come)\w* from|(?:then|and) rises?\b(?! on))"
    ),
}

NO_SIDES = (  # a left or right that is none
    (
        r"\bright (?:away|after|now|before|then|there|here|at|in front|behind|next|beside|on time|back"
        r"|angles?|up|off|through|past|in the|into the|by|over to|around the|along|side up)\b"
    ),
    r"all ?right|just right|the right (?:way|moment|time|one|amount|direction|place)",
    r"\b(?:is|are|was|gets?|feels?) right\b",
    r"\b(?:has|have|had|is|are|was) left\b(?! (?:hand|foot|arm|leg|of))|left (?:alone|behind|over|off|standing)\b",
    r"\b(?:he|she|they|person|who) left (?:the|a)\b(?! (?:hand|foot|arm|leg))",
)

BOTH_SIDES = (
    r"left(?: hand| foot| arm| leg)? (?:and|then|or|to|,) (?:the |then )?right|right(?: hand| foot"
    r"| arm| leg)? (?:and|then|or|to|,) (?:the |then )?left|side to side|left,? right|alternat\w+"
    r"|each (?:hand|arm|foot|leg|side)|from (?:left|right) to (?:left|right)|either side"
    r"|both (?:sides|directions|ways)"
)

NEGATION = (
    r"\b(?:without|no longer|not|never|don'?t|doesn'?t|does not|do not|isn'?t|rather than"
    r"|instead of|avoid\w*|no)\b(?: \w+){1,4}?(?=[,.;]| and\b| but\b| while\b| then\b|$)"
)

NEGATED_MEANING = (  # a negation that says something itself
    (r"(?:without|not|never|no|doesn'?t|does not|don'?t) (?:\w+ )?(?:turn\w*|rotat\w*|spin\w*)", {"turn": "none"}),
    (
        (
            r"(?:without|not|never|no|hardly|barely|doesn'?t|does not|don'?t) (?:\w+ )?mov(?:e|es|ing"
            r"|ement)\b(?! (?:the|his|her|their|forward|back|from|away|off|along))"
        ),
        {"still": True},
    ),
    (
        r"(?:without|not|never|doesn'?t|does not|don'?t) (?:\w+ )?(?:budg|flinch|stirr?|twitch)(?:e|es|ing)?\b",
        {"still": True},
    ),
    (
        (
            r"(?:without|not|never|doesn'?t|does not|don'?t) (?:mov\w+ (?:from|off|away)|travel\w*|leav\w+"
            r"|going anywhere|advanc\w*|mov\w+ (?:forward|along))"
        ),
        {"travel": "none"},
    ),
    (
        r"(?:without|not|never|doesn'?t|does not|don'?t) (?:step\w*|lifting (?:the|his|her|their) feet)",
        {"steps": "none"},
    ),
)

NUMBERS = {
    "once": 1, "twice": 2, "thrice": 3, "one": 1, "single": 1, "two": 2, "double": 2, "three": 3, "triple": 3,
    "four": 4, "five": 5, "six": 6, "seven": 7, "eight": 8, "nine": 9, "ten": 10, "couple": 2, "pair": 2,
}  # fmt: skip

MANY = (
    r"\b(?:several|many|repeated|repeatedly|multiple|continuous\w*|a few|few|again and again"
    r"|over and over|keeps?|up and down|in a row|series of|various|a number of)\b"
)

TIMES = (
    r"(?:(?P<n>\d{1,2}|{numbers}) (?:more |quick |big |small |little |forward |consecutive "
    r"|two footed |one legged |long )*(?:times?|jumps?|hops?|leaps?|claps?|kicks?|punches|jabs?"
    r"|squats?|waves?|throws?|steps?|bounds?|push ?ups?|sit ?ups?|bows?|spins?|turns?|jacks?"
    r"|jumping jacks|lunges|bounces|swings|pirouettes|twirls|rotations|laps)\b|\b(?P<w>once|twice|thrice)\b)"
)

SEVERAL_CLAUSES = r",|;|\.(?! ?$)|\bthen\b|\bbefore\b|\bafter\b|\buntil\b|\bfinally\b"

SEVERAL_PARTS = SEVERAL_CLAUSES + r"|\band\b"

ANY_SIDE = r"\b(?P<side>left|right)(?:wards?)?\b"
