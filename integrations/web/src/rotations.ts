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

/** The nearest rotation (Frobenius norm): the polar factor, by Newton's iteration; null far from any. */
export function nearestRotation(m: Numbers): number[] | null {
  let x = Array.from(m);
  for (let step = 0; step < 30; step++) {
    const c = [
      x[4] * x[8] - x[5] * x[7], x[5] * x[6] - x[3] * x[8], x[3] * x[7] - x[4] * x[6],
      x[2] * x[7] - x[1] * x[8], x[0] * x[8] - x[2] * x[6], x[1] * x[6] - x[0] * x[7],
      x[1] * x[5] - x[2] * x[4], x[2] * x[3] - x[0] * x[5], x[0] * x[4] - x[1] * x[3],
    ];
    const determinant = x[0] * c[0] + x[1] * c[1] + x[2] * c[2];
    if (!(determinant > 1e-9)) return null;
    let change = 0;
    for (let i = 0; i < 9; i++) {
      const next = (x[i] + c[i] / determinant) / 2;
      change = Math.max(change, Math.abs(next - x[i]));
      x[i] = next;
    }
    if (change < 1e-15) break;
  }
  return x;
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
