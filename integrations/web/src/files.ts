// Motions as BVH (centimetres), GLB (metres, with a figure of bones) and JSON.
import type { Motion } from "./motion";
import { cross, eulerZXY, length, minus, quaternionOf, times, unit, add, type Vec3 } from "./rotations";
import { JOINTS, NAMES, OFFSETS, PARENTS } from "./skeleton";

const CHANNELS = "Zrotation Xrotation Yrotation";
const children = (index: number): number[] => PARENTS.flatMap((parent, child) => (parent === index ? [child] : []));
const fixed = (values: ArrayLike<number>): string => Array.from(values, (value) => value.toFixed(6)).join(" ");

/** The text of a BVH file. */
export function toBVH(motion: Motion): string {
  const order: number[] = [];
  const lines = ["HIERARCHY"];
  const write = (index: number, indent: string): void => {
    order.push(index);
    const root = PARENTS[index] < 0;
    lines.push(`${indent}${root ? "ROOT" : "JOINT"} ${NAMES[index]}`, `${indent}{`);
    lines.push(`${indent}\tOFFSET ${fixed(root ? [0, 0, 0] : OFFSETS[index].map((metres) => 100 * metres))}`);
    lines.push(`${indent}\tCHANNELS ${root ? `6 Xposition Yposition Zposition ${CHANNELS}` : `3 ${CHANNELS}`}`);
    children(index).forEach((child) => write(child, `${indent}\t`));
    if (!children(index).length) lines.push(`${indent}\tEnd Site`, `${indent}\t{`, `${indent}\t\tOFFSET 0 8 0`, `${indent}\t}`);
    lines.push(`${indent}}`);
  };
  write(0, "");
  lines.push("MOTION", `Frames: ${motion.frames}`, `Frame Time: ${(1 / motion.fps).toFixed(10)}`);
  for (let f = 0; f < motion.frames; f++) {
    const root = motion.place(f).map((metres) => 100 * metres);
    lines.push(fixed([...root, ...order.flatMap((index) => eulerZXY(motion.rotation(f, index)))]));
  }
  return `${lines.join("\n")}\n`;
}

/** Quaternions (wxyz) and root of every frame, with the skeleton: what a program without a BVH reader takes. */
export function toJSON(motion: Motion): string {
  const round = (value: number): number => Number(value.toFixed(6));
  const frames = Array.from({ length: motion.frames }, (_, f) => ({
    root: motion.place(f).map(round),
    rotations: NAMES.map((_, j) => quaternionOf(motion.rotation(f, j)).map(round)),
  }));
  return JSON.stringify({ fps: motion.fps, units: "metres, quaternions wxyz", names: NAMES, parents: PARENTS, offsets: OFFSETS, frames });
}

/** A bone as an octahedron between two points: corners and triangles. */
export function octahedron(from: Vec3, to: Vec3): { points: Vec3[]; triangles: number[] } {
  const way = minus(to, from);
  const along = unit(way);
  const side = unit(cross(along, Math.abs(along[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0]));
  const other = cross(along, side);
  const waist = add(from, times(way, 0.25));
  const thick = Math.min(Math.max(0.14 * length(way), 0.015), 0.05);
  const ring = [side, other, times(side, -1), times(other, -1)].map((way) => add(waist, times(way, thick)));
  const triangles = [0, 1, 2, 3].flatMap((i) => [0, 1 + ((i + 1) % 4), 1 + i, 5, 1 + i, 1 + ((i + 1) % 4)]);
  return { points: [from, ...ring, to], triangles };
}

/** Global rest positions. */
export function restPositions(): Vec3[] {
  const found: Vec3[] = [];
  for (let j = 0; j < JOINTS; j++) found.push(PARENTS[j] < 0 ? [0, 0, 0] : add(found[PARENTS[j]], OFFSETS[j]));
  return found;
}

/** The bytes of a GLB file: joints, a skinned figure of bones, one animation. */
export function toGLB(motion: Motion, name = "motion"): Uint8Array {
  const rest = restPositions();
  const floor = Math.min(...rest.map((place) => place[1]));
  const [points, owners, triangles] = [[] as number[], [] as number[], [] as number[]];
  const bone = (from: Vec3, to: Vec3, owner: number): void => {
    const { points: corners, triangles: faces } = octahedron(from, to);
    triangles.push(...faces.map((corner) => corner + points.length / 3));
    corners.forEach((corner) => points.push(...corner) && owners.push(owner, 0, 0, 0));
  };
  for (let j = 1; j < JOINTS; j++) bone(rest[PARENTS[j]], rest[j], PARENTS[j]);
  for (let j = 0; j < JOINTS; j++) if (!children(j).length) bone(rest[j], add(rest[j], NAMES[j] === "head" ? [0, 0.18, 0.02] : times(OFFSETS[j], 0.8)), j);
  const binds = rest.flatMap(([x, y, z]) => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -x, -y, -z, 1]);
  const file = new Glb();
  const count = points.length / 3;
  const attributes = {
    POSITION: file.accessor(new Float32Array(points), "VEC3", true),
    JOINTS_0: file.accessor(new Uint8Array(owners), "VEC4"),
    WEIGHTS_0: file.accessor(Float32Array.from({ length: count * 4 }, (_, i) => (i % 4 ? 0 : 1)), "VEC4"),
  };
  const indices = file.accessor(new Uint16Array(triangles), "SCALAR");
  const times_ = file.accessor(Float32Array.from({ length: motion.frames }, (_, f) => f / motion.fps), "SCALAR", true);
  const channels = [{ node: 0, path: "translation", data: file.accessor(motion.root, "VEC3") }];
  for (let j = 0; j < JOINTS; j++) channels.push({ node: j, path: "rotation", data: file.accessor(turnsOf(motion, j), "VEC4") });
  return file.bytes({
    nodes: [
      ...NAMES.map((joint, j) => ({ name: joint, translation: j ? OFFSETS[j] : [0, -floor, 0], ...(children(j).length ? { children: children(j) } : {}) })),
      { name: "figure", mesh: 0, skin: 0 },
    ],
    scenes: [{ nodes: [0, JOINTS] }],
    scene: 0,
    skins: [{ joints: NAMES.map((_, j) => j), inverseBindMatrices: file.accessor(new Float32Array(binds), "MAT4"), skeleton: 0 }],
    materials: [{ pbrMetallicRoughness: { baseColorFactor: [0.32, 0.52, 0.78, 1], metallicFactor: 0, roughnessFactor: 0.8 }, doubleSided: true }],
    meshes: [{ name: "figure", primitives: [{ attributes, indices, material: 0 }] }],
    animations: [
      {
        name,
        samplers: channels.map(({ data }) => ({ input: times_, output: data, interpolation: "LINEAR" })),
        channels: channels.map(({ node, path }, sampler) => ({ sampler, target: { node, path } })),
      },
    ],
  });
}

/** Quaternions xyzw of a joint over time, without sign flips. */
function turnsOf(motion: Motion, index: number): Float32Array {
  const out = new Float32Array(motion.frames * 4);
  let before = [1, 0, 0, 0];
  for (let f = 0; f < motion.frames; f++) {
    let q = quaternionOf(motion.rotation(f, index));
    if (q.reduce((sum, value, i) => sum + value * before[i], 0) < 0) q = q.map((value) => -value);
    out.set([q[1], q[2], q[3], q[0]], 4 * f);
    before = q;
  }
  return out;
}

type Data = Float32Array | Uint16Array | Uint8Array;
const COMPONENTS = new Map<unknown, number>([[Float32Array, 5126], [Uint16Array, 5123], [Uint8Array, 5121]]);
const SIZES: Record<string, number> = { SCALAR: 1, VEC3: 3, VEC4: 4, MAT4: 16 };

/** Collects arrays, and writes the container. */
class Glb {
  private readonly views: object[] = [];
  private readonly accessors: object[] = [];
  private readonly parts: Uint8Array[] = [];
  private size = 0;

  accessor(data: Data, type: string, bounds = false): number {
    const width = SIZES[type];
    const bytes = new Uint8Array(data.buffer, data.byteOffset, data.byteLength);
    this.views.push({ buffer: 0, byteOffset: this.size, byteLength: bytes.length });
    const column = (i: number): number[] => Array.from(data).filter((_, n) => n % width === i);
    const range = bounds && {
      min: Array.from({ length: width }, (_, i) => column(i).reduce((a, b) => Math.min(a, b))),
      max: Array.from({ length: width }, (_, i) => column(i).reduce((a, b) => Math.max(a, b))),
    };
    this.accessors.push({ bufferView: this.views.length - 1, componentType: COMPONENTS.get(data.constructor), count: data.length / width, type, ...range });
    const padded = new Uint8Array(Math.ceil(bytes.length / 4) * 4);
    padded.set(bytes);
    this.parts.push(padded);
    this.size += padded.length;
    return this.accessors.length - 1;
  }

  bytes(rest: object): Uint8Array {
    const document = { asset: { version: "2.0", generator: "motionrt-web" }, ...rest, accessors: this.accessors, bufferViews: this.views, buffers: [{ byteLength: this.size }] };
    const text = new TextEncoder().encode(JSON.stringify(document));
    const length = Math.ceil(text.length / 4) * 4;
    const out = new Uint8Array(12 + 8 + length + 8 + this.size).fill(0x20);
    const view = new DataView(out.buffer);
    [0x46546c67, 2, out.length, length, 0x4e4f534a].forEach((word, i) => view.setUint32(4 * i, word, true));
    out.set(text, 20);
    view.setUint32(20 + length, this.size, true);
    view.setUint32(24 + length, 0x004e4942, true);
    let at = 28 + length;
    for (const part of this.parts) {
      out.set(part, at);
      at += part.length;
    }
    return out;
  }
}
