// WalkNet at stride 1 [docs/embedding.md]: characters that walk, all of them by one frame (1/30 s) a call.
import start from "./data/start.json";
import { InvalidInputError, MotionRTError } from "./errors";
import { aboutY, turnNearest, type Vec3 } from "./rotations";
import { numbers, type Sessions, type Tensors } from "./sessions";
import { JOINTS } from "./skeleton";

export const HISTORY = 30;
export const WIDTH = JOINTS * 9 + 3;
const ROOT = JOINTS * 9;
const WISHES = 8; // numbers of a wish beside the goal, which newer files take
export const SPEED = 1.2; // m/s

/** Where to be, and facing where: metres, and yaw in radians from +Z towards +X. */
export interface Goal {
  x: number;
  z: number;
  heading: number;
}

export type Frame = Float64Array;

/** A second of a steady walk that ends at a place, 30 frames of 219 numbers. */
export function strideAt(place: Goal): Frame[] {
  return start.stride.map((row) => fromGoal(Float64Array.from(row), place));
}

/** Standing at a place. */
export function standingAt(place: Goal): Frame {
  return fromGoal(Float64Array.from(start.standing), place);
}

/** Walks any number of characters. */
export class Crowd {
  /** `histories`: the last 30 frames of every character in the world, oldest first. */
  constructor(private readonly sessions: Sessions, public histories: Frame[][]) {
    if (!histories.length) throw new InvalidInputError("a crowd needs at least one character");
    for (const history of histories) checkHistory(history);
  }

  get size(): number {
    return this.histories.length;
  }

  /** [x, z] of a character's pelvis, metres. */
  place(index: number): [number, number] {
    const last = this.histories[index][HISTORY - 1];
    return [last[ROOT], last[ROOT + 2]];
  }

  /** The next frame of every character in the world. `speeds` in m/s: one for all, or one each. */
  async step(goals: readonly Goal[], speeds: number | readonly number[] = SPEED): Promise<Frame[]> {
    const count = this.size;
    if (goals.length !== count || goals.some(({ x, z, heading }) => !Number.isFinite(x + z + heading)))
      throw new InvalidInputError(`goals must be ${count} finite places { x, z, heading }`);
    const seen = new Float32Array(count * HISTORY * WIDTH);
    this.histories.forEach((history, i) => {
      const { x, z, heading } = goals[i], turn = aboutY(-heading);
      history.forEach((frame, f) => put(frame, turn, x, z, seen, (i * HISTORY + f) * WIDTH));
    });
    const speed = Float32Array.from({ length: count }, (_, i) => (typeof speeds === "number" ? speeds : speeds[i]));
    const feeds: Tensors = { frames: this.sessions.float(seen, [count, HISTORY, WIDTH]), speed: this.sessions.float(speed, [count]) };
    if ((await this.sessions.session("walknet")).inputNames.includes("wish")) feeds.wish = this.sessions.float(new Float32Array(count * WISHES), [count, WISHES]); // none
    const next = numbers((await this.sessions.run("walknet", feeds, ["next"])).next);
    return this.histories.map((history, i) => {
      const frame = fromGoal(onRotations(next.subarray(i * WIDTH, (i + 1) * WIDTH)), goals[i]);
      history.push(frame);
      history.shift();
      return frame;
    });
  }
}

function checkHistory(history: readonly ArrayLike<number>[]): void {
  if (history.length !== HISTORY || history.some((frame) => frame.length !== WIDTH))
    throw new InvalidInputError(`a history is ${HISTORY} frames of ${WIDTH} numbers`);
}

/** A frame into `out` as seen from a goal, which becomes the origin, its heading +Z. Heights stay; only the pelvis changes. */
function put(frame: Frame, turn: readonly number[], x: number, z: number, out: Float32Array, at: number): void {
  out.set(frame, at);
  turnPelvis(frame, turn, [frame[ROOT] - x, frame[ROOT + 1], frame[ROOT + 2] - z], out, at);
}

/** A frame as seen from a goal back in the world. */
export function fromGoal(frame: Frame, { x, z, heading }: Goal): Frame {
  const out = frame.slice();
  turnPelvis(frame, aboutY(heading), [frame[ROOT], frame[ROOT + 1], frame[ROOT + 2]], out, 0);
  out[ROOT] += x;
  out[ROOT + 2] += z;
  return out;
}

/** Turns the rotation of the pelvis, and `root`, about the vertical. */
function turnPelvis(frame: Frame, turn: readonly number[], [x, y, z]: Vec3, out: Frame | Float32Array, at: number): void {
  const [c, s] = [turn[0], turn[2]];
  for (let j = 0; j < 3; j++) {
    out[at + j] = c * frame[j] + s * frame[6 + j];
    out[at + 6 + j] = c * frame[6 + j] - s * frame[j];
  }
  out[at + ROOT] = c * x + s * z;
  out[at + ROOT + 1] = y;
  out[at + ROOT + 2] = c * z - s * x;
}

function onRotations(predicted: Float32Array): Frame {
  const out = Float64Array.from(predicted);
  for (let j = 0; j < JOINTS; j++)
    if (!turnNearest(out, 9 * j)) throw new MotionRTError("the model predicts no rotation: check the history, and the model's file");
  return out;
}
