"""Postures, risings and jumps."""

from __future__ import annotations

NOT_POSTURES = (  # what falls, rises or stands is a limb
    r"{limbs} (?:\w+ ){0,2}?(?:fall|ris|drop|lower|stand|lie|rest)\w*(?: (?:down|up|to|from))?",
    r"let\w* (?:\w+ ){1,4}?(?:fall|drop)\w*|dead hang|falls? (?:back )?(?:in|into|behind|asleep standing)",
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
            r"\b(?:lie|lies|lay|lays|lying|laying|laid)\b(?! ups?\b)(?! (?:down )?(?:bricks?|hands|the|a"
            r"|an|his|her|some"
            r"|something|low|out)\b| back\b)|\bfall(?:s|ing)?\b(?! (?:in|into|back into"
            r"|asleep standing))(?: (?:\w+ )?(?:down|over|flat|to the (?:ground|floor)|on))?|\bfell\b"
            r"|collaps\w*|knocked (?:down|out|over)|\bsleep\w*|on (?:the|his|her|their) (?:back|stomach"
            r"|belly|side of)\b|{unseated}on (?:the|his|her|their) floor\b|\bprone\b|supine"
            r"|faint\w*|\bsit ?ups?\b|\bdies?\b|\bdying\b"
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
            r"\bsquat\w*|\bcrouch\w*|\bduck(?:s|ing|ed)?\b|knee bends?|\bknees bend\w*|bent knees|low stance"
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
    r"(?:go|went|get|got|drop|sink|sank|lower|slump|settl|eas|flop|plop|slid|com|mov)\w* (?:\w+ ){0,3}?"
    r"(?:on|onto|to|into|in) (?:\w+ ){0,3}?"
    r"(?:knees?|fours|seat|chair|stool|bench|couch|sofa|floor|ground|stomach|belly|back)\b"
    r"|sits? down|sitting down|sat down|lies? down|lying down|lay(?:s|ing)? down"
    r"|kneels?(?: down)?\b|\bknelt|to (?:one|his|her|the|both|their) knees?|falls?\b|fell\b"
    r"|falling\b|\bdie\b|collaps\w*|tak\w+ a (?:seat|knee)|gets? down|getting down|goes? down|drop\w* (?:down|to)"
    r"|lower\w* (?:himself|herself|themselves|down|to)|faint\w*|knocked (?:down|out|over)|dies"
    r"|faints|(?<!is )sits on|(?<!is )sits\b|sit on|sit\b|lie on|lies on|\blie (?:flat|face|still)|dying"
    r"|genuflect\w*|squats? down"
    r"|crouch\w* down|propose\w*"
)

DIP_POSTURES = frozenset({"crouching", "bent"})  # gone into and out of again, unless it is said to stay

STAY_WORDS = (
    r"(?:stay|remain|keep|wait|rest)\w* (?:\w+ )?(?:low|down|crouch\w*|bent|squat\w*|there)\b"
    r"|\bstays crouched\b|hunkered|crouch\w* (?:idle|pose)|hold\w* (?:a|the) (?:squat|crouch|bow|lunge)\w*"
)

CROUCHED = (
    r"(?:crouch(?:ed|ing)?|squatting|ducked|duck) (?:walk|step|run|mov)\w*|(?:walk|step|run|mov"
    r"|sneak|creep)\w* (?:\w+ ){0,2}(?:in a (?:\w+ )?(?:crouch|squat)|crouch\w*|bent over)"
)

JUMPS = (
    r"\bjump\w*|\bleap\w*|\bhop(?:s|ping|ped)?\b|\bbound(?:s|ing)?\b|\bvault\w*|jumping ?jacks?"
    r"|star ?jumps?|\bskip(?:s|ping|ped)?\b(?! (?:rope|a step|the))|skip\w* rope|rope skip\w*|\bdunk\w*"
    r"|\bspring(?:s|ing)? (?:up|into)"
)

NO_JUMP_ACTIONS = frozenset(
    {"stand", "walk", "march", "sneak", "lie", "crawl", "kneel", "bow", "clap", "wave", "pick up"}
)

MOVES_ON = JUMPS + r"|\bstep\w*|\bmov\w*|\blung\w*|\bcrawl|\bcarr(?:y|ies)|\bdrag"

FROM = r"\b(?:from|off|out)\b"  # one rises from what is named behind it

RISES = r"\b{rise}"

MANY_JUMPS = r"hopping|hops|\bskip(?:s|ping)?\b|jacks?\b|bounding|rope|jump\w* (?:around|on the spot|along)\b"
