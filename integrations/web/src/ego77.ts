// `ego77`, what the generator sees at 20 fps: turn and way of the root, height, joints about the body, contacts.
import { JOINTS, joint } from "./skeleton";

export const WIDTH = 77;
export const FPS = 20;
export const CONTACTS = 73; // first column of those of left and right ankle, left and right toe

/** The first of the three columns of a joint other than the pelvis. */
export const columnOf = (name: string): number => 4 + 3 * (joint(name) - 1);

/** Features F x 77 to joints F x 24 x 3 in metres; the first frame stands above the origin and faces +Z. */
export function decode(rows: Float32Array | Float64Array): Float64Array {
  const frames = rows.length / WIDTH;
  const joints = new Float64Array(frames * JOINTS * 3);
  let [yaw, x, z] = [0, 0, 0];
  for (let f = 0; f < frames; f++) {
    const row = rows.subarray(f * WIDTH, (f + 1) * WIDTH);
    const [c, s] = [Math.cos(yaw), Math.sin(yaw)];
    joints.set([x, row[3], z], f * JOINTS * 3);
    for (let j = 1; j < JOINTS; j++) {
      const at = 4 + 3 * (j - 1);
      joints.set([row[at] * c + row[at + 2] * s + x, row[at + 1], -row[at] * s + row[at + 2] * c + z], (f * JOINTS + j) * 3);
    }
    x += row[1] * c + row[2] * s;
    z += -row[1] * s + row[2] * c;
    yaw += row[0];
  }
  return joints;
}

/** Rows F x D at times in frames, along Catmull-Rom splines, which pass through every one of them. */
export function between(values: Float64Array, width: number, times: number[]): Float64Array {
  const last = values.length / width - 1;
  const out = new Float64Array(times.length * width);
  times.forEach((time, row) => {
    const before = Math.min(Math.floor(time), Math.max(last - 1, 0));
    const u = time - before;
    const [i, j, k, l] = [-1, 0, 1, 2].map((step) => Math.min(Math.max(before + step, 0), last) * width);
    for (let n = 0; n < width; n++) {
      const [a, b, c, d] = [values[i + n], values[j + n], values[k + n], values[l + n]];
      out[row * width + n] = b + 0.5 * u * (c - a + u * (2 * a - 5 * b + 4 * c - d + u * (3 * (b - c) + d - a)));
    }
  });
  return out;
}

/** Features F x D smoothed in time by a normal distribution of 0.8 frames; the ends stay. */
export function smoothed(rows: Float32Array, width = WIDTH): Float32Array {
  const frames = rows.length / width;
  const reach = Math.min(3, frames - 1);
  if (reach < 1) return rows;
  const weights = Array.from({ length: 2 * reach + 1 }, (_, i) => Math.exp(-0.5 * ((i - reach) / 0.8) ** 2));
  const total = weights.reduce((a, b) => a + b);
  const shares = weights.map((weight) => Math.fround(weight / total));
  const at = (f: number, n: number): number => {
    if (f < 0) return Math.fround(2 * rows[n] - rows[-f * width + n]);
    if (f >= frames) return Math.fround(2 * rows[(frames - 1) * width + n] - rows[(2 * frames - 2 - f) * width + n]);
    return rows[f * width + n];
  };
  const out = new Float32Array(rows.length);
  for (let f = 0; f < frames; f++)
    for (let n = 0; n < width; n++) {
      let sum = 0;
      shares.forEach((share, i) => (sum = Math.fround(sum + Math.fround(share * at(f + i - reach, n)))));
      out[f * width + n] = sum;
    }
  return out;
}
