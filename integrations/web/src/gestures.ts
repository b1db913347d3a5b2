// Which gestures a text means whose course is plain (motionrt.text.gestures); what the hands do is in data/words.json.
import data from "./data/words.json";
import { has, plain, without } from "./patterns";
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
}

const lex = data.lexicon as Record<string, any>;
const SIDES = ["left", "right"];
const RAISES = [null, "gesture", "stand", "stretch"]; // actions beside which hands are simply raised
const RAISED: Gesture = {
  pattern: "", hands: "both", places: [[0, 0.04, 0.46, 0.06]], about: "shoulder", swing: [0, 0, 0], swirl: [0, 0, 0], hz: 0, alternate: false, once_s: 0,
};

/** The gestures of a text. */
export function gesturesOf(said: Said): Gestures {
  const words = without(without(plain(said.text), [lex.NEGATION]), lex.NO_SIDES);
  if (has(words, lex.NOT_GESTURES)) return { hands: [], bows: false, marches: false, lifted: null, head: null, kneels: null };
  const hands = handsOf(words, said.arm ?? null, RAISES.includes(said.action ?? null) ? said.arms_up ?? null : null);
  const leg: string | null = SIDES.includes(said.leg) ? said.leg : null;
  const kneels = has(words, lex.ONE_KNEE) ? leg ?? "right" : "both";
  return {
    hands,
    bows: has(words, lex.BOWS),
    marches: has(words, lex.MARCHES),
    lifted: has(words, lex.BALANCES) ? leg ?? "left" : null,
    head: (lex.HEADS as HeadGesture[]).find(({ pattern }) => has(words, pattern)) ?? null,
    kneels: said.posture_lowest === "kneeling" ? kneels : null,
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
