// Legs bent in closed form so that their feet get where they are wanted (motionrt.motion.feet.two_bone).
import { Motion } from "./motion";
import { add, apply, clamp, dot, length, minus, multiply, rotationBetween, times, transposed, unit, type Vec3 } from "./rotations";
import { JOINTS, joint } from "./skeleton";

/** Hip, knee, ankle and toe joint of the left and of the right leg. */
export const LEGS = ["left", "right"].map((side) => ["hip", "knee", "ankle", "foot"].map((name) => joint(`${side}_${name}`)));
const SOFT = 0.01; // the last share of a leg's length, which is approached and not crossed
const [STRAIGHT, BENT] = [0.015, 0.05]; // distances of the knee from the line between the ends, shares of the leg

/** How far a leg of length `full` reaches exactly that now reaches `distance`. */
export const softLimit = (distance: number, full: number): number => clamp(distance, full * (1 - SOFT), full * (1 - 1e-5));

/** Both feet moved by bending the legs, with the pelvis sunk; the feet keep their global rotations. */
export function bent(motion: Motion, offsets: Vec3[][], sinks: number[]): Motion {
  const [rotations, root] = [motion.rotations.slice(), motion.root.slice()];
  const [positions, turned] = [motion.positions(), motion.globalRotations()];
  for (let f = 0; f < motion.frames; f++) {
    root[3 * f + 1] -= sinks[f];
    const global = (j: number): number[] => Array.from(turned.subarray((f * JOINTS + j) * 9, (f * JOINTS + j) * 9 + 9));
    LEGS.forEach(([hip, knee, ankle], i) => {
      const chain = [hip, knee, ankle].map((j): Vec3 => [0, 1, 2].map((k) => positions[(f * JOINTS + j) * 3 + k] - (k === 1 ? sinks[f] : 0)) as Vec3);
      const way = add(offsets[i][f], [0, sinks[f], 0]);
      const thigh = global(hip);
      const [upper, lower] = twoBone(chain, [thigh, global(knee)], add(chain[2], way), [thigh[2], thigh[5], thigh[8]]);
      const put = (j: number, m: number[]): void => rotations.set(m, (f * JOINTS + j) * 9);
      put(hip, multiply(transposed(global(0)), upper));
      put(knee, multiply(transposed(upper), lower));
      put(ankle, multiply(transposed(lower), global(ankle)));
    });
  }
  return new Motion(rotations, root, motion.fps);
}

/** New global rotations of the two bones of a limb whose end is brought to `target`. */
function twoBone([start, middle, end]: Vec3[], rotations: number[][], target: Vec3, pole: Vec3): [number[], number[]] {
  const [upper, lower] = [minus(middle, start), minus(end, middle)];
  const [line, way] = [minus(end, start), minus(target, start)];
  const [a, b] = [length(upper), length(lower)];
  const distance = Math.max(softReach(length(way), length(line), a + b), Math.abs(a - b) * (1 + 1e-6) + 1e-9);
  const swing = rotationBetween(line, way);
  const share = (a ** 2 - b ** 2 + distance ** 2) / (2 * distance);
  const height = Math.sqrt(Math.max(a ** 2 - share ** 2, 0));
  const along = unit(apply(swing, line));
  const newMiddle = add(start, add(times(along, share), times(apply(swing, bendOf(upper, line, pole, height, a + b)), height)));
  const newEnd = add(start, times(along, distance));
  const bones = [minus(newMiddle, start), minus(newEnd, newMiddle)];
  return [upper, lower].map((bone, i) => multiply(rotationBetween(apply(swing, bone), bones[i]), multiply(swing, rotations[i]))) as [number[], number[]];
}

function softReach(wanted: number, now: number, full: number): number {
  const limit = softLimit(now, full);
  const room = full - limit;
  return wanted > limit ? limit + room * -Math.expm1(-(wanted - limit) / room) : wanted;
}

function bendOf(upper: Vec3, given: Vec3, pole: Vec3, height: number, full: number): Vec3 {
  const line = unit(given);
  const orthogonal = (vector: Vec3): Vec3 => minus(vector, times(line, dot(vector, line)));
  const off = orthogonal(upper);
  const guide = unit(orthogonal(pole));
  const now = length(off);
  const straight = clamp((BENT * full - now) / ((BENT - STRAIGHT) * full), 0, 1);
  return unit(add(off, times(guide, 4 * straight * Math.max(height - now, 0) + 1e-9)));
}

