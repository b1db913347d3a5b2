// WalkNet at stride 1: a character walks to a goal, one frame (1/30 s) at a time.
//
// A frame is 219 numbers (`ccf219`): 24 rotation matrices, row by row, each local to its parent (the pelvis' is
// global), then the pelvis' position in metres. Y is up, a heading is the yaw from +Z towards +X in radians.
import { InferenceSession, Tensor } from "onnxruntime-node";
import { aboutY, apply, multiply, nearestRotation } from "./rotations.mjs";

const HISTORY = 30, WIDTH = 219, JOINTS = 24, ROOT = 216;
const WISHES = 8; // a velocity, a facing, a speed to arrive with; zeros where nothing is wished beside the goal

export class Walker {
  /** `history`: the last 30 frames in the world, oldest first. */
  constructor(session, history) {
    if (history.length !== HISTORY || history.some((frame) => frame.length !== WIDTH))
      throw new Error(`a history is ${HISTORY} frames of ${WIDTH} numbers`);
    this.session = session;
    this.history = history.map((frame) => Float64Array.from(frame));
  }

  static async open(file, history) {
    return new Walker(await InferenceSession.create(file, { intraOpNumThreads: 1 }), history);
  }

  /** [x, z] of the pelvis, metres. */
  get place() {
    const last = this.history[HISTORY - 1];
    return [last[ROOT], last[ROOT + 2]];
  }

  /** The next frame in the world. `goal`: { x, z, heading }, `speed` in m/s. */
  async step(goal, speed = 1.2) {
    const seen = new Float32Array(HISTORY * WIDTH);
    this.history.forEach((frame, i) => seen.set(toGoal(frame, goal), i * WIDTH));
    const { next } = await this.session.run({
      frames: new Tensor("float32", seen, [1, HISTORY, WIDTH]),
      speed: new Tensor("float32", Float32Array.of(speed), [1]),
      wish: new Tensor("float32", new Float32Array(WISHES), [1, WISHES]),
    });
    const frame = fromGoal(onRotations(next.data), goal);
    this.history = [...this.history.slice(1), frame];
    return frame;
  }
}

/** The canonical frame: the goal becomes the origin, its heading +Z. Heights stay; only the pelvis changes. */
export function toGoal(frame, { x, z, heading }) {
  return turned(frame, aboutY(-heading), [frame[ROOT] - x, frame[ROOT + 1], frame[ROOT + 2] - z], [0, 0, 0]);
}

/** Inverse of `toGoal`. */
export function fromGoal(frame, { x, z, heading }) {
  return turned(frame, aboutY(heading), Array.from(frame.slice(ROOT, ROOT + 3)), [x, 0, z]);
}

function turned(frame, turn, root, moved) {
  const out = Float64Array.from(frame);
  out.set(multiply(turn, Array.from(frame.slice(0, 9))), 0);
  out.set(apply(turn, root).map((value, i) => value + moved[i]), ROOT);
  return out;
}

function onRotations(predicted) {
  const out = Float64Array.from(predicted);
  for (let joint = 0; joint < JOINTS; joint++) {
    const place = 9 * joint;
    out.set(nearestRotation(out.slice(place, place + 9)), place);
  }
  return out;
}
