// From joint positions to a motion: rotations without twist, bones of exact length (motionrt.motion.from_positions).
import { Motion } from "./motion";
import { add, apply, clamp, columns, cross, dot, IDENTITY, length, minus, multiply, rotationBetween, times, transposed, unit, type Numbers, type Vec3 } from "./rotations";
import { JOINTS, joint, OFFSETS, PARENTS } from "./skeleton";

const both = (...names: string[]): number[] => names.flatMap((name) => [joint(`left_${name}`), joint(`right_${name}`)]);
const LENGTHS = OFFSETS.map(length);
const CHEST = joint("spine3");
const OUTER: Record<number, number> = { 0: joint("left_hip"), [CHEST]: joint("left_collar") };
const MIDDLE: Record<number, number> = { 0: joint("spine1"), [CHEST]: joint("neck") };
const [STARTS, MIDDLES, ENDS, TIPS] = [both("hip", "shoulder"), both("knee", "elbow"), both("ankle", "wrist"), both("foot", "hand")];
const NECK: [number, number][] = [[joint("neck"), joint("head")], ...both("collar").map((c, i): [number, number] => [c, both("shoulder")[i]])];
const [FROM, FULLY] = [1e-3, 3e-3]; // metres that an end may miss its place before a limb bends for it
const HINT = 1e-3; // metres, the weight of the way that knees and elbows bend where the given limb is straight

/** Joints F x 24 x 3 in metres, Y up, to a motion. */
export function fromPositions(joints: Float64Array, fps: number): Motion {
  const frames = joints.length / (JOINTS * 3);
  const [rotations, root] = [new Float32Array(frames * JOINTS * 9), new Float32Array(frames * 3)];
  for (let f = 0; f < frames; f++) {
    const given = Array.from({ length: JOINTS }, (_, j) => Array.from(joints.subarray((f * JOINTS + j) * 3, (f * JOINTS + j) * 3 + 3)));
    posed(given).forEach((rotation, j) => rotations.set(told(rotation) ? rotation : IDENTITY, (f * JOINTS + j) * 9));
    root.set(given[0], 3 * f);
  }
  return new Motion(rotations, root, fps);
}

/** Local rotations of one frame. */
function posed(given: number[][]): number[][] {
  const pointing: Vec3[] = given.map((place, j) => (j ? unit(minus(place, given[PARENTS[j]])) : [0, 0, 0]));
  const local: number[][] = Array.from({ length: JOINTS }, () => [...IDENTITY]);
  const turned: number[][] = Array.from({ length: JOINTS }, () => [...IDENTITY]);
  const carry = (from: number, child: number): void => {
    const above = turned[PARENTS[from]];
    local[from] = rotationBetween(OFFSETS[child], apply(transposed(above), pointing[child]));
    turned[from] = multiply(above, local[from]);
  };
  local[0] = turned[0] = fitted(pointing, 0);
  carry(joint("spine1"), joint("spine2"));
  carry(joint("spine2"), CHEST);
  turned[CHEST] = fitted(pointing, CHEST);
  local[CHEST] = multiply(transposed(turned[PARENTS[CHEST]]), turned[CHEST]);
  for (const [from, child] of NECK) carry(from, child);
  bendLimbs(pointing, turned, given);
  for (const [limbs, children] of [[STARTS, MIDDLES], [MIDDLES, ENDS], [ENDS, TIPS]]) limbs.forEach((limb, i) => carry(limb, children[i]));
  return local;
}

/** The global rotation of a joint with three children: across the outer two, up to the middle one. */
function fitted(pointing: Numbers[], index: number): number[] {
  return multiply(axes(pointing.map((way, j) => times(way, LENGTHS[j])), index), transposed(axes(OFFSETS, index)));
}

function axes(bones: readonly Numbers[], index: number): number[] {
  const [left, right, middle] = [bones[OUTER[index]], bones[OUTER[index] + 1], bones[MIDDLE[index]]];
  const mean = times(add(left, right), 0.5);
  const up = index === 0 ? minus(middle, mean) : add(middle, mean);
  const x = unit(minus(left, right));
  const z = unit(cross(x, up));
  return columns(x, cross(z, x), z);
}

/** Whether a matrix is a rotation: none is told where joints coincide. */
function told(m: number[]): boolean {
  return multiply(m, transposed(m)).every((value, i) => Math.abs(value - IDENTITY[i]) < 1e-3);
}

/** Let arms and legs point so that their ends reach the given places. */
function bendLimbs(pointing: Vec3[], turned: number[][], given: number[][]): void {
  const starts = limbStarts(pointing, turned, given[0]);
  starts.forEach((start, i) => {
    const [middleJoint, endJoint] = [MIDDLES[i], ENDS[i]];
    const [upper, lower] = [LENGTHS[middleJoint], LENGTHS[endJoint]];
    const middle = add(start, times(pointing[middleJoint], upper));
    const end = add(middle, times(pointing[endJoint], lower));
    const missing = minus(given[endJoint], end);
    const share = clamp((length(missing) - FROM) / (FULLY - FROM), 0, 1);
    const owner = turned[i < 2 ? 0 : CHEST];
    const front = times([owner[2], owner[5], owner[8]], i < 2 ? 1 : -1);
    const pole = add(minus(middle, start), times(front, HINT * share));
    [pointing[middleJoint], pointing[endJoint]] = twoBones(minus(add(end, times(missing, share)), start), pole, upper, lower);
  });
}

/** Hips and shoulders, as pelvis, spine, chest and collars have them. */
function limbStarts(pointing: Vec3[], turned: number[][], root: Numbers): Vec3[] {
  const hips = STARTS.slice(0, 2).map((hip) => add(root, apply(turned[0], OFFSETS[hip])));
  let chest = add(root, apply(turned[0], OFFSETS[joint("spine1")]));
  for (const bone of [joint("spine2"), CHEST]) chest = add(chest, times(pointing[bone], LENGTHS[bone]));
  const shoulders = both("collar").map((collar, i) => {
    const shoulder = STARTS[2 + i];
    return add(add(chest, apply(turned[CHEST], OFFSETS[collar])), times(pointing[shoulder], LENGTHS[shoulder]));
  });
  return [...hips, ...shoulders];
}

/** Unit directions of two bones that lead along `way` and bend to `pole`. */
function twoBones(way: Numbers, pole: Numbers, upper: number, lower: number): [Vec3, Vec3] {
  const along = unit(way);
  const reach = clamp(length(way), Math.abs(upper - lower) + 1e-9, upper + lower);
  const share = (upper ** 2 - lower ** 2 + reach ** 2) / (2 * reach);
  const height = Math.sqrt(Math.max(upper ** 2 - share ** 2, 0));
  const side = unit(minus(pole, times(along, dot(pole, along))));
  const middle = add(times(along, share), times(side, height));
  return [unit(middle), unit(minus(times(along, reach), middle))];
}
