"""What people say in other words, and the plain words for it that the rest of the lexicon and the networks know."""

from __future__ import annotations


def _as(verbs: str, plain: str, going: str, behind: str = "") -> tuple[tuple[str, str], ...]:
    """Verbs, written with their endings in brackets, for which one plain verb stands, and its form in -ing."""
    each = verbs.split()
    now = "|".join(verb.replace("(", "(?:").replace(")", ")?") for verb in each)
    ing = "|".join(_going(verb) for verb in each)
    return (rf"\b(?:{now})\b{behind}", plain), (rf"\b(?:{ing})\b{behind}", going)


def _going(verb: str) -> str:
    """``scurr(y|ies)`` -> ``scurr...ing``: the stem with every way of writing its -ing."""
    stem = verb.split("(", maxsplit=1)[0]
    return rf"{stem.removesuffix('e')}\w?ing"


_POSSESSED = r"(?:(?:the|a|an|his|her|their|its) )?"
_WAY = (
    r"(?= (?:\w+ly )?(?:forwards?|away|off|ahead|on|down|across|along|past|towards?|out|around|through"
    r"|over|up|home|from|to)\b"
    r"|$|,| as | very | really | in (?:panic|terror|fear|a hurry)\b| for (?:the |his |her |their )?(?:life"
    r"|lives|dear life)\b)"
)
_LIGHT = (
    r"(?:(?:a|an|one|some|the|his|her|their) )?(?:quick |big |small |little |good |nice |hard |high |low "
    r"|deep |fast |strong )*"
)

WORDING: tuple[tuple[str, str], ...] = (
    # how it is written
    (r"\bw (?=(?:a|an|the|his|her|both|left|right)\b)", "with "),
    (r"\b(\w{3,}in)'(?!\w)", "$1g"),
    (r"\b(?:your|my|our|ur|one's|its)\b", "the"),
    (r"\b(from|off|on|to|onto|against|of)(?= (?:floor|ground|chair|sofa|bench|bed|stairs)\b)", "$1 the"),
    (
        r"\b(?:man|woman|boy|girl|guy|person) (?:is|are|be) (?=(?:go|walk|run|turn|jump|sit|stand|kick"
        r"|raise)\b)",
        "person ",
    ),
    (r"\bon all 4s\b", "on all fours"),
    (r"\b(\d+) ?(?:deg|degs|°)(?!\w)", "$1 degrees"),
    # where somebody looks is no way
    (
        r"\b(?:(?:while|still|and|but|always|stay\w*|keep\w*) )*facing (?:forwards?|ahead|front|the front"
        r"|the same way)\b",
        "",
    ),
    (r"\btowards? (?:the |his |her |their )?(left|right)\b", "to the $1"),
    (r"\b(left|right)wards?(?=$|,|\.| (?:and|then|while|by|in|for|with|on)\b)", "to the $1"),
    (r"\b(in place|on the spot), (?=to the (?:left|right)\b)", "$1 "),
    (
        r"\bon (?:the |his |her |one )?(?:heels?|toes?|balls?(?: of (?:the |his |her )?(?:foot"
        r"|feet))?)(?= (?:to the )?(?:left|right)\b)",
        "",
    ),
    (r"\bto (?:the |his |her |their )?(left|right)(?: hand)? side\b", "to the $1"),
    (r"\btowards? (?:the )?(sky|ceiling|stars)\b", "to the $1"),
    (r"\bpalm\b", "hand"),
    (r"\btread(?:s|ing)? (?=carefully|softly|lightly|slowly|gingerly)", "walks "),
    (r"\bcrab ?wise\b", "sideways"),
    # to get on
    (
        r"\b(?:comes?|coming) (?:\w+ly )?(?:closer|nearer|near|over|here|forwards?|along|this way"
        r"|towards? (?:us|me|him|her|them|the \w+))\b"
        r"|\b(?:goes|go|going|carries|carrying|keeps|keeping) (?:on|along|off|away|going)(?= and\b| then\b|,|\.|$)"
        r"|\b(?:draws? near|makes? (?:the |his |her |their )way|sets? (?:off|out)|departs?|heads? off"
        r"|gets? going|moves? (?:along|off|away|on))\b"
        r"|\b(?:cross(?:es|ing)?|travers(?:e|es|ing)) (?:the )(?:room|street|road|floor|stage|hall|field|bridge)\b"
        r"|\bis (?:out|off) (?:for|on) a (?:stroll|walk|hike)\b",
        "walks forward",
    ),
    *_as("hasten(s) hurr(y|ies)", "walks fast", "walking fast", _WAY),
    (
        r"\b(?:withdraws?|withdrawing|recoils?|recoiling|backtracks?|backtracking|gives? ground|shrinks? (?:back|away)"
        r"|(?:edg|inch)(?:es|e|ing) (?:back|backwards?|away)|draws? back)\b",
        "walks backward",
    ),
    (r"\b(?:edg|inch)(?:es|e|ing) (?=(?:\w+ )?(?:to the )?(?:left|right|sideways)\b)", "sidesteps "),
    (r"\bshifts? (?=to the (?:left|right)\b)", "steps "),
    (r"\bstalk(?:s|ing)?\b", "sneaks"),
    (r"\bside ?straddle hops?\b", "jumping jacks"),
    (r"\b(?:rounds?|rounding) (?:the|a) (?:corner|bend)\b", "turns at the corner"),
    (r"\bstamp(?:s|ing)? (?:the |his |her |their )?feet\b(?= (?:in place|on the spot|like))", "marches"),
    *_as("rush(es) dart(s) charge(s) barrel(s) sprint(s)", "runs", "running", _WAY),
    (r"\bpaces?(?= (?:to the|back|forward|left|right|backwards?|ahead)\b)", "steps"),
    (r"\bback ?steps?\b", "steps backward"),
    (r"\bsteps? aside\b", "steps to the side"),
    (r"\bdrag(?:s|ging)? (?:the |his |her |their )?feet\b|\bdawdl(?:e|es|ing)\b", "walks slowly"),
    (
        r"\b(?:go|goes|going|walks?|walking|runs?|heads?|comes?|moves?) (up|down) (?:(?:the |a "
        r"|some )(?:\w+ )?)?(?:steps|staircase|stairway|flight of steps)\b",
        "climbs $1 the stairs",
    ),
    (
        r"\b(?:ascend(?:s|ing)?|mount(?:s|ing)?) (?:the |a |some )?(?:steps|stairs|staircase|ladder)\b",
        "climbs up the stairs",
    ),
    (r"\b(?:descend(?:s|ing)?) (?:the |a |some )?(?:steps|stairs|staircase|ladder)\b", "climbs down the stairs"),
    (r"\bmark(?:s|ing)? time\b", "marches in place"),
    *_as("bolt(s) scamper(s) scurr(y|ies) hurtle(s) pelt(s) zoom(s) race(s) flee(s) scram(s)", "runs", "running", _WAY),
    *_as("hare(s) hightail(s) skedaddle(s) stampede(s) gallop(s)", "runs", "running"),
    (r"\b(?:legs?|hightails?|beats?|books?) it\b", "runs"),
    (r"\b(?:takes?|taking|sets?|setting) off (?:running|at a run|sprinting)\b", "runs"),
    (r"\b(?:breaks?|breaking) into a (run|sprint|jog)\b", "$1s"),
    (r"\bat a (run|jog|sprint|trot)\b", "$1"),
    *_as(
        "mosey(s) trek(s) tramp(s) traipse(s) promenade(s) meander(s) parade(s) toddle(s) patrol(s) roam(s)"
        " amble(s) ramble(s) sashay(s) lumber(s) waddle(s)",
        "walks",
        "walking",
    ),
    (r"\b(?:power|speed|race) ?walk(s|ing)?\b", "walk$1 fast"),
    (r"\b(?:takes?|taking|goes for|going for|has|having) an? (?:\w+ )?(walk|run|jog|stroll)\b", "$1s"),
    (
        r"(?<!without )(?<!not )(?<!never )\b(?:go|goes|going|proceeds?|proceeding|progress(?:es)?|heads?"
        r"|heading|travels?|travelling"
        r"|moves?|moving|continues?)"
        r" (\w+ly )?(?:on )?(?=forwards?\b|ahead\b|straight\b|backwards?\b|in reverse\b|onwards?\b)",
        "walks $1",
    ),
    (
        r"(?<!in )(?<!a )(?<!the )\brevers(?:es?|ing)\b(?=$| (?:slowly|quickly|carefully|cautiously|gently|fast|one|two"
        r"|three|four|five|\d|a (?:few|couple|little|bit|short|meter|metre|step)|away|out|from|straight|gradually)\b)",
        "walks backward",
    ),
    (r"\b(?:in|to|into|towards?) (?:the )?(forward|backward)s? direction\b", "$1"),
    *_as("prowl(s) skulk(s) slink(s)", "sneaks", "sneaking"),
    (
        r"\b(?:stealth|sneaky) (?:walk|mov|run)\w*|\b(?:walks?|walking|moves?|moving) (?:stealthily|sneakily"
        r"|furtively)\b",
        "sneaks",
    ),
    (
        r"\b(?:dodg(?:es?|ing)|evad(?:es?|ing)|swerves? aside|jinks?) (?=(?:to )?(?:the |his |her )?(?:left"
        r"|right)\b)",
        "sidesteps ",
    ),
    *_as(
        "sidle(s) scuttle(s)", "sidesteps", "sidestepping", r"(?= (?:\w+ )?(?:left|right|sideways|across|along|to)\b)"
    ),
    (
        r"\b(?:side|sideways) (?:shuffl|walk|stepp|gallop)(?:e|es|ing|s)\b|\b(?:walks?|walking|steps?"
        r"|moves?) (?:\w+ )?sidewards?\b",
        "sidesteps",
    ),
    (r"\bcrab ?walks?\b|\bwalks? like a crab\b", "sidesteps"),
    # to turn
    (
        r"\b(?:hang|hangs|hanging|bang(?:s|ing)?|hook(?:s|ing)?|pull(?:s|ing)?|chuck(?:s|ing)?|mak(?:es?"
        r"|ing)|tak(?:es?|ing)|do(?:es|ing)?) an? (?:sharp |hard "
        r"|quick )?(left|right)\b(?! (?:hook|jab|cross|punch|kick|uppercut|step|turn|hand|foot|leg|arm|swing"
        r"|lunge|circle))",
        "turns $1",
    ),
    (r"\byaw(s|ed|ing)?\b", "rotate$1"),
    (r"\bslew(s|ing)?\b(?= (?:left|right|round|around))", "rotate$1"),
    (r"\b(?:chaine|fouette|spotting|barrel) turns?\b", "spins"),
    *_as("revolve(s) gyrate(s)", "spins", "spinning"),
    (r"\b(?:spins?|whirls?|wheels?|whips?|swings?) (?:a?round|about) (?=to (?:face|look))", "turns around "),
    (r"\b(?:hangs?|makes?|does|do|pulls?|bangs?|takes?) an? (?:u ?ie|uey|uturn|u ?turn)\b", "turns around"),
    (r"\bquarter(?: of a)? circle\b", "curve"),
    (r"\bthree[ -]sixty\b", "360"),
    (r"\b(?:one[ -]eighty|hundred (?:and )?eighty)\b", "180"),
    (r"\bninety\b", "90"),
    (
        r"\b(?:turns?|turning) (?:his|her|the|their) back\b|\bfaces? (?:backwards?|about|behind|the rear)\b",
        "turns around",
    ),
    (r"\bgo(?:es|ing)? (?:a?round)(?: and (?:a?round))? in (?:a )?circles?\b", "walks in a circle"),
    # to go down and up
    (
        r"\b(?:gets?|getting|got|climbs?|rises?|comes?) (?:up )?(?:out of|off) (?:of )?(?:the |a |his "
        r"|her |their )?(?:chair|seat|sofa|bench|stool|couch|armchair)\b",
        "stands up from the chair",
    ),
    (
        r"\b(?:gets?|getting|got|climbs?|rises?|comes?) (?:up )?(?:out of|off) (?:of )?(?:the |a |his "
        r"|her |their )?(?:bed|mattress|sleeping bag)\b",
        "gets up from lying on the floor",
    ),
    (r"\b(?:gets?|getting|drops?|dropping) down (?:on|to|onto) the (?:floor|ground)\b(?! (?:and|to))", "kneels down"),
    (r"\bwakes? up(?: and| then)?\b", ""),
    (r"\b(?:hid(?:e|es|ing)|cowers?|cowering|ducks? down|takes shelter)\b", "crouches"),
    *_as("prostrate(s) sprawl(s)", "lies down", "lying down", r"(?: (?:himself|herself|themselves))?"),
    (r"\b(?:has|have|having|grabs?|takes?|taking|finds?) (?:a |an )?(?:seat|sit down|pew)\b", "sits down"),
    (r"\b(?:has|have|having|takes?|taking) a (?:\w+ )?(?:lie(?: ?down)?|nap|snooze|sleep)\b", "lies down"),
    *_as("recline(s) snooze(s) nap(s)", "lies down", "lying down"),
    (
        r"\b(?:drops? dead|keels? over|pass(?:es)? out|plays? dead|hits? the (?:deck|dirt|floor|ground)"
        r"|bites? the dust|faceplants?)\b",
        "falls to the floor",
    ),
    (
        r"\b(?:takes?|taking|drops? (?:down )?(?:on)?to|gets? down on(?:to)?|goes down on(?:to)?|falls? to"
        r"|sinks? to) (?:a|one|the) knee\b",
        "kneels on one knee",
    ),
    (
        r"\b(?:gets?|getting|goes|going|go|drops?|sinks?|falls?|comes?) (?:down )?(?:on|onto"
        r"|to) (?:both )?(?:the |his |her |their )?(?:hands and knees|all fours)\b",
        "gets down on all fours",
    ),
    (
        r"\b(?:gets?|getting|goes|going|go|drops?|dropping|sinks?|falls?) (?:down )?(?:on|onto"
        r"|to) (?:both )?(?:the |his |her |their )?knees\b",
        "kneels down",
    ),
    (r"\b(?:prone|army|commando|belly|leopard|bear|military|low) (crawl(?:s|ing)?)\b", "$1"),
    (r"\bpli(?:e|es|eing)\b|\bdemi ?plie\b", "squats"),
    (
        r"\b(?:lower(?:s|ing)?|drop(?:s|ping)?|sink(?:s|ing)?) (?:the |his |her |their )?(?:pelvis|hips|bottom"
        r"|bum|butt|body|centre of gravity|center of gravity)\b(?! (?:on|onto|to the (?:floor|chair)))",
        "squats",
    ),
    (r"\b(?:gets?|getting|stays?|staying|drops?|dropping|keeps?|keeping) (?:down )?low\b", "crouches"),
    (r"\b(?:takes?|taking) cover\b", "crouches"),
    (
        r"\b(?:springs?|jumps?|leaps?|hops?|hauls? (?:himself|herself)|gets? back|rises?|rising|comes?|coming"
        r"|pushes (?:himself|herself)) (?:up )?(?:on)?to (?:the |his |her |their )?feet\b",
        "stands up",
    ),
    (r"\b(?:up|back) (?:on|onto) (?:the |his |her |their )?feet\b", "up"),
    (
        r"\b(?:leav(?:es|ing)|vacates?) (?:the |his |her |their )(?:chair|seat|bench|sofa|armchair|stool"
        r"|couch)\b",
        "stands up from the chair",
    ),
    (r"\bseats? (?:himself|herself|themselves|itself)\b", "sits down"),
    (r"\bscrambl(?:es?|ing) (?:on)?to (?:the |his |her |their )?feet\b", "gets up"),
    (
        r"\b(?:picks?|hauls?|pulls?|drags?|pushes) (?:himself|herself|themselves|itself) (?:back )?(?:up"
        r"|upright)\b",
        "gets up",
    ),
    (r"(?:^|(?<=then )|(?<=, ))rises?(?=$|,|\.| (?:then|again|and (?:walk|run|leav|turn)))", "stands up"),
    (r"\bfall(s|ing)? (?:over )?(?:backwards?|forwards?|sideways)\b", "fall$1 over"),
    (
        r"\b(?:topples?|tumbles?|crash(?:es)?|slumps?) (?:over|down|to the (?:floor|ground))\b"
        r"|\bdrops? to the (?:floor|ground)\b",
        "falls over",
    ),
    (r"\b(?:goes|going|go) to sleep\b|\bfalls? asleep\b", "lies down"),
    (
        r"\bhunched (?:low|down)\b|\b(?:dips?|dipping|sinks?|sinking) (?:down )?low\b|\b(?:on"
        r"|onto) (?:the |his |her |their )?haunches\b",
        "crouching",
    ),
    (r"\b(?:reach|lean)(?:es|s|ing)? down\b", "bends down"),
    (r"\b(?:doubl(?:es|ing) over|folds? forwards?|bends? at (?:the )?hips?)\b", "bends over"),
    (
        r"\b(?:takes?|taking|grabs?|grabbing|gets?|getting|fetch(?:es)?|collects?|retriev(?:es?|ing)"
        r"|gathers?|snatch(?:es)?|lifts?|lifting)"
        r"(?! (?:up|back|down|on|onto|to|off|out|in)\b)(?! (?:\w+ ){0,3}?(?:foot|feet|legs?|heels?|toes?"
        r"|knees?|hands?|body|hips?|himself|herself)\b)"
        r" ((?:\w+ ){1,4}?)(?:up )?(?:from|off|of) the (floor|ground)\b",
        "picks up $1from the $2",
    ),
    (
        r"\b(?:picks?|picking) (?:the |a |an )(\w+) (?:up )?(?:from|off) (?:of )?the (floor|ground)\b",
        "picks up a $1 from the $2",
    ),
    (
        r"\b(gets?|getting|stands?|standing|comes?|coming|rises?|rising|pops?|straightens?) (?:right "
        r"|straight )?back up(?:right)?\b",
        "$1 up",
    ),
    (r"\b(stands?|standing|rises?) up straight\b", "$1 up"),
    (r"\b(?:starting )?from (?:a )?(?:standing|upright|stand)(?: (?:pose|position|stance|posture))?\b(?! to)", ""),
    (r"\bsits?(?= (?:for (?:a|some)|there)\b)", "is sitting"),
    (
        r"\b(?:crouch|squat)(?:es|s)? (?:down )?(?:and|then) (?:holds?|stays?|waits?|remains?|freezes?)\b",
        "squats down and stays crouched",
    ),
    (
        r"\b(?:holds?|holding|keeps?|maintains?) (?:the |a |in )?(?:position|pose|stance)\b|\b(?:no"
        r"|zero) (?:motion|movement)\b|\bstays? put\b"
        r"|\b(?:does|do|doing) nothing\b",
        "stands still",
    ),
    (r"\bstands still(?:,? (?:and |with )?stands still)+", "stands still"),
    # jumps
    (
        r"\b(?:launch|propel)(?:es|s|ing)? (?:himself |herself |themselves )?(?:up(?:wards?)?|into the air"
        r"|off the (?:ground|floor))\b",
        "jumps up",
    ),
    (r"\b(?:hurdl(?:e|es|ing)|clears?) (?=(?:over |a |an |the ))", "jumps over "),
    (r"\bbounc(?:e|es|ing) (?=(?:\w+ )?on (?:one|the|his|her)(?: left| right)? (?:foot|leg)\b)", "hops "),
    (r"\bbounc(?:e|es|ing) (?:the |a )?(?:basket ?)?ball\b", "dribbles a basketball"),
    (
        r"\b(?:hop|jump|leap|bound)(s|ing|ping)? (?:around )?like an? (?:frog|kangaroo|rabbit|bunny)\b"
        r"|\bon (?:a )?(?:pogo stick|trampoline)\b",
        "jumps up and down",
    ),
    (r"\bleap ?frogs?\b", "jumps over"),
    (r"\b(?:bounc(?:e|es|ing)) (?=up and down|on the spot|in place|around)", "jumps "),
    (r"\b(?:skips?|skipping) (?:with a )?rope\b|\bjump(?:s|ing)? rope\b|\brope skipping\b", "jumps up and down"),
    (r"\b(?:standing )?(?:broad|long) jump\b", "jump forward"),
    (r"\b(?:bunny|frog) ?(?:hop|jump|leap)s?\b", "jump forward"),
    # arms
    (
        r"\b(?:put|puts|putting|hold|holds|holding|stick|sticks|sticking|throw|throws|thrusts?|shoots?"
        r"|rise|rises|rising"
        r"|hoists?|elevat(?:e|es|ing)|brings?|sticks?|lifts?|lifting) (?:up )?"
        rf"(?={_POSSESSED}(?:left |right |both )?(?:hands?|arms?|fists?) (?:up\b|high|in the air|overhead|above))",
        "raises ",
    ),
    (
        r"\b(?:put|puts|putting|hold|holds|holding|stick|sticks|sticking|throw|throws|thrusts?|shoots?"
        r"|rise|rises|rising"
        rf"|hoists?|elevat(?:e|es|ing)|brings?) up (?={_POSSESSED}(?:left |right |both )?(?:hands?|arms?|fists?)\b)",
        "raises ",
    ),
    (
        rf"\b(?:rise|rises|rising|elevat(?:e|es|ing)|hoists?) (?={_POSSESSED}(?:left |right |both )?(?:hands?"
        rf"|arms?|fists?)\b)",
        "raises ",
    ),
    (
        r"\b(?:reach(?:es|ing)?|stretch(?:es|ing)?) (?:up |upwards? )?(?:for|to|towards?) the (?:sky"
        r"|ceiling|stars|heavens|roof)\b",
        "reaches up",
    ),
    (r"\braises? the roof\b|\bpunch(?:es|ing)? the air\b", "raises both arms"),
    (
        r"\b(?:hit|hits|hitting|slap\w*|smack\w*|bang\w*|beat\w*|strik\w+) (?:the |his |her |their |both "
        r"|two )*(?:hands|palms) together\b"
        r"|\bputs? (?:the |his |her |their )?hands together (?:repeatedly|loudly)\b",
        "claps",
    ),
    *_as("chuck(s) lob(s) sling(s)", "throws", "throwing"),
    *_as("wallop(s) clobber(s) thump(s) whack(s) smack(s)", "punches", "punching"),
    (r"\bhaymaker\b", "punch"),
    *_as("punt(s)", "kicks", "kicking"),
    (
        r"\bshoot(?:s|ing)? (?:the |a )?(?:foot)?ball (?=(?:with|by|using) (?:the |his |her )?(?:left"
        r"|right) (?:leg|foot)\b)",
        "kicks the ball ",
    ),
    (
        r"\b(?:strikes?|striking|hits?|hitting|lash(?:es)? out) (?=(?:\w+ ){0,3}?(?:with|using) (?:the "
        r"|his |her |their )?(?:left |right )?(?:foot|leg|heel|shin)\b)",
        "kicks ",
    ),
    (
        r"\b(?:strikes?|striking|hits?|hitting|lash(?:es)? out) (?=(?:\w+ ){0,3}?(?:with|using) (?:the "
        r"|his |her |their )?(?:left |right )?fists?\b)",
        "punches ",
    ),
    (r"\b(?:kne(?:es|eing)) (?=(?:someone|somebody|him|her|the|an?)\b)", "knee kicks "),
    (r"\b(?:says?|saying) (?:hello|hi|bye|goodbye)\b", "waves"),
    (r"\bindicat(?:es?|ing) (?=(?:to )?(?:the )?(?:left|right|something|somebody)\b)", "points "),
    (
        r"\b(?:boogi|groov|jiv)(?:es?|eing|ing)\b|\bbust(?:s|ing)? (?:a move|some moves)\b|\bsway(?:s"
        r"|ing)? (?:\w+ ){0,2}to (?:the )?music\b",
        "dances",
    ),
    (r"\b(?:takes?|taking) a (?:shot|strike) (?=with the (?:left|right) (?:foot|leg)\b)", "kicks the ball "),
    (r"\bstanding ovation\b", "claps"),
    (r"\bboot(?:s|ing)? (?=(?:the |a )?(?:\w+ ?)?ball\b)", "kicks "),
    (r"\b(?:a |the |one )straight (left|right)\b(?! (?:ahead|line|path|leg|arm|turn|up))", "$1 punch"),
    (
        rf"\b(?:give|gives|giving|deliver|delivers|delivering|land|lands|execute|executes|perform|performs"
        rf"|performing|do|does|doing|make|makes|making|throw|throws|throwing|dish\w* out) {_LIGHT}(?=(?:front "
        rf"|side |back |roundhouse |right |left )*(?:kick|punch|jab|uppercut|hook|wave|bow|jump|hop|leap|clap"
        rf"|squat|lunge|spin|cartwheel|handstand|somersault|salute|nod|curtsy|push|turn|pirouette|roll"
        rf"|step)(?:e?s)?\b)",
        "",
    ),
    (r"\bsouthpaw\b|\blefty\b", "left handed"),
    (r"\bright ?y\b", "right handed"),
)
"""(pattern, plain words), tried one after another on the plain text; ``$1`` stands for what the first brackets hold."""
