// Foot locking: the ball of a standing foot stays where it stands (motionrt.motion.feet.lock).
import { bent, LEGS, softLimit } from "./legs";
import type { Motion } from "./motion";
import { add, clamp, length, minus, times, type Numbers, type Vec3 } from "./rotations";

export const BLEND_S = 0.2; // seconds over which a correction fades
const MAX_DROP = 0.05; // metres that the pelvis may sink for a foot that would not reach
const QUICKENS = 1.25; // times the speed from which a toe swings by which it is faster when it keeps all of its clearance
const CLEARANCE = 0.03; // metres above the floor of a toe that swings by
export const MAX_SHIFT = 0.1; // metres that a toe is moved in a contact
const DOWN = 0.025; // metres
const CALMER = 0.25;
export const LOOSE_SPEED = Math.sqrt(0.002) * 20; // m/s, where guo263 sees a contact
export const STRICT_SPEED = LOOSE_SPEED / 2;
export const STRICT_HEIGHT = 0.06;
const LOOSE_HEIGHT = 0.09;
const SHORTEST_S = 0.07;

export interface Run {
  start: number;
  stop: number;
}

/** Start and stop (exclusive) of every run of true values. */
export function runsOf(flags: boolean[]): Run[] {
  const found: Run[] = [];
  flags.forEach((flag, f) => {
    if (flag && (f === 0 || !flags[f - 1])) found.push({ start: f, stop: f + 1 });
    else if (flag) found[found.length - 1].stop = f + 1;
  });
  return found;
}

/** The motion, on the floor, with feet that stand still while they stand and swing clear of the floor: from so many m/s on. */
export function lockFeet(motion: Motion, swingsFrom = LOOSE_SPEED): Motion {
  const { fps } = motion;
  const found = LEGS.map(([, , , toe]) => {
    const toes = wayOf(motion, toe);
    const speed = speeds(toes, fps);
    const planted = plantedOf(toes, speed, fps);
    const offset = pinned(toes, planted, speed.map(calm), BLEND_S * fps);
    offset.forEach((way, f) => (way[1] += lift(toes[f][1] + way[1], speed[f], swingsFrom)));
    return { planted, offset };
  });
  return moved(motion, found.map(({ offset }) => offset), found.map(({ planted }) => planted));
}

/** The places of a joint. */
export function wayOf(motion: Motion, index: number): Vec3[] {
  return Array.from({ length: motion.frames }, (_, f) => [0, 1, 2].map((axis) => motion.at(f, index, axis)) as Vec3);
}

/** Left and right foot moved by bending the legs; the pelvis sinks where one that counts would not reach. */
export function moved(motion: Motion, offsets: Vec3[][], counts: boolean[][]): Motion {
  const chains = LEGS.map(([hip, knee, ankle]) => [hip, knee, ankle].map((index) => wayOf(motion, index)));
  const needed = Array.from({ length: motion.frames }, (_, f) =>
    clamp(Math.max(...chains.map((chain, i) => (counts[i][f] ? drop(chain.map((way) => way[f]), offsets[i][f]) : 0))), 0, MAX_DROP),
  );
  return bent(motion, offsets, smoothCover(needed, Math.max(1, Math.round((BLEND_S * motion.fps) / 2))));
}

export function speeds(points: Vec3[], fps: number): number[] {
  const half = Math.max(1, Math.round(fps / 30));
  return points.map((_, f) => {
    const [before, after] = [Math.max(f - half, 0), Math.min(f + half, points.length - 1)];
    return length(minus(points[after], points[before])) / (Math.max(after - before, 1) / fps);
  });
}

/** Frames in which a toe can be pinned to one point. */
function plantedOf(toes: Vec3[], speed: number[], fps: number): boolean[] {
  const heights = toes.map((toe) => toe[1]);
  let planted = still(heights, speed, fps);
  const calmer = still(heights, speed.map((value) => value / CALMER), fps);
  const tooWide = wide(toes, planted);
  planted = planted.map((flag, f) => (tooWide[f] ? calmer[f] : flag));
  const yet = wide(toes, planted);
  planted = planted.map((flag, f) => flag && !yet[f]);
  const near = new Array<boolean>(toes.length).fill(false);
  for (const run of runsOf(planted)) {
    const point = mean(toes, speed.map(calm), run);
    for (let f = run.start; f < run.stop; f++) {
      const off = minus(toes[f], point);
      near[f] = Math.hypot(off[0], off[2]) < MAX_SHIFT && Math.abs(off[1]) < DOWN;
    }
  }
  return near;
}

function still(height: number[], speed: number[], fps: number): boolean[] {
  const strict = height.map((value, f) => speed[f] < STRICT_SPEED && value < STRICT_HEIGHT);
  const loose = height.map((value, f) => speed[f] < LOOSE_SPEED && value < LOOSE_HEIGHT);
  const flags = new Array<boolean>(height.length).fill(false);
  for (const { start, stop } of runsOf(loose)) if (strict.slice(start, stop).some(Boolean)) flags.fill(true, start, stop);
  const shortest = Math.max(2, Math.round(SHORTEST_S * fps));
  const flicker = ({ start, stop }: Run): boolean => stop - start < shortest && start > 0 && stop < flags.length;
  for (const run of runsOf(flags.map((flag) => !flag)).filter(flicker)) flags.fill(true, run.start, run.stop);
  for (const run of runsOf(flags).filter(flicker)) flags.fill(false, run.start, run.stop);
  return flags;
}

/** Contacts in which a toe travels too far to be pinned. */
function wide(toes: Vec3[], planted: boolean[]): boolean[] {
  const flags = new Array<boolean>(planted.length).fill(false);
  for (const { start, stop } of runsOf(planted)) {
    const part = toes.slice(start, stop);
    const far = [0, 1, 2].some((i) => Math.max(...part.map((toe) => toe[i])) - Math.min(...part.map((toe) => toe[i])) > 2 * MAX_SHIFT);
    if (far) flags.fill(true, start, stop);
  }
  return flags;
}

const calm = (speed: number): number => 1 / (1 + (speed / (STRICT_SPEED / 2)) ** 4);

function mean(points: Vec3[], weights: number[], { start, stop }: Run): Vec3 {
  let [sum, total]: [Vec3, number] = [[0, 0, 0], 0];
  for (let f = start; f < stop; f++) {
    sum = add(sum, times(points[f], weights[f]));
    total += weights[f];
  }
  return times(sum, 1 / total);
}

/** What moves a toe to its pinned points, faded over `blend` frames away from contacts. */
function pinned(toes: Vec3[], planted: boolean[], weights: number[], blend: number): Vec3[] {
  const offset: Vec3[] = toes.map(() => [0, 0, 0]);
  for (const run of runsOf(planted)) {
    const point = mean(toes, weights, run);
    for (let f = run.start; f < run.stop; f++) {
      offset[f] = minus(point, toes[f]);
      offset[f][1] /= 1 + (offset[f][1] / (DOWN / 2)) ** 4;
    }
  }
  return faded(offset, planted, blend);
}

/** Offsets that leave and reach every contact with the speed they have there. */
export function faded(offset: Vec3[], contacts: boolean[], blend: number): Vec3[] {
  const out = offset.map((way): Vec3 => [...way]);
  for (const { start, stop } of runsOf(contacts.map((flag) => !flag))) {
    const span = clamp(stop - start + 1, 1, Math.max(blend, 1));
    for (let f = start; f < stop; f++) {
      if (start > 0) out[f] = add(out[f], tail(offset, start - 1, -1, f - start + 1, span));
      if (stop < offset.length) out[f] = add(out[f], tail(offset, stop, 1, stop - f, span));
    }
  }
  return out;
}

/** The offset at an edge with its slope there, brought to zero with zero slope. */
function tail(offset: Vec3[], edge: number, inward: number, time: number, span: number): Vec3 {
  const inner = clamp(edge + inward, 0, offset.length - 1);
  const slope = offset[inner].some((value) => value !== 0) ? minus(offset[edge], offset[inner]) : [0, 0, 0];
  const s = Math.min(time / span, 1);
  return times(add(times(offset[edge], 1 + 2 * s), times(slope, s * span)), (1 - s) ** 2);
}

/** Metres to raise a toe that moves at `speed`: not negative, and smooth. */
function lift(height: number, speed: number, swingsFrom: number): number {
  const s = clamp((speed - swingsFrom) / (QUICKENS * swingsFrom), 0, 1);
  const swings = CLEARANCE * s * s * (3 - 2 * s);
  const short = swings - height;
  return (short + Math.sqrt(short * short + (swings / 2) ** 2)) / 2;
}

/** Metres that the pelvis must sink so that a pinned foot is in reach. */
function drop([hip, knee, ankle]: Vec3[], offset: Numbers): number {
  const full = length(minus(knee, hip)) + length(minus(ankle, knee));
  const reach = softLimit(length(minus(ankle, hip)), full);
  const aim = minus(add(ankle, offset), hip);
  return -aim[1] - Math.sqrt(Math.max(reach ** 2 - aim[0] ** 2 - aim[2] ** 2, 0));
}

/** A smooth curve nowhere below the values: their running maximum, averaged over the same window. */
function smoothCover(values: number[], half: number): number[] {
  if (values.every((value) => value === 0)) return values.map(() => 0);
  const width = 2 * half + 1;
  const maximum = values.map((_, f) => Math.max(...values.slice(Math.max(f - half, 0), f + half + 1)));
  const kernel = Array.from({ length: width }, (_, i) => 0.5 - 0.5 * Math.cos((2 * Math.PI * (i + 1)) / (width + 1)));
  const total = kernel.reduce((a, b) => a + b);
  return values.map((_, f) =>
    kernel.reduce((sum, weight, i) => sum + (weight / total) * maximum[clamp(f + i - half, 0, values.length - 1)], 0),
  );
}
