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
}

const TURNS: Record<string, Range> = { turn: [60, 125], around: [150, 215], full: [330, 400] };
const BENDS: Record<string, Range> = { curve: [70, 190], circle: [240, 420], spin: [330, 760] };
const STRAIGHT: Range = [-12, 12];
const ANY_PACE: Range = [0.45, 9]; // m/s, as all of these
const PACES: Record<string, Range> = { slow: [0.3, 0.8], walk: [0.75, 1.6], jog: [1.5, 3], run: [2.2, 6] };
const [BACKWARD, SIDEWAYS, STAIRS] = [0.4, 0.25, 0.3]; // least m/s
const [STEP, STAY, ASIDE] = [0.35, 0.2, 0.4]; // metres of a step to a side; that whoever stays may drift; aside for each metre
const [TURNED, GONE] = [Math.PI / 180, 0.02]; // what is not worth a correction, radians and metres

/** What a text says of the way of a motion of so many seconds; null where it says nothing. */
export function wayOf(said: Said, seconds: number): Way | null {
  const [turn, side] = turning(said);
  const [forward, left] = places(said, seconds);
  if (!turn && !forward && !left) return null;
  return {
    turn: turn && side === "right" ? [-turn[1], -turn[0]] : turn,
    forward,
    left,
    either: turn !== null && turn !== STRAIGHT && side !== "left" && side !== "right",
  };
}

function turning(said: Said): [Range | null, string | null] {
  if (said.turn === "none" || said.path === "straight") return [STRAIGHT, null];
  if (said.path) return [BENDS[said.path] ?? null, said.path_side ?? null];
  return said.turn ? [TURNS[said.turn] ?? null, said.turn_side ?? null] : [null, null];
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
  if (said.travel === "forward" && (!said.path || said.path === "straight") && (!said.turn || said.turn === "none")) {
    const [low, high] = PACES[said.speed] ?? ANY_PACE;
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
  const turned = turn(rows, way, shares.map((share) => share / total));
  const placed = place(rows, way, shares.map((share) => share / total));
  return turned || placed ? Float32Array.from(rows) : null;
}

const into = (value: number, wanted: Range | null): number => (wanted ? clamp(value, wanted[0], wanted[1]) : value);

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
