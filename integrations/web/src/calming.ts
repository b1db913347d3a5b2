// Limbs do what a text says: who stands still is still, one arm waves where one is named, punches reach out.
import { columnOf, FPS, WIDTH } from "./ego77";
import { gesturesOf } from "./gestures";
import { clamp, length } from "./rotations";
import { joint, OFFSETS, PARTS } from "./skeleton";
import type { Said } from "./words";

const [STILL, ONE_ARM, LEAST] = [0.1, 0.55, 0.15]; // m/s of who stands still; speed of the other hand; part that is left
const [STRETCHED, LARGEST, SMALLEST] = [0.97, 3, 0.02]; // of an arm; times as far at most; metres that are worth it
const [FASTER, SHORT] = [1.01, 1e-3]; // times too fast and metres too short that are let be, so that no rounding decides

/** Change features F x 77 in place to what a text wants of limbs; the parts that were changed. */
export function calm(rows: Float32Array, said: Said): boolean[] {
  const parts = PARTS.map(() => false);
  if (rows.length < 2 * WIDTH) return parts;
  if (said.still) {
    const speed = Math.max(...["left", "right"].flatMap((side) => ["wrist", "ankle"].map((name) => speedOf(rows, `${side}_${name}`))));
    if (speed <= FASTER * STILL) return parts;
    const part = Math.max(LEAST, STILL / speed);
    scale(rows, Array.from({ length: WIDTH - 4 }, (_, i) => i), part);
    for (let i = 0; i < rows.length; i += WIDTH) for (let k = 0; k < 3; k++) rows[i + k] *= part;
    return parts.map(() => true);
  }
  const side = handOf(said);
  if (side) favour(rows, parts, side);
  if (said.action === "punch" || said.action === "throw")
    for (const side of ["left", "right"])
      if ((!said.arm || said.arm === "both" || said.arm === side) && thrust(rows, side)) parts[PARTS.indexOf(`${side} arm`)] = true;
  return parts;
}

/** The one hand that does what a text says. */
function handOf(said: Said): string | null {
  if (said.arm === "left" || said.arm === "right") return said.arm;
  const hands = said.arm ? [] : gesturesOf(said).hands;
  return hands.length === 1 ? hands[0][0] : null;
}

/** Stretch an arm where it reaches out farthest. */
function thrust(rows: Float32Array, side: string): boolean {
  const [shoulder, elbow, wrist, hand] = ["shoulder", "elbow", "wrist", "hand"].map((name) => columnOf(`${side}_${name}`));
  const [upper, lower] = ["elbow", "wrist"].map((name) => length(OFFSETS[joint(`${side}_${name}`)]));
  const full = STRETCHED * (upper + lower);
  const frames = rows.length / WIDTH;
  const away = Array.from({ length: frames }, (_, f) => [0, 1, 2].map((i) => rows[f * WIDTH + wrist + i] - rows[f * WIDTH + shoulder + i]));
  const reach = away.map((way) => Math.max(length(way), 1e-3));
  const sorted = [...reach].sort((a, b) => a - b);
  const usual = (sorted[(frames - 1) >> 1] + sorted[frames >> 1]) / 2;
  const farthest = sorted[frames - 1];
  if (farthest > full - SHORT || farthest - usual < SMALLEST) return false;
  const times = Math.min(LARGEST, (full - usual) / (farthest - usual));
  away.forEach((way, f) => {
    const farther = reach[f] > usual ? usual + times * (reach[f] - usual) : reach[f];
    const straight = clamp((farther - reach[f]) / (full - reach[f]), 0, 1);
    way.forEach((value, i) => {
      const moved = value * (farther / reach[f]);
      const at = f * WIDTH + i;
      const along = rows[at + shoulder] + moved * (upper / (upper + lower));
      rows[at + elbow] += straight * (along - rows[at + elbow]);
      rows[at + wrist] += moved - value;
      rows[at + hand] += moved - value;
    });
  });
  return true;
}

/** Calm the other arm where it moves as much as the one that is named. */
function favour(rows: Float32Array, parts: boolean[], side: string): void {
  const other = side === "left" ? "right" : "left";
  const [named, leftOut] = [side, other].map((one) => speedOf(rows, `${one}_wrist`, `${one}_shoulder`));
  if (leftOut <= FASTER * ONE_ARM * named) return;
  const arm = ["elbow", "wrist", "hand"].flatMap((name) => [0, 1, 2].map((i) => columnOf(`${other}_${name}`) + i));
  const base = columnOf(`${other}_shoulder`);
  const shift = (sign: number): void => {
    for (let at = 0; at < rows.length; at += WIDTH) arm.forEach((column, i) => (rows[at + column] += sign * rows[at + base + (i % 3)]));
  };
  shift(-1);
  scale(rows, arm, Math.max(LEAST, (ONE_ARM * named) / leftOut));
  shift(1);
  parts[PARTS.indexOf(`${other} arm`)] = true;
}

/** Scale how far columns are from their means over time. */
function scale(rows: Float32Array, columns: number[], part: number): void {
  const frames = rows.length / WIDTH;
  for (const column of columns) {
    let mean = 0;
    for (let f = 0; f < frames; f++) mean += rows[f * WIDTH + column] / frames;
    for (let f = 0; f < frames; f++) rows[f * WIDTH + column] = mean + part * (rows[f * WIDTH + column] - mean);
  }
}

/** Mean speed of a joint in the axes of the body, or about another joint, m/s. */
function speedOf(rows: Float32Array, name: string, about?: string): number {
  const [column, base] = [columnOf(name), about ? columnOf(about) : -1];
  const frames = rows.length / WIDTH;
  const at = (f: number, i: number): number => rows[f * WIDTH + column + i] - (base < 0 ? 0 : rows[f * WIDTH + base + i]);
  let sum = 0;
  for (let f = 1; f < frames; f++) sum += Math.hypot(...[0, 1, 2].map((i) => at(f, i) - at(f - 1, i)));
  return (sum / (frames - 1)) * FPS;
}
