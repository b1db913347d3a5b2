// One motion out of two or more (SINC 3.2): whoever has fewer parts lies on top.
import { InvalidInputError } from "./errors";
import { Motion } from "./motion";
import { matrixOf, quaternionOf, slerp } from "./rotations";
import { JOINTS, joint, PART_JOINTS, PARENTS, PARTS } from "./skeleton";

/** A motion, and the body parts that it moves; without parts, all that the others leave. */
export interface Layer {
  motion: Motion;
  parts?: readonly string[] | null;
}

const SUPPORT = ["left leg", "right leg", "global"]; // they come from one motion, together with the translation
const SEAM = ["spine1", "spine2", "spine3", "left_collar", "right_collar"].map(joint);

/** One motion of several, as long as the shortest, at the first one's frame rate; all of them at 30 fps. */
export function compose(layers: readonly Layer[]): Motion {
  if (layers.length < 2) throw new InvalidInputError("give two layers or more");
  if (layers.some(({ motion }) => motion.fps !== layers[0].motion.fps)) throw new InvalidInputError("all layers need the same frame rate");
  const owners = ownersOf(layers);
  const frames = Math.min(...layers.map(({ motion }) => motion.frames));
  const [rotations, root] = [new Float32Array(frames * JOINTS * 9), new Float32Array(frames * 3)];
  for (let f = 0; f < frames; f++) {
    for (let j = 0; j < JOINTS; j++) rotations.set(rotationOf(layers, owners, f, j), (f * JOINTS + j) * 9);
    root.set(layers[owners[0]].motion.place(f), 3 * f);
  }
  const found = new Motion(rotations, root, layers[0].motion.fps);
  return owners[0] === owners[joint("left_ankle")] && owners[0] === owners[joint("right_ankle")] ? found : onGround(found, layers, owners);
}

/** Which layer moves each joint. */
export function ownersOf(layers: readonly Layer[]): number[] {
  const open = layers.filter(({ parts }) => !parts?.length).length;
  if (open > 1 || (open === 1 && layers[0].parts?.length)) throw new InvalidInputError(`every layer but the first names its parts: ${PARTS.join(", ")}`);
  const unknown = layers.flatMap(({ parts }) => parts ?? []).filter((part) => !PARTS.includes(part));
  if (unknown.length) throw new InvalidInputError(`unknown body part ${unknown.join(", ")}; the parts are: ${PARTS.join(", ")}`);
  const taken = layers.slice(open).flatMap(({ parts }) => withSupport(parts!));
  const wanted = layers.map(({ parts }) => (parts?.length ? [...parts] : PARTS.filter((part) => !taken.includes(part))));
  const order = layers.map((_, i) => i).sort((a, b) => wanted[b].length - wanted[a].length || a - b);
  const owners = new Array<number>(JOINTS).fill(order[0]);
  for (const layer of order.slice(1)) for (const part of withSupport(wanted[layer])) for (const j of PART_JOINTS[part]) owners[j] = layer;
  return owners;
}

const withSupport = (parts: readonly string[]): string[] =>
  parts.some((part) => SUPPORT.includes(part)) ? [...new Set([...parts, ...SUPPORT])] : [...parts];

/** A joint's rotation; the first joint of a seam lies half way between the two layers. */
function rotationOf(layers: readonly Layer[], owners: number[], f: number, j: number): ArrayLike<number> {
  const own = layers[owners[j]].motion.rotation(f, j);
  const below = PARENTS[j] < 0 ? owners[j] : owners[PARENTS[j]];
  if (below === owners[j] || !SEAM.includes(j)) return own;
  return matrixOf(slerp(quaternionOf(layers[below].motion.rotation(f, j)), quaternionOf(own), 0.5));
}

/** Its lower toe as high as that of the layers that the legs come from. */
function onGround(motion: Motion, layers: readonly Layer[], owners: number[]): Motion {
  const toes = [joint("left_foot"), joint("right_foot")];
  const root = motion.root.slice();
  for (let f = 0; f < motion.frames; f++) {
    const wanted = Math.min(...toes.map((toe) => layers[owners[toe]].motion.at(f, toe, 1)));
    root[3 * f + 1] += wanted - Math.min(...toes.map((toe) => motion.at(f, toe, 1)));
  }
  return new Motion(motion.rotations, root, motion.fps);
}
