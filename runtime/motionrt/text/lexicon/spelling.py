"""Words that are recognised with one slip of the pen in them, and words that look like such a slip and are none."""

from __future__ import annotations

SPELT = (
    "above another anticlockwise arms around backward backwards balance balances balancing basketball bend "
    "bending bends both bowing bows cartwheel catch catches catching chair chest circle circles clap clapping "
    "claps climb climbing climbs clockwise counterclockwise crawl crawling crawls crossed crosses crouch crouches "
    "crouching dance dances dancing dribble dribbles dribbling drink drinking drinks fall falling falls feet "
    "floor foot forward forwards ground guitar hand hands head hopping hops jogging jogs jump jumping jumps kick "
    "kicking kicks knee kneel kneeling kneels knees leap leaping leaps left legs lies lift lifting lifts limp "
    "limping limps looking looks lower lowering lowers lying march marches marching nods person pick picking "
    "picks pivot pivoting pivots place point pointing points pull pulling pulls punch punches punching push "
    "pushes pushing quickly raise raises raising reach reaches reaching right rotate rotates rotating running "
    "runs salute salutes shakes shaking shoulder shoulders shuffle shuffles sidestep sidesteps sideways sits "
    "sitting skip skipping skips slowly sneak sneaking sneaks somersault spin spinning spins sprint sprinting "
    "sprints squat squats squatting stagger staggers stairs stand standing stands step stepping steps stomp "
    "stomps stool stop stops strafe strafes straight stretch stretches stretching stumble stumbles stumbling swim "
    "swimming swims swing swinging swings tennis then three throw throwing throws times tiptoe tiptoes turn "
    "turning turns twice violin walk walking walks wave waves waving while with"
)
"""Words of four letters and more whose slips are mended, with spaces between them."""

RIGHT = (
    "arise arises arising backyard balanced balancer beds binding blending blends blowing bonding boning booing "
    "booth boring bowling boxing caches capping caps cartwheels catched catcher catchers chairs chests circled "
    "clasp clasping claspings clipping couch couches couching cradling crapping crouched danced dancer dancers "
    "dribbled dribbler drunks fabling failing felling filling floors grounds guitars hipping hooping hoops hoping "
    "jugging keel keeling keels kneaded lamping laping lapping laying leading leafing leaking leaning learing "
    "leasing leaving limbing liming lips listing litting locking lofting look looming looping loosing looting "
    "loping losers lovers lowes lumping marched marcher marshes matches matching pace packing painting paints "
    "palace pecking persons piling pilling piloting pilots pinches pinching pinking pipping placed places plushes "
    "pointe polling ponting pricking pricks printing prints pulping pulsing punched puncher pushed raiding "
    "railing raining raised reached reacher reacting rights rise rises rising roaches roaching rotated rotting "
    "ruining saluted sand sanding sands satting sawed sawing scuffle scuffles setting sewing shades shading shake "
    "shaken shaming shapes shaping shares sharing shaves shaving shinning shipping shuffled simming sims sing "
    "singing sings sinning sins sipping sips skinning skinnings slimming slinging slings slipping slitting snakes "
    "snaking sneaky soaking somersaults spanning speaking speaks spines spitting spring springing springs squads "
    "stains stair stakes staking stamps stancing standings stans stars steaking steep steeping stinging stings "
    "stirs stools stoop stoops stopping strafed straights strand stranding strands stretched strife stubble "
    "stubbles stumbled stumps swagger swaggers swig swigs thee there thrown ties time timers torning tree tuning "
    "tunning violins wading waging waking wales waling walled waning waring waxing weaves weaving"
)
"""English words that are one slip away from one of the first list and are meant."""
