"""Classes of plain actions, and how much of the body each moves."""

from __future__ import annotations

from motionrt.text.lexicon.limbs import CLAPS, PICK

ACTIONS = {
    "jumping jack": r"jumping ?jacks?|star ?jumps?",
    "cartwheel": r"cartwheel\w*",
    "flip": (r"flips?\b|somersault\w*|hand ?spring\w*|hand ?stand\w*|acrobat\w*|break ?danc\w*|\broll(?:s"
r"|ing)?\b(?! (?:the|his|her|their|a|up|ball|dice|dough|shoulder|out))"),
    "crawl": r"\bcrawl\w*|all fours|hands and knees",
    "kick": r"\bkick\w*|roundhouse",
    "punch": (r"\bpunch\w*|\bjab\w*|\bbox(?:er|ing|es)\b(?! up)|uppercut|\bhooks?\b(?! shot)|shadow ?box\w*"
r"|(?:left|right) cross\b(?! ?(?:legged|ed))|\bfists?\b(?! (?:\w+ ){0,2}(?:in the air|up\b|high|raised"
r"|overhead|above))"),
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
    "hop": r"\bhop(?:s|ping|ped)?\b|\bskip(?:s|ping|ped)?\b(?! (?:a step|the))|one ?legged jump",
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
r"|\bswagger\w*|\bstumbl\w*"),
    "stand": r"\bstand(?:s|ing)?\b|\bidl(?:e|es|ing)\b|\bwait\w*|motionless|\bstill\b",
}  # fmt: skip

MOVES = {  # how much arms, legs and trunk move in an action, 1 still to 4 very much; 0 unknown
    "jumping jack": (4, 3, 0), "kick": (0, 3, 0), "punch": (4, 0, 0), "throw": (3, 0, 3), "wave": (3, 0, 0),
    "basketball": (3, 0, 0), "dance": (3, 3, 0), "march": (0, 3, 0), "run": (4, 4, 0), "jog": (3, 4, 0),
    "walk": (0, 3, 0), "swim": (4, 0, 0), "gesture": (3, 0, 0),
}  # fmt: skip


ALONE_WITH = frozenset(
    {"turn", "walk", "run", "jog", "sneak", "march", "crawl"}
)  # an action that leaves a gait's speed as it is
