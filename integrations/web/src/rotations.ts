// Vectors of three numbers and 3x3 matrices of nine, row by row.

export type Vec3 = [number, number, number];
export type Numbers = ArrayLike<number>;

export const add = (a: Numbers, b: Numbers): Vec3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const minus = (a: Numbers, b: Numbers): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const times = (a: Numbers, s: number): Vec3 => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a: Numbers, b: Numbers): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Numbers, b: Numbers): Vec3 => [
  a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0],
];
export const length = (a: Numbers): number => Math.sqrt(dot(a, a));
export const unit = (a: Numbers): Vec3 => {
  const size = length(a);
  return times(a, size < 1e-12 ? 1 : 1 / size);
};
export const clamp = (value: number, low: number, high: number): number => Math.min(Math.max(value, low), high);

export const IDENTITY: readonly number[] = [1, 0, 0, 0, 1, 0, 0, 0, 1];

export function multiply(a: Numbers, b: Numbers): number[] {
  const out = new Array<number>(9);
  for (let i = 0; i < 3; i++)
    for (let j = 0; j < 3; j++) out[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
  return out;
}

export const transposed = (m: Numbers): number[] => [m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]];

export const apply = (m: Numbers, v: Numbers): Vec3 => [
  m[0] * v[0] + m[1] * v[1] + m[2] * v[2],
  m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
  m[6] * v[0] + m[7] * v[1] + m[8] * v[2],
];

/** Yaw: `angle` radians from +Z towards +X. */
export function aboutY(angle: number): number[] {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return [c, 0, s, 0, 1, 0, -s, 0, c];
}

/** Columns to a matrix. */
export const columns = (x: Numbers, y: Numbers, z: Numbers): number[] => [x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]];

/** The smallest rotation that turns one direction into another; half a turn about some axis for opposite ones. */
export function rotationBetween(source: Numbers, target: Numbers): number[] {
  const a = unit(source);
  let half: Vec3 = add(a, unit(target));
  const opposite = length(half) < 1e-6;
  if (opposite) half = cross(a, Math.abs(a[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0]);
  half = unit(half);
  const out = new Array<number>(9);
  const flip = minus(times(a, 2 * dot(half, a)), half);
  for (let i = 0; i < 3; i++)
    for (let j = 0; j < 3; j++)
      out[3 * i + j] = (opposite ? 2 * half[i] * half[j] - 0 : 2 * (half[i] * flip[j] - a[i] * a[j])) + (i === j ? (opposite ? -1 : 1) : 0);
  return out;
}

/** Replaces nine numbers from `at` on by the nearest rotation (Frobenius norm): the polar factor, by Newton's iteration; false far from any. */
export function turnNearest(m: Float64Array, at: number): boolean {
  let [a, b, c, d, e, f, g, h, i] = [m[at], m[at + 1], m[at + 2], m[at + 3], m[at + 4], m[at + 5], m[at + 6], m[at + 7], m[at + 8]];
  for (let step = 0; step < 30; step++) {
    const [A, B, C] = [e * i - f * h, f * g - d * i, d * h - e * g]; // cofactors
    const [D, E, F] = [c * h - b * i, a * i - c * g, b * g - a * h];
    const [G, H, I] = [b * f - c * e, c * d - a * f, a * e - b * d];
    const determinant = a * A + b * B + c * C;
    if (!(determinant > 1e-9)) return false;
    const [a1, b1, c1] = [(a + A / determinant) / 2, (b + B / determinant) / 2, (c + C / determinant) / 2];
    const [d1, e1, f1] = [(d + D / determinant) / 2, (e + E / determinant) / 2, (f + F / determinant) / 2];
    const [g1, h1, i1] = [(g + G / determinant) / 2, (h + H / determinant) / 2, (i + I / determinant) / 2];
    const change = Math.max(
      Math.abs(a1 - a), Math.abs(b1 - b), Math.abs(c1 - c), Math.abs(d1 - d), Math.abs(e1 - e), Math.abs(f1 - f),
      Math.abs(g1 - g), Math.abs(h1 - h), Math.abs(i1 - i),
    );
    [a, b, c, d, e, f, g, h, i] = [a1, b1, c1, d1, e1, f1, g1, h1, i1];
    if (change < 1e-15) break;
  }
  m[at] = a, m[at + 1] = b, m[at + 2] = c, m[at + 3] = d, m[at + 4] = e, m[at + 5] = f, m[at + 6] = g, m[at + 7] = h, m[at + 8] = i;
  return true;
}

/** Unit quaternion [w, x, y, z] with w >= 0. */
export function quaternionOf(m: Numbers): number[] {
  const trace = m[0] + m[4] + m[8];
  const sizes = [trace, m[0], m[4], m[8]];
  const best = sizes.indexOf(Math.max(...sizes));
  const [x, y, z] = [m[7] - m[5], m[2] - m[6], m[3] - m[1]];
  const [xy, xz, yz] = [m[1] + m[3], m[2] + m[6], m[5] + m[7]];
  const rows = [
    [1 + trace, x, y, z],
    [x, 1 + 2 * m[0] - trace, xy, xz],
    [y, xy, 1 + 2 * m[4] - trace, yz],
    [z, xz, yz, 1 + 2 * m[8] - trace],
  ];
  const q = rows[best];
  const size = Math.hypot(...q) * (q[0] < 0 ? -1 : 1);
  return q.map((value) => value / size);
}

export function matrixOf([w, x, y, z]: Numbers & number[]): number[] {
  return [
    1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
    2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
    2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y),
  ];
}

/** Constant-speed interpolation between quaternions, the shorter way. */
export function slerp(a: number[], b: number[], weight: number): number[] {
  let cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  const sign = cosine < 0 ? -1 : 1;
  cosine = Math.min(Math.abs(cosine), 1);
  const angle = Math.acos(cosine);
  const sine = Math.sin(angle);
  const [p, q] = sine < 1e-4 ? [1 - weight, weight] : [Math.sin((1 - weight) * angle) / sine, Math.sin(weight * angle) / sine];
  const mixed = a.map((value, i) => p * value + q * sign * b[i]);
  const size = Math.hypot(...mixed);
  return mixed.map((value) => value / size);
}

/** Intrinsic Z, X, Y angles in degrees: what the rotation channels of a BVH file say. */
export function eulerZXY(m: Numbers): Vec3 {
  const degrees = 180 / Math.PI;
  const x = Math.asin(clamp(m[7], -1, 1));
  if (Math.hypot(m[1], m[4]) < 1e-6) return [Math.atan2(m[3], m[0]) * degrees, x * degrees, 0];
  return [Math.atan2(-m[1], m[4]) * degrees, x * degrees, Math.atan2(-m[6], m[8]) * degrees];
}

/** The same angle in [-pi, pi). */
export const wrapped = (angle: number): number => ((((angle + Math.PI) % (2 * Math.PI)) + 2 * Math.PI) % (2 * Math.PI)) - Math.PI;
