// 3x3 matrices as arrays of nine numbers, row by row.

export function multiply(a, b) {
  const out = new Array(9);
  for (let i = 0; i < 3; i++)
    for (let j = 0; j < 3; j++) out[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
  return out;
}

export function apply(m, [x, y, z]) {
  return [m[0] * x + m[1] * y + m[2] * z, m[3] * x + m[4] * y + m[5] * z, m[6] * x + m[7] * y + m[8] * z];
}

/** Yaw: `angle` radians from +Z towards +X. */
export function aboutY(angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return [c, 0, s, 0, 1, 0, -s, 0, c];
}

/**
 * The nearest rotation in the Frobenius norm: the orthogonal factor of the polar decomposition, by Newton's iteration
 * X <- (X + X^-T) / 2. It converges quadratically; what a network predicts is near a rotation, so six steps are plenty.
 */
export function nearestRotation(m) {
  let x = Array.from(m);
  for (let step = 0; step < 30; step++) {
    const inverse = cofactors(x);
    const determinant = x[0] * inverse[0] + x[1] * inverse[1] + x[2] * inverse[2];
    if (!(determinant > 1e-9)) throw new Error(`a matrix far from any rotation (determinant ${determinant})`);
    let change = 0;
    x = x.map((value, i) => {
      const next = (value + inverse[i] / determinant) / 2;
      change = Math.max(change, Math.abs(next - value));
      return next;
    });
    if (change < 1e-15) break;
  }
  return x;
}

function cofactors(m) {
  return [
    m[4] * m[8] - m[5] * m[7], m[5] * m[6] - m[3] * m[8], m[3] * m[7] - m[4] * m[6],
    m[2] * m[7] - m[1] * m[8], m[0] * m[8] - m[2] * m[6], m[1] * m[6] - m[0] * m[7],
    m[1] * m[5] - m[2] * m[4], m[2] * m[3] - m[0] * m[5], m[0] * m[4] - m[1] * m[3],
  ];
}

/** Intrinsic Z, X, Y angles in degrees: what the rotation channels of the BVH file say. */
export function eulerZXY(m) {
  const degrees = 180 / Math.PI;
  const x = Math.asin(Math.max(-1, Math.min(1, m[7])));
  if (Math.hypot(m[1], m[4]) < 1e-6) return [Math.atan2(m[3], m[0]) * degrees, x * degrees, 0];
  return [Math.atan2(-m[1], m[4]) * degrees, x * degrees, Math.atan2(-m[6], m[8]) * degrees];
}
