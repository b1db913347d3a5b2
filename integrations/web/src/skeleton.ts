// The skeleton `smpl24`: joints, parents, offsets in metres; Y up, a T-pose facing +Z with the left hand towards +X.
import { InvalidInputError } from "./errors";
import start from "./data/start.json";

export const NAMES: readonly string[] = start.skeleton.names;
export const PARENTS: readonly number[] = start.skeleton.parents;
export const OFFSETS: readonly (readonly number[])[] = start.skeleton.offsets.map((offset) => offset.map(Math.fround));
export const JOINTS = NAMES.length;

/** Body parts and their joints; "global" is the pelvis, with which the translation goes. */
export const PART_JOINTS: Readonly<Record<string, readonly number[]>> = start.parts;
export const PARTS: readonly string[] = Object.keys(start.parts);

export function joint(name: string): number {
  const found = NAMES.indexOf(name);
  if (found < 0) throw new InvalidInputError(`no joint '${name}'; there are: ${NAMES.join(", ")}`);
  return found;
}
