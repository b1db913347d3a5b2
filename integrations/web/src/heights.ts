// How high a text says that the pelvis is in time (motionrt.text.ways).
import { FPS } from "./ego77";
import type { Said } from "./words";

const HEIGHTS: Record<string, number> = { standing: 0.94, crouching: 0.58, sitting: 0.5, crawling: 0.45, kneeling: 0.44, lying: 0.09 }; // metres
const [FIRST, LAST, LATEST_S, CHANGE_S, LEAST_CHANGE] = [0.4, 0.7, 2, 0.2, 0.2];
const OVER = 0.1; // metres
const PICKED = 0.64; // metres: the pelvis of who picks something up from the floor
const ONE_JUMP = 0.28; // metres that the pelvis is thrown up, as of the next
const EACH: Record<string, number> = { jump: 0.16, hop: 0.12, "jumping jack": 0.12 };
const LASTS_S: Record<string, number> = { jump: 0.9, hop: 0.7, "jumping jack": 1.0 }; // seconds of each
const LEAP = 0.8; // metres that somebody gets on in a jump that goes somewhere
const [FIRST_JUMP_S, LEAST_JUMP_S] = [0.4, 0.55]; // seconds before the first, and of each at least

/** Heights of the pelvis in metres of a text that goes down or up on the spot, of so many frames at 20 fps; else null. */
export function heightsOf(said: Said, frames: number): number[] | null {
  const goes = (value: unknown): boolean => Boolean(value) && value !== "none";
  const seconds = (frames - 1) / FPS;
  const movesOn = goes(said.travel) || goes(said.turn) || said.path || said.course;
  if (said.jumps) {
    const jumps = jumpsOf(said, seconds);
    return jumps && jumping(jumps, frames);
  }
  const course = movesOn ? null : courseOf(said);
  if (!course) return null;
  const [start, middle, end] = course;
  const first = Math.min((middle === null ? FIRST : 1 - LAST) * seconds, LATEST_S);
  const changed = (time: number): number => 1 / (1 + Math.exp(-time / CHANGE_S));
  return Array.from({ length: frames }, (_, f) => {
    const height = start + ((middle ?? end) - start) * changed(f / FPS - first);
    return middle === null ? height : height + (end - middle) * changed(f / FPS - LAST * seconds);
  });
}

function courseOf(said: Said): [number, number | null, number] | null {
  const up = HEIGHTS.standing;
  const height = (name: string | null | undefined): number | null => HEIGHTS[name ?? ""] ?? null;
  let [start, end] = [height(said.posture_start), height(said.posture_end)];
  const lowest = height(said.posture_lowest);
  let middle: number | null = null;
  if (said.action === "pick up" && said.hands_low && lowest === null && /\b(?:floor|ground)\b/.test(said.text)) return [up, PICKED, up];
  if (said.level === "up") [start, end] = [start ?? lowest ?? (/\b(?:floor|ground)\b/.test(said.text) ? 0.3 : HEIGHTS.sitting), up];
  else if (said.level === "down") [start, end] = [up, end ?? lowest];
  else if (said.level === "down and up" || ((start === null || start === up) && end === up && lowest !== null)) [start, middle, end] = [up, lowest, up];
  if (start === null || end === null) return null;
  if (start === end && end === lowest && lowest === HEIGHTS.lying) return [start, null, end];
  return Math.max(start, end) - Math.min(start, end, middle ?? end) >= LEAST_CHANGE ? [start, middle, end] : null;
}

/** Metres below which the pelvis stays in a text of one low posture; else null. */
export function ceilingOf(said: Said): number | null {
  const low: string | null = said.posture_lowest ?? null;
  const stays = low !== null && low === said.posture_start && low === said.posture_end && (!said.level || said.level === "level");
  const height = HEIGHTS[low ?? ""] ?? HEIGHTS.standing;
  return stays && height < HEIGHTS.standing ? height + OVER : null;
}

/** Jumps at `tops` seconds, `up` metres high, about `each` seconds apart; `way` metres forward each. */
interface Jumps {
  tops: number[];
  up: number;
  each: number;
  way: number;
}

/** The jumps of a text of nothing but jumps. */
function jumpsOf(said: Said, seconds: number): Jumps | null {
  const elsewhere = (said.turn && said.turn !== "none") || said.path || said.course || said.posture_lowest;
  const onward = said.travel === "backward" || (said.travel === "forward" && !said.steps);
  const stays = !said.travel || said.travel === "none";
  if (elsewhere || !(stays || onward) || !said.actions.every((name: string) => name in LASTS_S)) return null;
  if (seconds < FIRST_JUMP_S + LEAST_JUMP_S) return null;
  const often: number = said.jumps || 1;
  const kind: string = said.action ?? "jump";
  const [left, usual] = [seconds - FIRST_JUMP_S, LASTS_S[kind]];
  const wanted = often > 0 ? often : Math.max(2, Math.trunc(left / usual));
  const each = Math.min(Math.max(left / wanted, LEAST_JUMP_S), usual);
  const count = Math.min(wanted, Math.trunc(left / each + 1e-6));
  const first = count === 1 ? 0.45 * seconds : FIRST_JUMP_S + each / 2;
  const up = often === 1 && kind === "jump" ? ONE_JUMP : EACH[kind];
  const side: Record<string, number> = { forward: 1, backward: -0.7 };
  return { tops: Array.from({ length: count }, (_, k) => first + k * each), up, each, way: LEAP * (up / ONE_JUMP) * (side[said.travel] ?? 0) };
}

/** Heights of a pelvis that goes down, is thrown up and comes down again. */
function jumping({ tops, up, each }: Jumps, frames: number): number[] {
  const falls = Math.sqrt((2 * up) / 9.81);
  return Array.from({ length: frames }, (_, f) => {
    let height = HEIGHTS.standing;
    for (const top of tops) {
      const t = f / FPS - top;
      const dips = 0.9 * bump((t + falls + each / 6) / (each / 4)) + 0.6 * bump((t - falls - each / 8) / (each / 4));
      height += up * Math.max(1 - (t / falls) ** 2, 0) - up * dips;
    }
    return height;
  });
}

/** Metres per second forward of somebody who jumps forward or backward, of so many frames at 20 fps; else null. */
export function stridesOf(said: Said, frames: number): number[] | null {
  const jumps = said.jumps ? jumpsOf(said, (frames - 1) / FPS) : null;
  if (!jumps) return null;
  const falls = Math.sqrt((2 * jumps.up) / 9.81);
  return Array.from({ length: frames }, (_, f) => jumps.tops.filter((top) => Math.abs(f / FPS - top) < falls).length * (jumps.way / (2 * falls)));
}

const bump = (x: number): number => (Math.abs(x) < 1 ? 0.5 + 0.5 * Math.cos(Math.PI * x) : 0);

const [ZIGZAG, ZIGZAG_S, EIGHT] = [0.75, 2.8, 5.6]; // radians to either side, seconds to and fro; radians of one loop

/** Headings, radians, left positive, of a way that bends to both sides, of so many frames at 20 fps; else null. */
export function headingsOf(said: Said, frames: number): number[] | null {
  if (!said.course || frames < 2) return null;
  const seconds = (frames - 1) / FPS;
  return Array.from({ length: frames }, (_, f) => {
    const t = f / FPS;
    if (said.course === "zigzag") return Math.fround(ZIGZAG * Math.sin((2 * Math.PI * t) / Math.min(ZIGZAG_S, seconds / 1.5)));
    return Math.fround(EIGHT * (1 - Math.abs((2 * t) / seconds - 1)));
  });
}
