// Which gestures a text means whose course is plain (motionrt.text.gestures); what the hands do is in data/words.json.
import data from "./data/words.json";
import { has, only, sides, without } from "./patterns";
import { worded } from "./wording";
import type { Said } from "./words";

/** What a hand does: places are [share of it, out, up, ahead] in metres from the shoulder or the head. */
export interface Gesture {
  pattern: string;
  hands: string;
  places: number[][];
  about: string;
  swing: number[];
  swirl: number[];
  hz: number;
  alternate: boolean;
  once_s: number;
}

/** What the head does: radians that it is turned and bent, and how often a second; 0 for what is kept up. */
export interface HeadGesture {
  pattern: string;
  left: number;
  down: number;
  hz: number;
}

/** What a text says of hands, trunk, feet and head. */
export interface Gestures {
  hands: [string, Gesture][];
  bows: boolean;
  marches: boolean;
  /** The side of the foot that stays lifted. */
  lifted: string | null;
  head: HeadGesture | null;
  /** Whose knees are on the floor: "left", "right", "both". */
  kneels: string | null;
  /** Whether the trunk lies on the floor while the pelvis does. */
  lies: boolean;
  /** Whether the trunk is upright: a gesture of somebody of whom nothing else is said. */
  stands: boolean;
}

const lex = data.lexicon as Record<string, any>;
const SIDES = ["left", "right"];
const RAISES = [null, "gesture", "stand", "stretch"]; // actions beside which hands are simply raised
const RAISED: Gesture = {
  pattern: "", hands: "both", places: [[0, 0.04, 0.46, 0.06]], about: "shoulder", swing: [0, 0, 0], swirl: [0, 0, 0], hz: 0, alternate: false, once_s: 0,
};

/** The gestures of a text. */
export function gesturesOf(said: Said): Gestures {
  const found = basicGestures(said);
  const picks = said.action === "pick up" && said.hands_low && !said.posture_lowest && (!said.travel || said.travel === "none");
  if (picks) {
    found.hands = sidesOf("one", said.arm ?? null).map((side): [string, Gesture] => [side, lex.REACHES_DOWN]);
    found.bows = true;
  }
  found.stands = found.hands.length > 0 && said.posture_start === "standing" && !said.posture_lowest && !(said.lean || found.bows);
  return found;
}

function basicGestures(said: Said): Gestures {
  const words = without(without(worded(said.text), [lex.NEGATION]), lex.NO_SIDES);
  const lies = said.posture_lowest === "lying";
  if (has(words, lex.NOT_GESTURES)) return { hands: [], bows: false, marches: false, lifted: null, head: null, kneels: null, lies, stands: false };
  const hands = handsOf(words, said.arm ?? only(sides(words, [lex.POINTS_TO])), RAISES.includes(said.action ?? null) ? said.arms_up ?? null : null);
  const leg: string | null = SIDES.includes(said.leg) ? said.leg : null;
  const foot: string | null = SIDES.includes(said.foot_lift) ? said.foot_lift : leg;
  const kneels = has(words, lex.ONE_KNEE) ? leg ?? "right" : "both";
  return {
    hands,
    bows: has(words, lex.BOWS),
    marches: has(words, lex.MARCHES),
    lifted: has(words, lex.BALANCES) ? foot ?? "left" : null,
    head: (lex.HEADS as HeadGesture[]).find(({ pattern }) => has(words, pattern)) ?? null,
    kneels: said.posture_lowest === "kneeling" ? kneels : null,
    lies,
    stands: false,
  };
}

function handsOf(words: string, arm: string | null, raised: string | null): [string, Gesture][] {
  const hands = new Map<string, Gesture>();
  for (const gesture of lex.GESTURES as Gesture[])
    if (has(words, gesture.pattern)) for (const side of sidesOf(gesture.hands, arm)) if (!hands.has(side)) hands.set(side, gesture);
  if (!hands.size && raised !== null && raised !== "none") for (const side of sidesOf(raised, arm)) hands.set(side, RAISED);
  return [...hands];
}

/** The hands that do it. */
function sidesOf(which: string, arm: string | null): string[] {
  if (which === "both" || (which === "one" && arm === "both")) return SIDES;
  if (which === "one") return [arm !== null && SIDES.includes(arm) ? arm : "right"];
  return [which];
}

const STOOD = [null, "gesture", "manipulate", "clap", "wave", "stand", "throw", "punch", "basketball"];
const ALLOWED = ["arm", "arms_up", "arms_move", "hands_together", "claps", "repeats", "pace", "torso_move", "foot_lift", "leg"];
const UNSAID = ["text", "action", "actions"];

/** A text of nothing but a gesture or a lifted foot, done where somebody stands. */
export function standing(said: Said): Said {
  const more = Object.entries(said).some(([name, value]) => value !== null && value !== undefined && !UNSAID.includes(name) && !ALLOWED.includes(name));
  if (more || !STOOD.includes(said.action ?? null)) return said;
  const { hands, lifted } = gesturesOf(said);
  if (!hands.length && !lifted) return said;
  return { ...said, travel: "none", turn: "none", posture_start: "standing", posture_end: "standing", level: "level", jumps: 0 };
}
