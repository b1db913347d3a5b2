import { InvalidInputError } from "./errors";
import { aboutY, add, apply, matrixOf, multiply, quaternionOf, slerp, type Vec3 } from "./rotations";
import { JOINTS, joint, OFFSETS, PARENTS } from "./skeleton";

/** Frames of `smpl24`: local rotations (F x 24 x 9, row by row) and where the pelvis is (F x 3, metres, Y up). */
export class Motion {
  readonly frames: number;
  private posed?: { positions: Float64Array; rotations: Float64Array };

  constructor(readonly rotations: Float32Array, readonly root: Float32Array, readonly fps = 30) {
    this.frames = root.length / 3;
    if (!Number.isInteger(this.frames) || this.frames < 1 || rotations.length !== this.frames * JOINTS * 9)
      throw new InvalidInputError(`a motion is F x ${JOINTS} x 9 rotations and F x 3 places, not ${rotations.length} and ${root.length} numbers`);
  }

  get seconds(): number {
    return this.frames / this.fps;
  }

  /** Local rotation of a joint in a frame. */
  rotation(frame: number, index: number): Float32Array {
    const first = (frame * JOINTS + index) * 9;
    return this.rotations.subarray(first, first + 9);
  }

  /** Where the pelvis is in a frame. */
  place(frame: number): Vec3 {
    return [this.root[3 * frame], this.root[3 * frame + 1], this.root[3 * frame + 2]];
  }

  private pose(): { positions: Float64Array; rotations: Float64Array } {
    return (this.posed ??= forward(this.rotations, this.root));
  }

  /** Joint positions, F x 24 x 3, metres. */
  positions(): Float64Array {
    return this.pose().positions;
  }

  /** Global rotations, F x 24 x 9. */
  globalRotations(): Float64Array {
    return this.pose().rotations;
  }

  slice(first: number, last: number): Motion {
    return new Motion(this.rotations.slice(first * JOINTS * 9, last * JOINTS * 9), this.root.slice(first * 3, last * 3), this.fps);
  }

  /** Turned about the world's vertical axis by `yaw` radians, then moved. */
  placed(yaw: number, offset: Vec3): Motion {
    const turn = aboutY(yaw);
    const [rotations, root] = [this.rotations.slice(), this.root.slice()];
    for (let f = 0; f < this.frames; f++) {
      rotations.set(multiply(turn, this.rotation(f, 0)), f * JOINTS * 9);
      root.set(add(apply(turn, this.place(f)), offset), 3 * f);
    }
    return new Motion(rotations, root, this.fps);
  }

  /** Heading of a frame, radians from +Z towards +X: across hips and shoulders. */
  heading(frame: number): number {
    const across = [0, 0, 0];
    for (const part of ["hip", "shoulder"])
      for (let i = 0; i < 3; i++)
        across[i] += this.at(frame, joint(`left_${part}`), i) - this.at(frame, joint(`right_${part}`), i);
    return Math.hypot(across[0], across[2]) < 1e-8 ? 0 : Math.atan2(-across[2], across[0]);
  }

  /** Frame 0 above the origin and facing +Z; heights stay. */
  canonical(): Motion {
    const upright = this.placed(-this.heading(0), [0, 0, 0]);
    const [x, , z] = upright.place(0);
    return upright.placed(0, [-x, 0, -z]);
  }

  /** Moved so that its floor, the 1st percentile of its lower toe, lies at 0. */
  grounded(): Motion {
    const lowest = Array.from({ length: this.frames }, (_, f) =>
      Math.min(this.at(f, joint("left_foot"), 1), this.at(f, joint("right_foot"), 1)),
    ).sort((a, b) => a - b);
    const place = 0.01 * (this.frames - 1);
    const below = Math.floor(place);
    const floor = lowest[below] + (place - below) * ((lowest[below + 1] ?? lowest[below]) - lowest[below]);
    return this.placed(0, [0, -floor, 0]);
  }

  /** One coordinate of a joint. */
  at(frame: number, index: number, axis: number): number {
    return this.positions()[(frame * JOINTS + index) * 3 + axis];
  }

  /** The pose at a time in seconds, between frames along the sphere: quaternions (24 x 4, wxyz) and the pelvis. */
  sample(seconds: number): { quaternions: Float32Array; root: Vec3 } {
    const time = Math.min(Math.max(seconds * this.fps, 0), this.frames - 1);
    const before = Math.floor(time);
    return poseBetween(this.frame(before), this.frame(Math.min(before + 1, this.frames - 1)), time - before);
  }

  /** A frame as 219 numbers: 24 matrices and the pelvis. */
  frame(index: number): Float64Array {
    const out = new Float64Array(JOINTS * 9 + 3);
    out.set(this.rotations.subarray(index * JOINTS * 9, (index + 1) * JOINTS * 9));
    out.set(this.place(index), JOINTS * 9);
    return out;
  }

  static fromFrames(frames: readonly ArrayLike<number>[], fps = 30): Motion {
    const [rotations, root] = [new Float32Array(frames.length * JOINTS * 9), new Float32Array(frames.length * 3)];
    frames.forEach((frame, f) => {
      for (let i = 0; i < JOINTS * 9; i++) rotations[f * JOINTS * 9 + i] = frame[i];
      for (let i = 0; i < 3; i++) root[3 * f + i] = frame[JOINTS * 9 + i];
    });
    return new Motion(rotations, root, fps);
  }
}

/** Between two frames of 219 numbers, for displays that show more pictures than there are frames. */
export function poseBetween(a: ArrayLike<number>, b: ArrayLike<number>, weight: number): { quaternions: Float32Array; root: Vec3 } {
  const quaternions = new Float32Array(JOINTS * 4);
  const matrix = (frame: ArrayLike<number>, j: number) => Array.from({ length: 9 }, (_, i) => frame[9 * j + i]);
  for (let j = 0; j < JOINTS; j++) {
    const start = quaternionOf(matrix(a, j));
    quaternions.set(weight > 0 ? slerp(start, quaternionOf(matrix(b, j)), weight) : start, 4 * j);
  }
  const root = [0, 1, 2].map((i) => a[JOINTS * 9 + i] + weight * (b[JOINTS * 9 + i] - a[JOINTS * 9 + i])) as Vec3;
  return { quaternions, root };
}

/** 3x3 matrices of a pose of quaternions, 24 x 9. */
export function matricesOf(quaternions: ArrayLike<number>): Float32Array {
  const out = new Float32Array(JOINTS * 9);
  for (let j = 0; j < JOINTS; j++) out.set(matrixOf([0, 1, 2, 3].map((i) => quaternions[4 * j + i])), 9 * j);
  return out;
}

/** Forward kinematics of F frames. */
export function forward(rotations: ArrayLike<number>, root: ArrayLike<number>): { positions: Float64Array; rotations: Float64Array } {
  const frames = root.length / 3;
  const positions = new Float64Array(frames * JOINTS * 3);
  const turned = new Float64Array(frames * JOINTS * 9);
  for (let f = 0; f < frames; f++)
    for (let j = 0; j < JOINTS; j++) {
      const [at, parent] = [f * JOINTS + j, f * JOINTS + PARENTS[j]];
      const local = Array.from({ length: 9 }, (_, i) => rotations[at * 9 + i]);
      if (PARENTS[j] < 0) {
        turned.set(local, at * 9);
        positions.set([root[3 * f], root[3 * f + 1], root[3 * f + 2]], at * 3);
      } else {
        const above = turned.subarray(parent * 9, parent * 9 + 9);
        turned.set(multiply(above, local), at * 9);
        positions.set(add(positions.subarray(parent * 3, parent * 3 + 3), apply(above, OFFSETS[j])), at * 3);
      }
    }
  return { positions, rotations: turned };
}
