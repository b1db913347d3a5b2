"""Every word and phrase that the parser knows, in one place; patterns are matched in lower-case text.

A text is prepared first (:func:`motionrt.text.parsing.prepared`): lower case, hyphens apart, sides that are none
("right away") and negated clauses taken out. ``{...}`` names a group of words of :data:`GROUPS`.
"""

from __future__ import annotations

GROUPS = {
    "the": r"(?:(?:the|a|an|his|her|their|your|my|its|one'?s?) )?",
    "the2": r"(?:(?:the|a|an|his|her|their|your|my|its|of|one'?s?|both|two) )*",
    "hand": r"(?:hands?|arms?|fists?|elbows?|wrists?|palms?|forearms?|shoulders?|fingers?)",
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
        r"|on (?:his|her|their) feet)|(?:rise|get|stand|come)\w* from)"
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
NOT_POSTURES = (  # what falls, rises or stands is a limb
    r"{limbs} (?:\w+ ){0,2}?(?:fall|ris|drop|lower|stand|lie|rest)\w*(?: (?:down|up|to|from))?",
    r"let\w* (?:\w+ ){1,4}?(?:fall|drop)\w*|dead hang|falls? (?:back )?(?:in|into|behind|asleep standing)",
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
            r"(?:turn|spin|swing|whirl|pivot|twist|flip|wheel|rotat|whip|come"
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
)
SPINS = (
    r"\bspin(?:s|ning)?\b|\btwirl\w*|pirouett\w*|\bwhirl\w*|turn\w* on the spot|spun\b"
    r"|\bpivots? (?:a )?full|(?:turn|spin)\w* in circles|\b720\b"
)
CIRCLES = (
    r"\bcircle[sd]?\b|circling|circular|\bloops?\b|\blaps?\b|round and round|orbit\w*|\bspiral\w*"
    r"|full circle|ring\b"
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
            r"|up to|in|from|down|upright))|back(?:s|ing|ed)? (?:up|away|off|pedal\w*)\b|\bbackpedal\w*"
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
            r"|\bapproach\w*|towards?\b"
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
    r"|pac|saunter|wander|hik|strut|dash|hobbl|plod|ambl|sham?bl|charg|jaunt|swagger|run)(?:s|ks"
    r"|ing|es|e|ning|ned|ed|ging|ged|ped|ping|ting|ted)?\b"
)
IN_PLACE_ACTIONS = frozenset(
    {"stand", "sit", "lie", "clap", "stretch", "jumping jack", "wave", "squat", "bow", "kneel"}
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
            r"|calm(?:ly)?\b"
        ),
    ),
    (
        "fast",
        (
            r"\bfast(?:er)?\b|quick(?:ly|er)?\b|rapid(?:ly)?\b|swift(?:ly)?\b|brisk(?:ly)?\b|hurr(?:y|ies"
            r"|ied|iedly)\b|energetic\w*|vigorous\w*|furious\w*|\brush\w*|speedy|speedily|sudden\w*"
        ),
    ),
)

ARMS_UP = (  # the first that matches
    (
        "both",
        (
            r"jumping ?jack\w*|star ?jump\w*|hands up\b|arms up\b|hands in the air|surrender\w*"
            r"|arms overhead|hands overhead|wav\w* (?:\w+ )?(?:arms|hands)\b|arms (?:raised )?(?:above"
            r"|over|high)|hands (?:raised )?(?:above|over|high)|handstand|{up} (?:up )?{the2}(?:both "
            r"|two )?(?:of )?{the2}(?:arms|hands)(?: straight)? {high}|(?:rais|lift)\w* (?:up )?(?:both "
            r"|two )?(?:of )?(?:the |his |her |their |your )?(?:arms|hands|fists)\b(?! (?:to|forward|out"
            r"|in front|side))|(?:arms|hands) (?:are |is )?(?:go |goes |shoot |rise |stretched |thrown "
            r"|held )?(?:up\b|overhead|high)|(?:both|two) (?:arms|hands|fists) (?:\w+ )?(?:up\b|overhead"
            r"|high|raised|over|above)|chin ?ups?|pull ?ups?|overhead press|shot at the basket"
            r"|shoots? a basket|jump ?shot|cheer\w*|overhead clap|hail\w*|sun salutation|y pose|victory"
        ),
    ),
    (
        "one",
        (
            r"\bwav(?:e|es|ing|ed)\b(?! (?:\w+ )?(?:arms|hands|the sword|a sword|sword|his arms|her arms"
            r"|a stick))|\bhand up\b|\barm up\b|{up} (?:up )?{the}(?:left |right )?(?:arm|hand"
            r"|fist)(?: straight)? {high}|(?:rais|lift)\w* (?:up )?{the}(?:left |right )?(?:arm|hand"
            r"|fist)\b(?! (?:to the (?:side|front)|forward|out|in front))|(?:left|right) (?:arm|hand"
            r"|fist) (?:\w+ )?(?:up\b|overhead|high|raised|in the air|above)|salut\w*|tennis serve"
            r"|\bserv(?:e|es|ing)\b|overhand|hook shot|lay ?up|\bdunk\w*|hailing|(?:arm|hand|fist) raised"
            r"|pitch(?:es|ing)? (?:a|the) ball|spik\w+ (?:a|the) ball"
        ),
    ),
)
ARM_SIDE = (
    (
        r"{side} (?:(?!foot|leg|knee)\w+ )?(?:{hand}|{armact})\b(?! (?:side|turn|circle|loop|bend"
        r"|curve|spiral|corner|arc|way)\w*)"
    ),
    r"{side} ?hande[dr]\b",
    r"(?:with|using|by|throw\w*|on|of) (?:the |his |her |their |your )?{side}\b(?! (?:{foot}|{legact}|side|turn))",
)
BOTH_ARMS = (
    r"both (?:of )?(?:his |her |their |the |your )?(?:hands|arms|fists)|two (?:handed|hands|arms"
    r"|fisted)|\b(?:his|her|their|the) (?:arms|hands|fists)\b|arms (?:swing|wav|flap|out|up|wide"
    r"|stretched|crossed)|with (?:arms|hands)|flap\w*|clap\w*|applau\w*|jumping jack|boxing"
    r"|push ?ups?|swim\w*"
)
LEG_SIDE = (
    r"{side} (?:\w+ )?(?:{foot}|{legact})\b",
    (
        r"(?:hop|stand|balanc|kick)\w*(?: \w+){0,2} (?:on|with) (?:the |his |her |their "
        r"|your )?{side}\b(?! (?:{hand}|side))"
    ),
)
SUPPORT = (
    r"(?:stand|hop|balanc|jump|pivot|land)\w*(?: \w+){0,2} (?:on|onto) (?:the |his |her |their "
    r"|your |one )?{side}(?: (?:foot|leg))?\b(?! (?:knee|hand|arm|side))"
)
FOOT_LIFT = (  # what lifts a foot high
    r"kick\w*|knee (?:strike|up|lift|raise|kick)\w*|high knees?|(?:lift|rais|bring|pull|swing|hold"
    r"|pick)\w* (?:up )?(?:the |his |her |their |your |one |a |both )?(?:left |right )?(?:foot|leg"
    r"|knee|feet|knees|legs)\b(?! (?:on|apart))|(?:knees?|legs?|foot) (?:raised|lifted|up\b|high)"
    r"|on one (?:leg|foot)|one leg(?:ged)?\b|hop\w* on (?:the |his |her )?(?:left|right)"
    r"|roundhouse|stork|arabesque|leg (?:raise|swing|lift)\w*|high ?step\w*|step(?:s|ping)? over"
    r"|stomp\w*|stamp\w*"
)
HIGH_BOTH = (
    r"high knees|knees (?:up|high)|goose ?step|high ?step\w*|both (?:knees|legs|feet)"
    r"|alternat\w* (?:kick|knee|leg)"
)

POSTURE_STATES = (  # posture name -> words that somebody is or gets into it
    (
        "upside down",
        (
            r"cartwheel\w*|hand ?stands?\b|hand ?spring\w*|(?:back|front|side)? ?flips?\b(?! (?:around"
            r"|a coin|the|over))|somersault\w*|upside down|head ?stand|aerial\b"
        ),
    ),
    (
        "crawling",
        (
            r"\bcrawl\w*|all fours|hands and knees|push ?ups?\b|\bplank\b|bear walk|cat pose|scrambl\w+ on"
            r"|mountain climber\w*"
        ),
    ),
    (
        "kneeling",
        (
            r"\bkneel\w*|\bknelt\b|(?:on|to|onto) (?:one|a|his|her|the|both|their|left|right|its)(?: left"
            r"| right)? knees?\b|genuflect\w*|tak\w+ a knee|propos(?:e|es|ing)\b|knees on the"
        ),
    ),
    (
        "lying",
        (
            r"\b(?:lie|lies|lay|lays|lying|laid)\b(?! ups?\b)(?! (?:\w+ )?(?:bricks?|hands|the|a|his|her"
            r"|something|low)\b| back\b)|\bfall(?:s|ing)?\b(?! (?:in|into|back into"
            r"|asleep standing))(?: (?:\w+ )?(?:down|over|flat|to the (?:ground|floor)|on))?|\bfell\b"
            r"|collaps\w*|knocked (?:down|out|over)|\bsleep\w*|on (?:the|his|her|their) (?:back|stomach"
            r"|belly|side of|floor)\b|\bprone\b|supine|faint\w*|\bsit ?ups?\b|\bdies?\b|\bdying\b"
        ),
    ),
    (
        "sitting",
        (
            r"\bsit\b(?! ?ups?)|\bsits\b(?! ?ups?)|\bsitting\b|\bsat\b|\bseats?\b|\bseated\b|tak\w+ a seat"
            r"|cross ?legged|(?:from|off|out of|on|onto|into) (?:a|the|his|her|their) (?:\w+ )?(?:armchair"
            r"|chair|stool|bench|sofa|couch)\b"
        ),
    ),
    (
        "crouching",
        (
            r"\bsquat\w*|\bcrouch\w*|\bduck(?:s|ing|ed)?\b|knee bends?|bent knees|low stance"
            r"|bend\w* (?:the|his|her|their|both|at the) knees|hunker\w*|\blung(?:e|es|ing)\b|sneak\w*"
            r"|horse stance|limbo"
        ),
    ),
    (
        "bent",
        (
            r"(?<!with )(?<!draw )(?<!the )(?<!a )(?<!holding )(?<!lower )(?<!raise )\bbow(?:s|ing"
            r"|ed)?\b(?! (?:and arrow|string|tie))|tak\w+ a bow|bend\w* (?:\w+ )?(?:over|forward|down"
            r"|at the waist|the upper body|his upper body|her upper body)|lean\w* (?:far "
            r"|deep(?:ly)? )?(?:forward|over|down)|touch\w* (?:the |his |her |their )?(?:toes|floor"
            r"|ground)|toe touch\w*|stoop\w*|hunch\w*"
        ),
    ),
    ("standing", r"\bstand(?:s|ing)?\b(?! (?:up|back up))|\bstood\b(?! up)|upright"),
)
DOWN_WORDS = (
    r"sits? down|sitting down|sat down|lies? down|lying down|lay(?:s|ing)? down"
    r"|kneels?(?: down)?\b|\bknelt|to (?:one|his|her|the|both|their) knees?|falls?\b|fell\b"
    r"|collaps\w*|tak\w+ a (?:seat|knee)|gets? down|getting down|goes? down|drop\w* (?:down|to)"
    r"|lower\w* (?:himself|herself|themselves|down|to)|faint\w*|knocked (?:down|out|over)|dies"
    r"|faints|sits on|sits\b|sit on|sit\b|lie on|lies on|dying|genuflect\w*|squats? down"
    r"|crouch\w* down|propose\w*"
)
DIP_POSTURES = frozenset({"crouching", "bent"})  # gone into and out of again, unless it is said to stay
STAY_WORDS = (
    r"(?:stay|remain|keep|wait|rest)\w* (?:\w+ )?(?:low|down|crouch\w*|bent|squat\w*|there)\b"
    r"|hunkered|crouch\w* (?:idle|pose)|hold\w* (?:a|the) (?:squat|crouch|bow|lunge)\w*"
)
CROUCHED = (
    r"(?:crouched|crouching|squatting|ducked|duck) (?:walk|step|run|mov)\w*|(?:walk|step|run|mov"
    r"|sneak|creep)\w* (?:\w+ ){0,2}(?:in a (?:\w+ )?(?:crouch|squat)|crouch\w*|bent over)"
)
HANDS_LOW = (
    r"pick\w*(?: \w+){0,4} (?:up|off|from)\b|pick ?up|(?:from|on|to|off) the (?:floor|ground)"
    r"|touch\w* (?:the |his |her |their )?(?:toes|floor|ground)|toe touch\w*|scoop\w*|\bmop\w*"
    r"|handstand|cartwheel|crawl|push ?up|all fours|hands and knees|tie\w* (?:\w+ )?(?:shoe"
    r"|lace)\w*|deadlift\w*|lift\w* (?:\w+ )?(?:box|crate|object|weight)\w*(?: \w+)? (?:from|off)"
    r"|weed\w*|plant\w* (?:a|the|some) (?:seed|flower|tree)"
)
PICK = r"pick\w*(?: \w+){0,4} (?:up|off|from)\b|pick ?up|scoop\w*|tie\w* (?:\w+ )?(?:shoe|lace)\w*|deadlift\w*"
CLAPS = r"\bclap\w*|applau\w*"
TOGETHER = (
    r"hands (?:\w+ )?together|\bpray\w*|palms together|clasp\w*|rub\w* (?:the |his |her "
    r"|their )?hands|hands meet"
)
LEANS = (
    r"(?<!with )(?<!draw )(?<!the )(?<!a )(?<!holding )(?<!lower )(?<!raise )\bbow(?:s|ing"
    r"|ed)?\b(?! (?:and arrow|string|tie))|tak\w+ a bow|bend\w* (?:\w+ )?(?:over|forward"
    r"|at the waist|the upper body)|lean\w* (?:far |deep(?:ly)? |way )?(?:forward|over)"
    r"|touch\w* (?:the |his |her |their )?toes|toe touch\w*|stoop\w*|hunch\w*|deadlift\w*"
    r"|pick\w*(?: \w+){0,4} (?:up|off)\b"
)

JUMPS = (
    r"\bjump\w*|\bleap\w*|\bhop(?:s|ping|ped)?\b|\bbound(?:s|ing)?\b|\bvault\w*|jumping ?jacks?"
    r"|star ?jumps?|skip\w* rope|rope skip\w*|\bdunk\w*|\bspring(?:s|ing)? (?:up|into)"
)
NO_JUMP_ACTIONS = frozenset(
    {"stand", "walk", "march", "sneak", "lie", "crawl", "kneel", "bow", "clap", "wave", "pick up"}
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
    r"|jumping jacks|lunges|bounces|swings)\b|\b(?P<w>once|twice|thrice)\b)"
)
STEPS_IN_PLACE = (
    r"(?:march|walk|jog|run|step|sprint)\w* (?:in place|on the spot)|treadmill|running on the spot"
    r"|stair ?master"
)

ACTIONS = {
    "jumping jack": r"jumping ?jacks?|star ?jumps?",
    "cartwheel": r"cartwheel\w*",
    "flip": (r"flips?\b|somersault\w*|hand ?spring\w*|hand ?stand\w*|acrobat\w*|break ?danc\w*|\broll(?:s"
r"|ing)?\b(?! (?:the|his|her|their|a|up|ball|dice|dough|shoulder|out))"),
    "crawl": r"\bcrawl\w*|all fours|hands and knees",
    "kick": r"\bkick\w*|roundhouse",
    "punch": (r"\bpunch\w*|\bjab\w*|\bbox(?:er|ing|es)\b(?! up)|uppercut|\bhooks?\b(?! shot)|shadow ?box\w*"
r"|\bfists?\b"),
    "fight": (r"\bfight\w*|karate|kung ?fu|martial|taekwondo|\bspar\w*|\bblocks?\b|fencing|\bkata\b|sword\w*"
r"|\bslash\w*"),
    "throw": (r"\bthrow\w*|\btoss\w*|\bpitch\w*|\bhurl\w*|\blob(?:s|bing)?\b|\bpass(?:es)? (?:a|the) ball"
r"|chest pass|\bfling\w*|\bcatch\w*"),
    "wave": r"\bwav(?:e|es|ing|ed)\b(?! (?:the |a )?sword)|\bgreet\w*|\bhail\w*|goodbye|\bhello\b|\bbeckon\w*",
    "clap": CLAPS,
    "basketball": r"basketball|dribbl\w*|lay ?up|jump ?shot|free throw|dunk\w*|hook shot|\bhoop\b",
    "tennis": r"tennis|forehand|backhand|racket|racquet|badminton|\bvolley\b|\bserv(?:e|es|ing)\b",
    "golf": r"\bgolf\w*|\bputt(?:s|ing)?\b|baseball|\bbat(?:s|ting|ter)?\b|\bswing\w* (?:a|the) (?:club|bat)",
    "dance": (r"\bdanc\w*|salsa|ballet|waltz\w*|charleston|pirouett\w*|\btwist (?:dance|and shout)"
r"|chicken dance|macarena|\bjig\b|hip ?hop|\bdisco\b|\btango\b|cha ?cha|moonwalk"),
    "march": r"\bmarch\w*|goose ?step|high knees",
    "stairs": r"\bstairs?\b|staircase|upstairs|downstairs|ladder|\bclimb\w*|step ?ladder",
    "hop": r"\bhop(?:s|ping|ped)?\b|one ?legged jump",
    "jump": r"\bjump\w*|\bleap\w*|\bbound(?:s|ing)?\b|\bvault\w*",
    "run": r"\brun(?:s|ning)?\b(?! (?:a |his |her |their )?(?:hand|finger|comb))|\bran\b|\bsprint\w*|\bdash\w*",
    "jog": r"\bjog\w*|\btrot\w*",
    "sneak": r"\bsneak\w*|\bcreep\w*|\btip ?toe\w*|stealth\w*",
    "sidestep": r"side ?step\w*|sideways|shuffl\w*|strafe?\w*|strafing|grapevine",
    "swim": r"\bswim\w*|breast ?stroke|front crawl",
    "pick up": PICK,
    "push": (r"\bpush(?! ups?\b)\w*|\bpull\w*|\bcarr(?:y|ies|ying)\b|\bdrag\w*|\blift\w* (?:\w+ )?(?:box"
r"|crate|weight|object)\w*|deadlift\w*|\bshov(?:e|es|ing)\b"),
    "kneel": r"\bkneel\w*|\bknelt\b|on(?:e|to)? (?:his |her |one |both )?knees?\b|genuflect\w*",
    "lie": (r"\b(?:lie|lies|lying|lay|lays)\b(?! (?:\w+ )?(?:brick|hand))|\bfall(?:s|ing)?\b|\bfell\b"
r"|collaps\w*|\bsleep\w*|\bfaint\w*"),
    "sit": (r"\bsit(?:s|ting)?\b|\bsat\b|\bseat(?:s|ed)?\b|stands? up\b|gets? up\b|standing up"
r"|get(?:ting)? up\b|\brises?\b"),
    "bow": (r"(?<!with )(?<!draw )(?<!the )(?<!a )(?<!holding )(?<!lower )(?<!raise )\bbow(?:s|ing"
r"|ed)?\b(?! (?:and arrow|string|tie))|tak\w+ a bow|bend\w* (?:over|forward|at the waist)"
r"|\bcurts\w*"),
    "squat": r"\bsquat\w*|\bcrouch\w*|\bduck(?:s|ing)?\b|knee bends?|\blung(?:e|es|ing)\b",
    "stretch": r"\bstretch\w*|\bexercis\w*|warm(?:s|ing)? ?up|\byoga\b|tai ?chi|\bcalisthenics|push ?ups?|sit ?ups?",
    "manipulate": (r"\bdrink\w*|\beat(?:s|ing)?\b|\bscrew\w*|\bhammer\w*|\bsaw(?:s|ing)?\b|\bmop\w*|\bsweep\w*"
r"|\bwash\w*|\bclean\w*|\bwip(?:e|es|ing)\b|\bpaint\w*|\bstir\w*|\bcook\w*|\bphone\b"
r"|\bwrit(?:e|es|ing)\b|\btyp(?:e|es|ing)\b|umbrella|wrench|\bdrill\w*|\bvacuum\w*|\brake\w*"
r"|\bdig(?:s|ging)?\b|\bopen(?:s|ing)?\b|\bclos(?:e|es|ing)\b|\bpour\w*"),
    "gesture": (r"\bpoint(?:s|ing)?\b|\bgestur\w*|\bdirect\w*|\btalk\w*|\bsalut\w*|\bshrug\w*|\bsignal\w*"
r"|\bconduct\w*|\bscratch\w*|\bnod\w*|\bconvers\w*|\bexplain\w*|\bargu\w*|\blaugh\w*|\bcry\w*"
r"|\bcheer\w*"),
    "imitate": (r"\bmonkey|\bbear\b|\bchicken\b|\bdinosaur|\bcat\b|\belephant|\bsnake|\bzombie|\bgorilla"
r"|\bpenguin|\bdrunk\w*|\banimal\b|\bpirate\b|\bmummy\b"),
    "turn": r"\bturn(?:s|ing|ed)?\b|about ?face|\bpivot\w*|\brotat\w*|\bspin\w*|\btwirl\w*|\bu ?turn",
    "walk": (r"\bwalk\w*|\bstroll\w*|\bstrid(?:e|es|ing)\b|\bwander\w*|\bsaunter\w*|\bstrut\w*|\blimp\w*"
r"|\bstagger\w*|\btrudg\w*|\bpac(?:es|ing)\b|\bhik\w+|\bsteps?\b|\bstepping\b|\bhobbl\w*"
r"|\bswagger\w*"),
    "stand": r"\bstand(?:s|ing)?\b|\bidl(?:e|es|ing)\b|\bwait\w*|motionless|\bstill\b",
}  # fmt: skip

MOVES = {  # how much arms, legs and trunk move in an action, 1 still to 4 very much; 0 unknown
    "jumping jack": (4, 3, 0), "kick": (0, 3, 0), "punch": (4, 0, 0), "throw": (3, 0, 3), "wave": (3, 0, 0),
    "basketball": (3, 0, 0), "dance": (3, 3, 0), "march": (0, 3, 0), "run": (4, 4, 0), "jog": (3, 4, 0),
    "walk": (0, 3, 0), "swim": (4, 0, 0), "gesture": (3, 0, 0),
}  # fmt: skip
GAITS = frozenset({"walk", "run", "jog", "sneak", "march", "crawl", "sidestep"})
ALONE_WITH = frozenset(
    {"turn", "walk", "run", "jog", "sneak", "march", "crawl"}
)  # an action that leaves a gait's speed as it is
SEVERAL_CLAUSES = r",|;|\.(?! ?$)|\bthen\b|\bbefore\b|\bafter\b|\buntil\b|\bfinally\b"
TURN_WORDS = (
    r"\b(?:turn|rotat|pivot|veer|swerv|swivel|spin|twirl|whirl|about ?face|u turn|circl|curv"
    r"|revers|twist|swing)\w*|clockwise"
)

TURN_VERBS = r"\b(?:face|faces|facing|wheel|go|goes|take|takes|make|makes|hard)\b"
SEVERAL_PARTS = SEVERAL_CLAUSES + r"|\band\b"
WARD = r"\b(?P<side>left|right)ward"
ANY_SIDE = r"\b(?P<side>left|right)(?:wards?)?\b"
MOVES_ON = JUMPS + r"|\bstep\w*|\bmov\w*|\blung\w*|\bcrawl"
STEPS_OR_TURNS = r"\b(?:step|mov|turn|approach|spin)\w*"
FROM = r"\b(?:from|off|out)\b"  # one rises from what is named behind it
RISES = r"\b{rise}"
MANY_JUMPS = r"hopping|hops|jacks?\b|bounding|rope|jump\w* (?:around|on the spot|along)\b"
LEG_ACTS = r"\b(?:kick|hop|lunge|stomp|balanc)\w*"
ARM_ACTS = r"\b(?:{armact}|{hand})\b|punch|throw|wav|rais"
PAIR = r"both|two|arms|hands"
PAIR_WAVES = r"both|two|arms wav|wav\w* (?:\w+ )?(?:arms|hands)"
