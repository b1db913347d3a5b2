"""Arms, legs and hands."""

from __future__ import annotations

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
            r"|shoot\w* (?:a |the |some )?(?:basket|basketball|hoops?|three pointer|free throw)s?\b"
            r"|jump ?shot|free throw|cheer\w*|overhead clap|hail\w*|sun salutation|y pose|victory"
            r"|\breach\w* (?:up|overhead|upwards?)\b (?:\w+ ){0,2}(?:both|hands|arms)\b|\bstretch\w* up\b"
        ),
    ),
    (
        "one",
        (
            r"\breach\w* (?:up|overhead|upwards?)\b(?! (?:and|to) (?:grab|touch|get))|"
            r"\bwav(?:e|es|ing|ed)\b(?! (?:\w+ )?(?:arms|hands|the sword|a sword|sword|his arms|her arms"
            r"|a stick))|\bhand up\b|\barm up\b|{up} (?:up )?{the}(?:left |right )?(?:arm|hand"
            r"|fist)(?: straight)? {high}|(?:rais|lift)\w* (?:up )?{the}(?:left |right )?(?:arm|hand"
            r"|fist)\b(?! (?:to the (?:side|front)|forward|out|in front))|(?:left|right) (?:arm|hand"
            r"|fist) (?:(?:is|being|was) )?(?:\w+ )?(?:up\b|overhead|high|raised|in the air|above)"
            r"|salut\w*|tennis serve"
            r"|\bserv(?:e|es|ing)\b|overhand|hook shot|lay ?up|\bdunk\w*|hailing|(?:arm|hand|fist) raised"
            r"|high ?five\w*|(?:arm|hand|fist) (?:\w+ )?(?:up\b|aloft)|pitch(?:es|ing)? (?:a|the) ball"
            r"|spik\w+ (?:a|the) ball"
        ),
    ),
    (
        "none",
        (
            r"^(?:(?:the|a|he|she|they|person|man|woman|someone|somebody|figure) ){0,3}(?:lower"
            r"|drop)\w* (?:{the2}(?:left |right )?(?:arms?|hands?)|them|it)\b(?! (?:to the floor"
            r"|on))(?!.*(?:,|\band\b|\bthen\b))"
            r"|(?:arms|hands) (?:hanging |down |still |resting |held )?(?:at|by|down to) {the2}sides?\b"
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
    r"hands (?:\w+ )?together|\bpray\w*|palms together|clasp\w*|wash\w* (?:the |his |her |their )?hands"
    r"|rub\w* (?:the |his |her "
    r"|their )?hands|hands meet"
)

LEANS = (
    r"(?<!with )(?<!draw )(?<!the )(?<!a )(?<!holding )(?<!lower )(?<!raise )\bbow(?:s|ing"
    r"|ed)?\b(?! (?:and arrow|string|tie))|tak\w+ a bow|bend\w* (?:\w+ )?(?:over|forward"
    r"|at the waist|the upper body)|lean\w* (?:far |deep(?:ly)? |way )?(?:forward|over)"
    r"|touch\w* (?:the |his |her |their )?toes|toe touch\w*|stoop\w*|hunch\w*|deadlift\w*"
    r"|pick\w*(?: \w+){0,4} (?:up|off)\b"
)

LEG_ACTS = r"\b(?:kick|hop|lunge|stomp|balanc)\w*"

ARM_ACTS = r"\b(?:{armact}|{hand})\b|punch|throw|wav|rais"

PAIR = r"both|two|arms|hands"

PAIR_WAVES = r"both|two|arms wav|wav\w* (?:\w+ )?(?:arms|hands)"
