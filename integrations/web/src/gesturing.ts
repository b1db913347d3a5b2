// Gestures whose course is plain are made as it is: hands are led by their wrists, trunks bow, knees come up (motionrt.synthesis.gesturing).
import { type Held, nothing } from "./canvas";
import { CONTACTS, columnOf, FPS, WIDTH } from "./ego77";
import { type Gesture, gesturesOf } from "./gestures";
import { add, clamp, dot, length, minus, type Numbers, times, type Vec3 } from "./rotations";
import { joint, OFFSETS, PARTS } from "./skeleton";
import type { Said } from "./words";

const [BEGINS, BEGINS_S, RAMP_S] = [0.15, 0.5, 0.5]; // when a gesture begins: part of the motion, seconds at most; its fading
const FULL = 0.985; // of the length of a limb that it is stretched to at most
const [BOW, BOW_AT, BOW_S] = [0.95, 0.45, 1]; // radians that a trunk bows, when it is lowest, and how long it goes down and up
const [STEP_HZ, STEP_UP, STEP_AHEAD] = [0.9, 0.3, 0.12]; // pairs of marching steps a second, and metres that feet are lifted
const [HELD_UP, HELD_AHEAD] = [0.35, -0.1]; // metres that a foot is held up
const [HIGH, LOW, LOW_KNEE, FRONT] = [0.62, 0.5, 0.12, 0.33]; // pelvis heights between which knees go down; knee; foot in front
const [LIES_HIGH, LIES_LOW, FLAT, ON_FLOOR] = [0.34, 0.18, 1.5, 0.05]; // pelvis heights between which a trunk lies down; its lean; its joints, at least
const UPRIGHT = 0.22; // radians that the trunk of somebody who stands and gestures leans, at most
const [UP_FROM, UP_TO, BENT] = [0.6, 0.8, 0.4]; // pelvis heights between which a trunk that will lie is kept up; its lean then, at most
const STANDS = 0.09; // metres that the ankle of a standing foot is above the floor
const ELBOW: Vec3 = [0.4, -0.9, -0.3]; // out, up, ahead: where elbows point where nothing else is seen
const KNEE: Vec3 = [0.1, 0, 1];
const SIDES = ["left", "right"];
const TRUNK = ["spine1", "spine2", "spine3", "neck", "head", ...SIDES.flatMap((side) => ["collar", "shoulder", "elbow", "wrist", "hand"].map((name) => `${side}_${name}`))];

/** Frames at 20 fps, F x 77. */
class Rows {
  readonly frames: number;
  readonly last: number; // seconds of the last frame

  constructor(readonly values: Float64Array) {
    this.frames = values.length / WIDTH;
    this.last = (this.frames - 1) / FPS;
  }

  at(frame: number, name: string): Vec3 {
    const first = frame * WIDTH + columnOf(name);
    return [this.values[first], this.values[first + 1], this.values[first + 2]];
  }

  put(frame: number, name: string, place: Numbers): void {
    this.values.set(place, frame * WIDTH + columnOf(name));
  }

  height(frame: number): number {
    return this.values[frame * WIDTH + 3];
  }
}

/** Features F x 77 with the gestures of a text, and which parts of which frames they are. */
export function gestured(features: Float32Array, said: Said): Held {
  const rows = new Rows(Float64Array.from(features));
  const { parts } = nothing(rows.frames);
  const lead = (part: string, led: boolean[]): void => led.forEach((flag, f) => flag && (parts[f * PARTS.length + PARTS.indexOf(part)] = 1));
  const found = gesturesOf(said);
  if (found.bows) {
    const led = bow(rows);
    for (const part of ["torso", "left arm", "right arm"]) lead(part, led);
  }
  if (found.lies || found.stands) {
    const led = found.lies ? lying(rows) : upright(rows);
    for (const part of ["torso", "left arm", "right arm"]) lead(part, led);
  }
  for (const [side, gesture] of found.hands) lead(`${side} arm`, hand(rows, side, gesture, said));
  if (found.marches || found.lifted) for (const side of SIDES) if (!found.lifted || found.lifted === side) lead(`${side} leg`, foot(rows, side, found.marches));
  if (found.kneels) for (const side of SIDES) lead(`${side} leg`, kneeling(rows, side, found.kneels === side || found.kneels === "both"));
  return { motion: Float32Array.from(rows.values), parts };
}

/** Lead a hand; in place. The frames in which it is led. */
function hand(rows: Rows, side: string, gesture: Gesture, said: Said): boolean[] {
  const course = courseOf(rows, gesture, said);
  const out = side === "left" ? 1 : -1;
  const ways = course.map(({ share }) => placeAt(gesture.places, share));
  const phase = gesture.alternate && side === "left" ? Math.PI : 0;
  return course.map(({ weight }, f) => {
    if (weight <= 0) return false;
    const turn = (2 * Math.PI * gesture.hz * f) / FPS + phase;
    const swung = add(times(gesture.swing, Math.sin(turn)), times(gesture.swirl, Math.cos(turn)));
    const [x, y, z] = add(eased(ways, f), swung);
    const [shoulder, elbow, wrist, tip] = ["shoulder", "elbow", "wrist", "hand"].map((name) => rows.at(f, `${side}_${name}`));
    const base = gesture.about === "head" ? rows.at(f, "head") : shoulder;
    const aim = towards(wrist, add(base, [out * x, y, z]), weight);
    const [bent, end] = limb(shoulder, elbow, aim, [`${side}_elbow`, `${side}_wrist`], [out * ELBOW[0], ELBOW[1], ELBOW[2]]);
    const forearm = minus(end, bent);
    const held = minus(tip, wrist);
    const straight = times(forearm, length(held) / length(forearm));
    rows.put(f, `${side}_elbow`, bent);
    rows.put(f, `${side}_wrist`, end);
    rows.put(f, `${side}_hand`, add(end, towards(held, straight, weight)));
    return true;
  });
}

/** In every frame the share of a gesture that is done, and how much the hand follows it, 0 to 1. */
function courseOf({ frames, last }: Rows, gesture: Gesture, said: Said): { share: number; weight: number }[] {
  let [first, lasts, whole, ramp] = [Math.min(BEGINS * last, BEGINS_S), Infinity, 0, Math.min(RAMP_S, last / 4)];
  if (gesture.once_s) {
    lasts = whole = Math.min(gesture.once_s, 0.9 * last);
    first = (last - lasts) / 2;
    ramp = Math.min(RAMP_S / 2, lasts / 4);
  } else {
    const count = gesture.hz ? Math.max(said.claps || 0, said.repeats || 0) : 0;
    if (count > 0) lasts = count / gesture.hz + RAMP_S;
    whole = last - first;
  }
  return Array.from({ length: frames }, (_, f) => {
    const time = f / FPS;
    const [rises, falls] = [(time - first) / Math.max(ramp, 1e-6), (first + lasts - time) / Math.max(ramp, 1e-6)];
    return { share: clamp((time - first) / Math.max(whole, 1e-6), 0, 1), weight: smooth(Math.min(rises, falls)) };
  });
}

/** Between the places of a gesture, [share of it, out, up, ahead]. */
function placeAt(places: number[][], share: number): Vec3 {
  const next = places.findIndex(([at]) => at > share);
  const [a, b] = next < 0 ? [places[places.length - 1], places[places.length - 1]] : [places[Math.max(next - 1, 0)], places[next]];
  const u = a === b ? 0 : (share - a[0]) / (b[0] - a[0]);
  return [1, 2, 3].map((i) => a[i] + u * (b[i] - a[i])) as Vec3;
}

/** A way without corners: a running mean over five frames. */
function eased(ways: Vec3[], frame: number): Vec3 {
  const around = [-2, -1, 0, 1, 2].map((k) => ways[clamp(frame + k, 0, ways.length - 1)]);
  return times(around.reduce((sum, way) => add(sum, way)), 1 / 5);
}

/** Bow the trunk about the pelvis, further than it is by as much as is missing; in place. */
function bow(rows: Rows): boolean[] {
  const lowest = BOW_AT * rows.last;
  return Array.from({ length: rows.frames }, (_, f) => {
    const pelvis: Vec3 = [0, rows.height(f), 0];
    const [, up, ahead] = minus(rows.at(f, "neck"), pelvis);
    const off = smooth(1.6 - Math.abs(f / FPS - lowest) / BOW_S) * BOW - Math.atan2(ahead, up);
    const [c, s] = [Math.cos(off), Math.sin(off)];
    for (const name of TRUNK) {
      const [x, y, z] = minus(rows.at(f, name), pelvis);
      rows.put(f, name, add(pelvis, [x, c * y - s * z, s * y + c * z]));
    }
    return true;
  });
}

/** Bring a trunk upright that leans too far; in place. The frames of it. */
function upright(rows: Rows): boolean[] {
  return Array.from({ length: rows.frames }, (_, f) => {
    const pelvis: Vec3 = [0, rows.height(f), 0];
    const [, up, ahead] = minus(rows.at(f, "neck"), pelvis);
    const lean = Math.atan2(ahead, up);
    const off = clamp(lean, -UPRIGHT, UPRIGHT) - lean;
    if (Math.abs(off) <= 1e-3) return false;
    const [c, s] = [Math.cos(off), Math.sin(off)];
    for (const name of TRUNK) {
      const [x, y, z] = minus(rows.at(f, name), pelvis);
      rows.put(f, name, add(pelvis, [x, c * y - s * z, s * y + c * z]));
    }
    return true;
  });
}

/** Lay the trunk on the floor while the pelvis is there, to the side that it leans to, and keep it up before; in place. The frames of it. */
function lying(rows: Rows): boolean[] {
  const weights = Array.from({ length: rows.frames }, (_, f) => smooth((LIES_HIGH - rows.height(f)) / (LIES_HIGH - LIES_LOW)));
  const trunks = weights.map((_, f) => minus(rows.at(f, "neck"), [0, rows.height(f), 0]));
  const ahead = weights.reduce((sum, weight, f) => sum + weight * trunks[f][2], 0) > 0 ? 1 : -1;
  return weights.map((weight, f) => {
    const up = smooth((rows.height(f) - UP_FROM) / (UP_TO - UP_FROM));
    if (weight + up <= 0) return false;
    const lean = Math.atan2(trunks[f][2], trunks[f][1]);
    const off = weight * (ahead * lean < FLAT ? ahead * FLAT - lean : 0) + up * (clamp(lean, -BENT, BENT) - lean);
    const [c, s, pelvis] = [Math.cos(off), Math.sin(off), rows.height(f)];
    for (const name of TRUNK) {
      const [x, y, z] = minus(rows.at(f, name), [0, pelvis, 0]);
      const high = pelvis + c * y - s * z;
      rows.put(f, name, [x, high + weight * (Math.max(high, ON_FLOOR) - high), s * y + c * z]);
    }
    return true;
  });
}

/** Lift a foot, again and again or to keep it up; in place. The frames in which its leg is led. */
function foot(rows: Rows, side: string, marches: boolean): boolean[] {
  const begins = Math.min(BEGINS * rows.last, BEGINS_S);
  return Array.from({ length: rows.frames }, (_, f) => {
    const weight = smooth((f / FPS - begins) / RAMP_S);
    if (weight <= 0) return false;
    const lifted = Math.max(Math.sin((2 * Math.PI * STEP_HZ * f) / FPS + (side === "left" ? Math.PI : 0)), 0) ** 1.5;
    const [hip, knee, ankle, toe] = ["hip", "knee", "ankle", "foot"].map((name) => rows.at(f, `${side}_${name}`));
    const up = marches ? STEP_UP * lifted : HELD_UP;
    const aim = towards(ankle, [hip[0], STANDS + up, marches ? STEP_AHEAD * lifted : hip[2] + HELD_AHEAD], weight);
    const [bent, end] = limb(hip, knee, aim, [`${side}_knee`, `${side}_ankle`], KNEE);
    rows.put(f, `${side}_knee`, bent);
    rows.put(f, `${side}_ankle`, end);
    rows.put(f, `${side}_foot`, add(end, minus(toe, ankle)));
    if (up > STANDS / 2) for (const contact of [0, 2]) rows.values[f * WIDTH + CONTACTS + contact + (side === "right" ? 1 : 0)] = 0;
    return true;
  });
}

/** Bring a knee to the floor, or the foot in front of it, while the pelvis is low; in place. The frames of it. */
function kneeling(rows: Rows, side: string, down: boolean): boolean[] {
  const names = ["knee", "ankle", "foot"].map((name) => `${side}_${name}`);
  return Array.from({ length: rows.frames }, (_, f) => {
    const weight = smooth((HIGH - rows.height(f)) / (HIGH - LOW));
    if (weight <= 0) return false;
    const now = names.map((name) => rows.at(f, name));
    const hip = rows.at(f, `${side}_hip`);
    const then = down ? knelt(hip, side) : inFront(hip, now[0], side);
    names.forEach((name, i) => rows.put(f, name, towards(now[i], then[i], weight)));
    return true;
  });
}

/** Knee, ankle and toe of a leg whose knee is on the floor below the hip. */
function knelt(hip: Vec3, side: string): Vec3[] {
  const [thigh, shin] = ["knee", "ankle"].map((name) => length(OFFSETS[joint(`${side}_${name}`)]));
  const drop = clamp(hip[1] - LOW_KNEE, 0, FULL * thigh);
  const knee = add(hip, [0, -drop, Math.sqrt(thigh ** 2 - drop ** 2)]);
  const heel: Vec3 = [knee[0], STANDS, knee[2] - 0.99 * shin];
  return [knee, heel, add(heel, [0, -0.05, -0.14])];
}

/** Knee, ankle and toe of a leg whose foot stands in front. */
function inFront(hip: Vec3, knee: Vec3, side: string): Vec3[] {
  const [bent, heel] = limb(hip, knee, [hip[0], STANDS, hip[2] + FRONT], [`${side}_knee`, `${side}_ankle`], KNEE);
  return [bent, heel, add(heel, OFFSETS[joint(`${side}_foot`)])];
}

/** Middle and end joint of a limb that reaches for `aim`, bent to where it is bent, or to the pole. */
function limb(start: Vec3, middle: Vec3, aim: Vec3, bones: [string, string], pole: Vec3): [Vec3, Vec3] {
  const [a, b] = bones.map((name) => length(OFFSETS[joint(name)]));
  const way = minus(aim, start);
  const far = Math.max(length(way), 1e-6);
  const along = times(way, 1 / far);
  const reach = clamp(far, Math.abs(a - b) + 0.02, FULL * (a + b));
  const share = (a * a - b * b + reach * reach) / (2 * reach);
  const bends = add(minus(middle, start), times(pole, 0.3));
  const off = minus(bends, times(along, dot(bends, along)));
  const height = Math.sqrt(Math.max(a * a - share * share, 0));
  const bent = add(add(start, times(along, share)), times(off, height / Math.max(length(off), 1e-6)));
  return [bent, add(start, times(along, reach))];
}

const towards = (from: Vec3, to: Vec3, weight: number): Vec3 => add(from, times(minus(to, from), weight));

function smooth(share: number): number {
  const s = clamp(share, 0, 1);
  return s * s * (3 - 2 * s);
}
