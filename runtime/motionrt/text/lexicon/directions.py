"""Turns, paths, travel and speed."""

from __future__ import annotations

CLOCKWISE = (  # seen from above
    (r"\b(?:counter|anti) ?clockwise\b|\bccw\b", "left"),
    (r"(?<!counter )(?<!anti )\bclockwise\b|\bcw\b", "right"),
)

TURNS = (  # the first that matches
    (
        "full",
        (
            r"(?:full|complete|whole|entire) (?:turn|rotation|spin|circle|revolution)|360"
            r"|all the way (?:round|around)|two full|once around|(?:turn|spin|rotat"
            r"|twirl)\w* (?:in )?(?:a |one )?(?:full )?circles?\b(?! (?:path|of))"
        ),
    ),
    (
        "around",
        (
            r"(?:turn|swing|pivot|twist|flip|wheel|rotat|whip|come"
            r"|face)\w*(?: \w+){0,2} (?:a?round|about)\b(?! (?:the|a|an|his|her|in circles|and round"
            r"|and around)\b)|about ?(?:face|turn)\b|u ?turn|\b180\b|half ?(?:a )?(?:turn|circle|rotation"
            r"|spin)|half ?way (?:a?round)|revers\w+ (?:direction|course)|fac\w+ the (?:other"
            r"|opposite) (?:way|direction|side)|one eighty|back the way|the other way|turn\w* back\b"
            r"|doubl\w+ back|(?:left|right) about\b|opposite direction"
        ),
    ),
    ("turn", r"\b(?:turn|rotat|pivot|veer|swerv|swivel)\w*\b|90|quarter turn|corner"),
)

NO_TURN = (
    r"\bstraight(?: ahead| forward| line| on| path| back)?\b(?! (?:arm|leg|punch|right|left|up|jab"
    r"|kick|knee|down)|(?:en|ens|ened|ening)\b)|\bin a line\b"
)

TURN_SIDE = (  # how a side belongs to a turn or a path
    r"{turn}(?: \w+){0,4}? {side}\b(?! (?:{hand}|{foot}|{armact}|{legact}))",
    (
        r"{side}(?: hand| handed| ?ward| ?wards)? (?:\w+ )?(?:turn|pivot|rotation|spin|curve|bend"
        r"|circle|arc|about|u turn|loop|twirl|corner|spiral|swerve)\w*"
    ),
    r"\b(?:facing|faces|face)(?: to)? (?:the |his |her |their )?{side}\b(?! (?:{hand}|{foot}))",
    (
        r"\b(?:go|goes|going|hang|make\w*|take\w*|hard|head\w*) (?:a |an )?{side}\b(?! (?:{hand}"
        r"|{foot}|{armact}|{legact}|side))"
    ),
    r"{side} (?:wheel|face)\b",
    r"\b(?:45|90|180|270|360|degrees?) (?:degrees? )?(?:to |towards? )?(?:the |his |her "
    r"|their )?{side}\b(?! (?:{hand}|{foot}))",
)

SPINS = (
    r"\bspin(?:s|ning)?\b|\btwirl\w*|pirouett\w*|\bwhirl\w*|turn\w* on the spot|spun\b"
    r"|\bpivots? (?:a )?full|(?:turn|spin)\w* in circles|\b720\b"
)

CIRCLES = (
    r"\bcircle[sd]?\b|circling|circular|\bloops?\b|\blaps?\b|round and round|orbit\w*|\bspiral\w*"
    r"|full circle|\brings?\b(?! (?:a|the) (?:bell|doorbell))"
)

CURVES = (
    r"\bcurv\w+|\barcs?\b|arcing|\bbend(?:s|ing)? (?:to|left|right|round|around)|\bveer\w*"
    r"|\bswerv\w*|semi ?circle|half circle|rounded|around (?:a|the) (?:bend|corner|cone|obstacle"
    r"|table|pillar|tree|chair)|gentle(?: left| right)? turn|wide turn|slalom"
)

NOT_PATHS = (
    r"(?:walk|run|sprint|jog|idle|crawl|stand|punch|kick|danc|step|motion|stroll)\w* (?:cycle"
    r"|loop)\b|\blooping\b|(?:arm|hand|hip|shoulder|ankle|wrist|head|neck|leg|knee|foot|torso"
    r"|elbow)s? (?:\w+ )?(?:circle|in circle|in (?:small |big |large )?circle)\w*|(?:circles?"
    r"|circling|rotat\w*|twirl\w*|spin\w*|roll\w*|swing\w*|turn\w*|twist\w*) (?:the|his|her|their"
    r"|both|its|a) (?:\w+ )?(?:arm|hand|hip|shoulder|ankle|wrist|head|neck|leg|knee|torso"
    r"|upper body|trunk|waist|ball|racket|lid|knob|key|handle|bolt|wheel|cap|bat|sword|rope|stick"
    r"|lasso|page|valve|wrench)\w*|(?:makes?|draws?) (?:\w+ )?circles? with"
    r"|look\w* (?:to the )?(?:left|right)|(?:head|torso|upper body|trunk|waist) (?:turn|twist"
    r"|rotat)\w*"
)

TRAVELS = (
    (
        "none",
        (
            r"\bin place\b|on the spot|stationary|stand(?:s|ing)? (?:perfectly |completely |very "
            r"|quite )?still|idl(?:e|es|ing)\b|motionless|same (?:spot|place)|treadmill|without travel"
        ),
    ),
    (
        "backward",
        (
            r"backwards?\b(?! (?:arm|kick|bend|lean|swing))|(?:{go}) (?:\w+ )?back\b(?! (?:and forth|to"
            r"|up to|in (?:the|his|her|place|position)|into|from|down|upright))|back(?:s|ing|ed)? (?:up"
            r"|away|off|pedal\w*)\b|\bbackpedal\w*"
            r"|retreat\w*|\bin reverse\b|moonwalk\w*|\brearward\b|\bbacks\b"
        ),
    ),
    (
        "side",
        (
            r"side ?step\w*|sideways|side ?ways|side shuffle\w*|strafe?\w*|strafing|crab ?walk"
            r"|lateral(?:ly)?\b|grapevine|side gallop|steps? to the side|moves? to the side"
            r"|side to side shuffle"
        ),
    ),
    (
        "forward",
        (
            r"\bforwards?\b(?! (?:bend|fold|lean|kick|roll|swing))|\bahead\b|onwards?|\badvanc\w+"
            r"|\bapproach\w*|towards?\b|\b(?:jump|leap|vault|hop|bound|spring)\w* (?:\w+ )?(?:over|across)\b"
        ),
    ),
)

BACKWARD = (
    r"\bbackwards?\b|back(?:s|ing|ed)? (?:up|away|off|pedal\w*)\b|\bbackpedal\w*|\bin reverse\b"
    r"|moonwalk"
)  # not "walks back"

SIDEWAYS_TO = (
    r"{go}(?: \w+){0,2}? (?:to (?:the|his|her|their|your|its) )?(?P<side>left"
    r"|right)(?:wards?)?(?: side)?\b(?! (?:{hand}|{foot}|{armact}|{legact}|turn|circle|curve|about"
    r"|behind))"
)

GOES = (
    r"\b(?:walk|run|jog|stroll|strid|march|sprint|creep|sneak|crawl|skip|trot|trudg|stagger|limp"
    r"|pac|saunter|wander|hik|strut|dash|hobbl|plod|ambl|sham?bl|charg|jaunt|swagger|run|tip ?to(?=e(?:s"
    r"|ing)\b|e (?:past|across|forward|around|through|along|away|to|over)\b)|stumbl|lurch|gallop"
    r"|scurr|zig ?zag|slalom|shuffl(?=(?:es?|ing) (?:along|forward|ahead|on))|lung(?=es? (?:forward|across)))(?:s|ks"
    r"|ing|eing|es|e|ning|ned|ed|ging|ged|ped|ping|ting|ted)?\b"
)

IN_PLACE_ACTIONS = frozenset(
    {"stand", "sit", "lie", "clap", "stretch", "jumping jack", "wave", "squat", "bow", "kneel", "gesture", "golf"}
)

SPEEDS = (
    (
        "still",
        (
            r"stand(?:s|ing)? (?:perfectly |completely |very |quite )?still|motionless|\bidl(?:e|es|ing)\b"
            r"|\bfreez\w*|frozen|stays? still|holds? still|stationary|perfectly still|remain\w* still"
        ),
    ),
    (
        "run",
        (
            r"\bsprint\w*|\bruns?\b(?! (?:a |his |her |their )?(?:hand|finger|comb))|\brunning\b(?! (?:man"
            r"|in place|on the spot))|\bran\b|\bdash\w*|full speed|\bcharges?\b|\bcharging\b|gallop\w*"
        ),
    ),
    ("jog", r"\bjog\w*|\btrot\w*"),
    (
        "slow",
        (
            r"\bsneak\w*|\bcreep\w*|\btip ?toe\w*|\btrudg\w*|\bshuffl\w+|\bstagger\w*|\blimp\w*|old (?:man"
            r"|person|woman|lady)|elderly|zombie|\bhobbl\w*|\bplod\w*|cautious\w*|careful\w* (?:walk"
            r"|step)\w*|walk\w* careful\w*|tired(?:ly)? (?:walk)?\w*|wearily|(?:slow"
            r"|slowly) (?:\w+ )?(?:walk|step|stroll|march|shuffl|mov)\w*|(?:walk|step|stroll|march|mov"
            r"|stepp)\w*(?: \w+){0,3} slow(?:ly)?\b|small steps|baby steps|\bcrawl\w*"
        ),
    ),
    (
        "walk",
        (
            r"\bwalk\w*|\bstroll\w*|\bstrid(?:e|es|ing)\b|\bsaunter\w*|\bmarch\w*|\bstrut\w*|\bswagger\w*"
            r"|\bpac(?:e|es|ing)\b"
        ),
    ),
)

PACES = (
    (
        "slow",
        (
            r"\bslow(?:ly)?\b|gradual\w*|gentl[ey]\b|leisurely|unhurried|careful\w*|lazily|sluggish\w*"
            r"|calm(?:ly)?\b|\b(?:in )?slow motion\b|\bslo ?mo\b"
        ),
    ),
    (
        "fast",
        (
            r"\bfast(?:er)?\b|quick(?:ly|er)?\b|rapid(?:ly)?\b|swift(?:ly)?\b|brisk(?:ly)?\b|hurr(?:y|ies"
            r"|ied|iedly)\b|as fast as|flat out|(?:top|full) speed|full tilt|energetic\w*|vigorous\w*"
            r"|furious\w*|\brush\w*|speedy|speedily|sudden\w*"
        ),
    ),
)

STEPS_IN_PLACE = (
    r"(?:march|walk|jog|run|step|sprint)\w* (?:in place|on the spot)|treadmill|running on the spot"
    r"|stair ?master"
)

TURN_WORDS = (
    r"\b(?:turn|rotat|pivot|veer|swerv|swivel|spin|twirl|whirl|about ?face|u turn|circl|curv"
    r"|revers|twist|swing)\w*|clockwise"
)

TURN_VERBS = r"\b(?:face|faces|facing|wheel|go|goes|take|takes|make|makes|hard)\b"

WARD = r"\b(?P<side>left|right)ward"

STEPS_OR_TURNS = r"\b(?:step|mov|turn|approach|spin)\w*"


COURSES = (  # ways that bend to one side and the other
    (
        "zigzag",
        (
            r"\bzig ?zag\w*|\bslalom\w*|\bserpentine\b|\bweav(?:es?|ing) (?:\w+ )?(?:through|between"
            r"|in and out|left|from)"
            r"|\bs (?:shape|curve)\w*|\b(?:winding|wavy|snaking) (?:path|line|way|course)\b"
        ),
    ),
    (
        "eight",
        r"\bfigures? (?:of )?(?:eights?|8s?)\b|\binfinity\b|\b(?:shape of an? |number )(?:eight|8)\b|\beight shape\w*",
    ),
)
