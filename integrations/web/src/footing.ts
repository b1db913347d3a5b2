// Whoever stays on the spot is carried by the feet that stand: the root goes so that they do not slide.
import { columnOf, CONTACTS, smoothed, WIDTH } from "./ego77";
import { clamp } from "./rotations";
import type { Said } from "./words";

const [ON_THE_SPOT, GOING] = [1, 0.3]; // how far the root is carried
const [LOW, SPREAD] = [[0.13, 0.13, 0.08, 0.08], 0.03]; // metres up to which ankles and toes stand, and a little above
const FEET = ["left_ankle", "right_ankle", "left_foot", "right_foot"].map(columnOf);

/** How far the feet carry the root of a motion: 1 wholly, 0 not at all. */
export function shareOf(said: Said): number {
  if (said.jumps || (said.path && said.path !== "straight" && said.path !== "spin")) return 0;
  return !said.travel || said.travel === "none" ? ON_THE_SPOT : GOING;
}

/** Features F x 77 whose root goes, by a share of 0 to 1, as the feet in contact want it. */
export function carried(rows: Float32Array, share: number): Float32Array {
  const frames = rows.length / WIDTH;
  const ways = new Float32Array(frames * 2);
  for (let f = 0; f < frames - 1; f++) {
    const [now, next] = [f * WIDTH, (f + 1) * WIDTH];
    const [c, s] = [Math.cos(rows[now]), Math.sin(rows[now])];
    let [total, left, forward] = [0, 0, 0];
    FEET.forEach((column, i) => {
      const [x, y, z] = [0, 1, 2].map((k) => rows[now + column + k]);
      const [toX, toZ] = [rows[next + column], rows[next + column + 2]];
      const stands = clamp(rows[now + CONTACTS + i], 0, 1) ** 2 * Math.exp(-Math.max(y - LOW[i], 0) / SPREAD);
      total += stands;
      left += stands * (x - (toX * c + toZ * s));
      forward += stands * (z - (toZ * c - toX * s));
    });
    const part = share * clamp(total, 0, 1);
    ways[2 * f] = (1 - part) * rows[now + 1] + (part * left) / Math.max(total, 1e-6);
    ways[2 * f + 1] = (1 - part) * rows[now + 2] + (part * forward) / Math.max(total, 1e-6);
  }
  ways.copyWithin(2 * frames - 2, 2 * frames - 4, 2 * frames - 2);
  const smooth = smoothed(ways, 2);
  return rows.map((value, i) => (i % WIDTH === 1 || i % WIDTH === 2 ? smooth[2 * Math.floor(i / WIDTH) + (i % WIDTH) - 1] : value));
}
