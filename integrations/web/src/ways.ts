// How far and which way a text says that somebody turns and goes, and motions that are brought there while they are drawn.
import { decode, WIDTH } from "./ego77";
import { clamp } from "./rotations";
import { JOINTS } from "./skeleton";
import type { Said } from "./words";

type Range = readonly [number, number];

/** Ranges of a whole motion: turn in degrees (left positive, of either side where `either`), net way in metres. */
export interface Way {
  turn: Range | null;
  forward: Range | null;
  left: Range | null;
  either: boolean;
  /** Metres over the ground, at least and at most. */
  length: Range | null;
  /** Metres from its start that it stays within, all the way. */
  near: number | null;
}

const TURNS: Record<string, Range> = { turn: [60, 125], around: [150, 215], full: [330, 400] };
const BENDS: Record<string, Range> = { curve: [70, 190], circle: [240, 420], spin: [330, 760] };
const SLIGHTLY: Range = [20, 60];
const VEERING: Range = [50, 95];
const STRAIGHT: Range = [-12, 12];
const FACING: Range = [-20, 20]; // of who goes aside or backward
const SPINS_S = 0.9; // seconds of one turn of somebody who spins several times, at least
const BRISK: Range = [1.2, 2.2]; // m/s of who walks fast
const SLIGHT = /\b(?:slight\w*|a (?:bit|little)|gentl[ey]|gradual\w*|drift\w*)\b/;
const DEGREES = /\b([1-9]\d{1,2}) ?(?:degs?\b|degrees?\b|\u00b0)/i;
const VEER = /\b(?:veer|swerv|bear|bank)\w*/;
const [FASTEST_ASIDE, FASTEST_BACK, FASTEST_BEND] = [0.8, 0.95, 1.5]; // m/s of who does not run
const FAST = ["jog", "run"];
const [NEAR, LONGER] = [0.4, 3]; // metres that whoever stays may stray; times that a way is made longer at most
const ANY_PACE: Range = [0.45, 9]; // m/s, as all of these
const PACES: Record<string, Range> = { slow: [0.3, 0.8], walk: [0.75, 1.6], jog: [1.5, 3], run: [2.2, 6] };
const [BACKWARD, SIDEWAYS, STAIRS] = [0.4, 0.25, 0.3]; // least m/s
const [STEP, STAY, ASIDE] = [0.35, 0.2, 0.4]; // metres of a step to a side; that whoever stays may drift; aside for each metre
const [TURNED, GONE] = [Math.PI / 180, 0.02]; // what is not worth a correction, radians and metres

/** What a text says of the way of a motion of so many seconds; null where it says nothing. */
export function wayOf(said: Said, seconds: number): Way | null {
  const [turn, side] = turning(said, seconds);
  const [forward, left] = places(said, seconds);
  const length = lengthOf(said, seconds);
  if (!turn && !forward && !left && !length) return null;
  return {
    turn: turn && side === "right" ? [-turn[1], -turn[0]] : turn,
    forward,
    left,
    either: turn !== null && turn !== STRAIGHT && turn !== FACING && side !== "left" && side !== "right",
    length,
    near: said.travel === "none" ? NEAR : null,
  };
}

function turning(said: Said, seconds: number): [Range | null, string | null] {
  if (said.turn === "none" || said.path === "straight") return [STRAIGHT, null];
  const exact = exactly(said);
  if (exact) return [exact, (said.path ? said.path_side : said.turn_side) ?? null];
  if (said.path === "spin" && (said.repeats ?? 0) > 1) {
    const count = Math.min(said.repeats, Math.max(1, Math.trunc(seconds / SPINS_S)));
    return [[350 * count, 410 * count], said.path_side ?? null];
  }
  if (said.path) return [BENDS[said.path] ?? null, said.path_side ?? null];
  if (said.turn) return [TURNS[said.turn] ?? null, said.turn_side ?? null];
  return [["left", "right", "sideways", "backward"].includes(said.travel) && !said.course ? FACING : null, null];
}

/** How far somebody turns of whose turn the text says that it is small, or how many degrees it has. */
function exactly(said: Said): Range | null {
  const degrees = DEGREES.exec(said.text);
  if (degrees && (said.turn === "turn" || said.turn === "around") && !said.path) return [0.9 * Number(degrees[1]), 1.1 * Number(degrees[1])];
  if (said.path === "curve" || (!said.path && said.turn === "turn")) return SLIGHT.test(said.text) ? SLIGHTLY : VEER.test(said.text) ? VEERING : null;
  return null;
}

/** How long the way of somebody is who goes aside, backward or along a bend. */
function lengthOf(said: Said, seconds: number): Range | null {
  const fast = FAST.includes(said.speed);
  if (["left", "right", "sideways"].includes(said.travel) && !fast && !said.jumps) return [0, FASTEST_ASIDE * seconds];
  if (said.travel === "backward" && !said.jumps) return [0, (fast ? PACES.jog[1] : FASTEST_BACK) * seconds];
  if (!(said.course || said.path === "curve" || said.path === "circle") || said.action === "dance" || said.action === "swim") return null;
  const [low, high] = PACES[said.speed] ?? ANY_PACE;
  return [said.travel === "forward" ? low * seconds : 0, (fast ? high : FASTEST_BEND) * seconds];
}

function places(said: Said, seconds: number): [Range | null, Range | null] {
  if (said.travel === "none") return [[-STAY, STAY], [-STAY, STAY]];
  if (said.travel === "left" || said.travel === "right") {
    const low = said.action === "sidestep" ? SIDEWAYS * seconds : Math.min(SIDEWAYS * seconds, STEP);
    return [[-ASIDE * low, ASIDE * low], said.travel === "left" ? [low, 9] : [-9, -low]];
  }
  if (said.travel === "backward") {
    const low = BACKWARD * seconds;
    return [[-9, -low], [-ASIDE * low, ASIDE * low]];
  }
  if (said.travel === "forward" && !said.course && (!said.path || said.path === "straight") && (!said.turn || said.turn === "none")) {
    const brisk = said.pace === "fast" && !said.speed && said.action === "walk";
    const [low, high] = brisk ? BRISK : PACES[said.speed] ?? ANY_PACE;
    return [[low * seconds, high * seconds], [-ASIDE * low * seconds, ASIDE * low * seconds]];
  }
  return said.action === "stairs" && !said.travel ? [[STAIRS * seconds, 9], null] : [null, null];
}

/** Features F x 77 whose turn and way are in their ranges; null where they are already. */
export function brought(features: Float32Array, way: Way): Float32Array | null {
  const frames = features.length / WIDTH;
  if (frames < 2) return null;
  const rows = Float64Array.from(features);
  const shares = Array.from({ length: frames - 1 }, (_, f) => Math.sin((Math.PI * (f + 0.5)) / (frames - 1)) ** 2);
  const total = shares.reduce((a, b) => a + b);
  const stayed = stay(rows, way);
  const lengthened = lengthen(rows, way);
  const turned = turn(rows, way, shares.map((share) => share / total));
  const placed = place(rows, way, shares.map((share) => share / total));
  return stayed || lengthened || turned || placed ? Float32Array.from(rows) : null;
}

const into = (value: number, wanted: Range | null): number => (wanted ? clamp(value, wanted[0], wanted[1]) : value);

/** Make a way shorter that strays too far from its start; in place. */
function stay(rows: Float64Array, way: Way): boolean {
  if (way.near === null) return false;
  const joints = decode(rows);
  let far = 0;
  for (let i = 0; i < joints.length; i += JOINTS * 3) far = Math.max(far, Math.hypot(joints[i] - joints[0], joints[i + 2] - joints[2]));
  if (far <= way.near + GONE) return false;
  scale(rows, way.near / far, rows.length);
  return true;
}

/** Bring the length of a way into its range; in place. */
function lengthen(rows: Float64Array, way: Way): boolean {
  if (!way.length) return false;
  let now = 0;
  for (let i = 0; i < rows.length - WIDTH; i += WIDTH) now += Math.hypot(rows[i + 1], rows[i + 2]);
  const off = into(now, way.length) - now;
  if (Math.abs(off) <= GONE || now < GONE) return false;
  scale(rows, Math.min((now + off) / now, LONGER), rows.length - WIDTH);
  return true;
}

function scale(rows: Float64Array, part: number, end: number): void {
  for (let i = 0; i < end; i += WIDTH) for (const k of [1, 2]) rows[i + k] *= part;
}

function turn(rows: Float64Array, way: Way, shares: number[]): boolean {
  if (!way.turn) return false;
  const now = shares.reduce((sum, _, f) => sum + rows[f * WIDTH], 0);
  const [low, high] = way.turn.map((degrees) => (degrees * Math.PI) / 180);
  const off = into(now, way.either && now < 0 ? [-high, -low] : [low, high]) - now;
  shares.forEach((share, f) => (rows[f * WIDTH] += off * share));
  return Math.abs(off) > TURNED;
}

function place(rows: Float64Array, way: Way, shares: number[]): boolean {
  const joints = decode(rows);
  const last = shares.length * JOINTS * 3;
  const [x, z] = [into(joints[last], way.left) - joints[last], into(joints[last + 2], way.forward) - joints[last + 2]];
  let yaw = 0;
  shares.forEach((share, f) => {
    const [c, s] = [Math.cos(yaw), Math.sin(yaw)];
    rows[f * WIDTH + 1] += share * (x * c - z * s);
    rows[f * WIDTH + 2] += share * (x * s + z * c);
    yaw += rows[f * WIDTH];
  });
  return Math.max(Math.abs(x), Math.abs(z)) > GONE;
}
