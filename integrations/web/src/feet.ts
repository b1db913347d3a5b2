// Foot locking: the ball of a standing foot stays where it stands (motionrt.motion.feet.lock).
import { Motion } from "./motion";
import { add, apply, clamp, dot, length, minus, multiply, rotationBetween, times, transposed, unit, type Numbers, type Vec3 } from "./rotations";
import { JOINTS, joint } from "./skeleton";

const BLEND_S = 0.2; // seconds over which a correction fades
const MAX_DROP = 0.05; // metres that the pelvis may sink for a foot that would not reach
const CLEARANCE = 0.02; // metres above the floor of a toe that swings by
const MAX_SHIFT = 0.1; // metres that a toe is moved in a contact
const DOWN = 0.025; // metres
const CALMER = 0.25;
const LOOSE_SPEED = Math.sqrt(0.002) * 20; // m/s, where guo263 sees a contact
const STRICT_SPEED = LOOSE_SPEED / 2;
const [STRICT_HEIGHT, LOOSE_HEIGHT] = [0.06, 0.09];
const SHORTEST_S = 0.07;
const LEGS = ["left", "right"].map((side) => ["hip", "knee", "ankle", "foot"].map((name) => joint(`${side}_${name}`)));
const SOFT = 0.01;
const [STRAIGHT, BENT] = [0.015, 0.05];

interface Run {
  start: number;
  stop: number;
}

/** Start and stop (exclusive) of every run of true values. */
function runsOf(flags: boolean[]): Run[] {
  const found: Run[] = [];
  flags.forEach((flag, f) => {
    if (flag && (f === 0 || !flags[f - 1])) found.push({ start: f, stop: f + 1 });
    else if (flag) found[found.length - 1].stop = f + 1;
  });
  return found;
}

/** The motion, on the floor, with feet that stand still while they stand and swing clear of the floor. */
export function lockFeet(motion: Motion): Motion {
  const { frames, fps } = motion;
  const positions = motion.positions();
  const at = (f: number, j: number): Vec3 => [0, 1, 2].map((i) => positions[(f * JOINTS + j) * 3 + i]) as Vec3;
  const offsets = LEGS.map((leg) => {
    const toes = Array.from({ length: frames }, (_, f) => at(f, leg[3]));
    const speed = speeds(toes, fps);
    const planted = plantedOf(toes, speed, fps);
    const offset = pinned(toes, planted, speed.map(calm), BLEND_S * fps);
    offset.forEach((way, f) => (way[1] += lift(toes[f][1] + way[1], speed[f])));
    return { planted, offset };
  });
  const needed = Array.from({ length: frames }, (_, f) =>
    clamp(Math.max(...LEGS.map((leg, i) => (offsets[i].planted[f] ? drop(leg.map((j) => at(f, j)), offsets[i].offset[f]) : 0))), 0, MAX_DROP),
  );
  const sinks = smoothCover(needed, Math.max(1, Math.round((BLEND_S * fps) / 2)));
  return bent(motion, offsets.map(({ offset }) => offset), sinks);
}

function speeds(points: Vec3[], fps: number): number[] {
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
  const out = offset.map((way): Vec3 => [...way]);
  for (const { start, stop } of runsOf(planted.map((flag) => !flag))) {
    const span = clamp(stop - start + 1, 1, Math.max(blend, 1));
    for (let f = start; f < stop; f++) {
      if (start > 0) out[f] = add(out[f], tail(offset, start - 1, -1, f - start + 1, span));
      if (stop < toes.length) out[f] = add(out[f], tail(offset, stop, 1, stop - f, span));
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
function lift(height: number, speed: number): number {
  const s = clamp((speed - LOOSE_SPEED) / LOOSE_SPEED, 0, 1);
  const swings = CLEARANCE * s * s * (3 - 2 * s);
  const short = swings - height;
  return (short + Math.sqrt(short * short + (swings / 2) ** 2)) / 2;
}

const softLimit = (distance: number, full: number): number => clamp(distance, full * (1 - SOFT), full * (1 - 1e-5));

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

/** Both feet moved by bending the legs, with the pelvis sunk; the feet keep their global rotations. */
function bent(motion: Motion, offsets: Vec3[][], sinks: number[]): Motion {
  const [rotations, root] = [motion.rotations.slice(), motion.root.slice()];
  const [positions, turned] = [motion.positions(), motion.globalRotations()];
  for (let f = 0; f < motion.frames; f++) {
    root[3 * f + 1] -= sinks[f];
    const global = (j: number): number[] => Array.from(turned.subarray((f * JOINTS + j) * 9, (f * JOINTS + j) * 9 + 9));
    LEGS.forEach(([hip, knee, ankle], i) => {
      const chain = [hip, knee, ankle].map((j): Vec3 => [0, 1, 2].map((k) => positions[(f * JOINTS + j) * 3 + k] - (k === 1 ? sinks[f] : 0)) as Vec3);
      const way = add(offsets[i][f], [0, sinks[f], 0]);
      const thigh = global(hip);
      const [upper, lower] = twoBone(chain, [thigh, global(knee)], add(chain[2], way), [thigh[2], thigh[5], thigh[8]]);
      const put = (j: number, m: number[]): void => rotations.set(m, (f * JOINTS + j) * 9);
      put(hip, multiply(transposed(global(0)), upper));
      put(knee, multiply(transposed(upper), lower));
      put(ankle, multiply(transposed(lower), global(ankle)));
    });
  }
  return new Motion(rotations, root, motion.fps);
}

/** New global rotations of the two bones of a limb whose end is brought to `target`. */
function twoBone([start, middle, end]: Vec3[], rotations: number[][], target: Vec3, pole: Vec3): [number[], number[]] {
  const [upper, lower] = [minus(middle, start), minus(end, middle)];
  const [line, way] = [minus(end, start), minus(target, start)];
  const [a, b] = [length(upper), length(lower)];
  const distance = Math.max(softReach(length(way), length(line), a + b), Math.abs(a - b) * (1 + 1e-6) + 1e-9);
  const swing = rotationBetween(line, way);
  const share = (a ** 2 - b ** 2 + distance ** 2) / (2 * distance);
  const height = Math.sqrt(Math.max(a ** 2 - share ** 2, 0));
  const along = unit(apply(swing, line));
  const newMiddle = add(start, add(times(along, share), times(apply(swing, bendOf(upper, line, pole, height, a + b)), height)));
  const newEnd = add(start, times(along, distance));
  const bones = [minus(newMiddle, start), minus(newEnd, newMiddle)];
  return [upper, lower].map((bone, i) => multiply(rotationBetween(apply(swing, bone), bones[i]), multiply(swing, rotations[i]))) as [number[], number[]];
}

function softReach(wanted: number, now: number, full: number): number {
  const limit = softLimit(now, full);
  const room = full - limit;
  return wanted > limit ? limit + room * -Math.expm1(-(wanted - limit) / room) : wanted;
}

function bendOf(upper: Vec3, given: Vec3, pole: Vec3, height: number, full: number): Vec3 {
  const line = unit(given);
  const orthogonal = (vector: Vec3): Vec3 => minus(vector, times(line, dot(vector, line)));
  const off = orthogonal(upper);
  const guide = unit(orthogonal(pole));
  const now = length(off);
  const straight = clamp((BENT * full - now) / ((BENT - STRAIGHT) * full), 0, 1);
  return unit(add(off, times(guide, 4 * straight * Math.max(height - now, 0) + 1e-9)));
}

