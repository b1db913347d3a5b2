"""The closed classes of words that the rules look at."""

from __future__ import annotations


def word_set(words: str) -> frozenset[str]:
    """The words of a string."""
    return frozenset(words.split())


ARTICLES = word_set("a an the his her their your my its our one's some this that these those")
DETERMINERS = ARTICLES | word_set(
    "one two three four five six seven eight nine ten several few many another any each every other both no multiple "
    "either"
)
SIDES = frozenset({"left", "right"})
PAIRING = word_set(
    "both each either two alternate alternating alternately alternatively every all opposite opposing respective"
)
ALTERNATING = word_set("alternate alternating alternately alternatingly alternatively turns")
ADJECTIVES = word_set(
    "quick slow fast big small high low deep little large long short tiny huge single double full half whole wide "
    "index middle pointer pinky "
    "narrow light hard soft strong weak gentle sharp sudden sideways forward backward backwards brief slight smooth "
    "straight "
    "own free upper front back rear lead leading trailing inner outer more final last first second next same "
    "loose stiff limp rigid tense empty whole entire dominant bare flat karate boxing dance side good "
    "vertical horizontal lateral powerful exaggerated circular repeated simple nice traditional forceful"
)
BY = frozenset({"with", "using", "use", "uses", "used", "by", "via"})  # what an action is done with
AT = word_set(  # where it goes or is
    "to on at onto into in inside against over above behind near around between from toward towards across off under "
    "beneath below through past beside along of upon before for like reaching around beyond underneath"
)
OF = word_set("in on at from of into for onto inside against near between through like under")  # nouns follow
BREAKS = word_set(  # a new clause begins
    "while whilst then before after when until during meanwhile simultaneously without as . ; : ! ?"
)
JOINTS = frozenset(
    {"and", "or", ",", "but", "plus", "&", "/", "nor", "also"}
)  # it may begin, if it has an action of its own
NEGATIONS = word_set("neither without not never no don't doesn't isn't nor cannot can't won't avoid avoiding hardly")
STILL = word_set("planted rooted still motionless steady fixed stationary immobile unmoving immobilized frozen static")
POSED = word_set("on in at behind by attached beside near")  # "with a hand on the hip": not a means
PARTICLES = word_set("up down out off on over away back around together forward in apart")
NO_THINGS = word_set(  # what follows an article and is no thing in the hands
    "left right way corner circle bit little lot side sides body other front back floor ground air time times while "
    "degrees degree moment half quarter full second row few direction opposite place spot stairs beat rhythm line "
    "curve series manner fashion position step steps turn whole more and it them"
)
LOW = frozenset({"foot", "toe", "ankle", "shin", "heel", "calf", "floor", "ground"})  # one bends down to reach them

ARM, LEG, TORSO, HIPS = "arm", "leg", "torso", "hips"
LIMBS: dict[str, str] = {
    **dict.fromkeys(
        word_set(
            "arm hand fist elbow wrist finger thumb palm shoulder forearm paw wing bicep biceps tricep triceps "
            "fingertip knuckle limb armpit"
        ),
        ARM,
    ),
    **dict.fromkeys(word_set("leg foot knee ankle toe heel thigh calf shin hamstring quad quadricep shank"), LEG),
    **dict.fromkeys(
        word_set(
            "head neck torso back chest spine trunk face chin belly stomach abs abdomen rib eye ear nose mouth cheek "
            "forehead jaw gaze ribcage temple hair eyebrow lip tongue brow upperbody beard"
        ),
        TORSO,
    ),
    **dict.fromkeys(word_set("hip waist pelvis buttock butt bottom glute bum booty"), HIPS),
}
BODIES = {"upper": TORSO, "lower": LEG}  # "upper body"
PAIRED = word_set("ear eye cheek temple knee toe foot ankle shin thigh shoulder hip elbow calf heel")
PASSIVE = word_set("eye ear nose mouth cheek forehead hair lip eyebrow brow temple beard")  # never move alone
