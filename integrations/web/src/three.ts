// Characters for three.js: figures of capsules, any number in two draw calls, and motions on a GLB's own skeleton.
import * as THREE from "three";
import { InvalidInputError } from "./errors";
import { restPositions } from "./files";
import { forward, matricesOf } from "./motion";
import { JOINTS, joint, NAMES, OFFSETS, PARENTS } from "./skeleton";

/** A pose: quaternions (24 x 4, wxyz) and the pelvis in metres, as `poseBetween` and `Motion.sample` give it. */
export interface Pose {
  quaternions: ArrayLike<number>;
  root: readonly number[];
}

const HEAD = joint("head");
const RADII: Record<string, number> = { spine1: 0.105, spine2: 0.11, spine3: 0.12, neck: 0.1, head: 0.05, hip: 0.085, knee: 0.072, ankle: 0.05, foot: 0.04, collar: 0.06, shoulder: 0.06, elbow: 0.045, wrist: 0.037, hand: 0.034 };
const BONES = NAMES.map((name, j) => ({ from: PARENTS[j], to: j, radius: RADII[name.replace(/^(left|right)_/, "")] ?? 0.05 })).filter(({ from }) => from >= 0);

/** Figures of capsules with a head; colours by figure. */
export class Figures extends THREE.Group {
  private readonly limbs: THREE.InstancedMesh;
  private readonly heads: THREE.InstancedMesh;

  constructor(readonly count: number, colours: readonly THREE.ColorRepresentation[] = ["#4f86c6"]) {
    super();
    const material = new THREE.MeshStandardMaterial({ roughness: 0.65, metalness: 0.05 });
    this.limbs = new THREE.InstancedMesh(new THREE.CapsuleGeometry(1, 1, 6, 14), material, count * BONES.length);
    this.heads = new THREE.InstancedMesh(new THREE.SphereGeometry(1, 24, 16), material, count);
    for (const mesh of [this.limbs, this.heads]) {
      mesh.castShadow = true;
      mesh.frustumCulled = false;
      this.add(mesh);
    }
    for (let i = 0; i < count; i++) {
      const colour = new THREE.Color(colours[i % colours.length]);
      this.heads.setColorAt(i, colour);
      BONES.forEach(({ to }, b) => {
        const shade = NAMES[to].startsWith("left") ? 0.86 : NAMES[to].startsWith("right") ? 1 : 0.93;
        this.limbs.setColorAt(i * BONES.length + b, colour.clone().multiplyScalar(shade));
      });
    }
  }

  /** Show a figure in a pose. */
  pose(index: number, { quaternions, root }: Pose): void {
    const { positions, rotations } = forward(matricesOf(quaternions), root);
    const at = (j: number): THREE.Vector3 => new THREE.Vector3().fromArray(positions, 3 * j);
    const [up, matrix, turn, scale] = [new THREE.Vector3(0, 1, 0), new THREE.Matrix4(), new THREE.Quaternion(), new THREE.Vector3()];
    BONES.forEach(({ from, to, radius }, b) => {
      const [start, end] = [at(from), at(to)];
      const way = end.clone().sub(start);
      const size = way.length();
      turn.setFromUnitVectors(up, way.normalize());
      matrix.compose(start.add(end).multiplyScalar(0.5), turn, scale.set(radius, (size + 1.2 * radius) / 3, radius));
      this.limbs.setMatrixAt(index * BONES.length + b, matrix);
    });
    const m = rotations.subarray(HEAD * 9, HEAD * 9 + 9);
    turn.setFromRotationMatrix(new THREE.Matrix4().set(m[0], m[1], m[2], 0, m[3], m[4], m[5], 0, m[6], m[7], m[8], 0, 0, 0, 0, 1));
    const centre = at(HEAD).add(new THREE.Vector3(0, 0.085, 0.015).applyQuaternion(turn));
    this.heads.setMatrixAt(index, matrix.compose(centre, turn, scale.set(0.088, 0.118, 0.1)));
    this.limbs.instanceMatrix.needsUpdate = this.heads.instanceMatrix.needsUpdate = true;
  }

  dispose(): void {
    for (const mesh of [this.limbs, this.heads]) {
      mesh.geometry.dispose();
      mesh.dispose();
    }
  }
}

/** Which node of a rig is which joint: `motionrt rig map hero.glb --json`. */
export type Mapping = Record<string, string>;

const NEEDED = ["pelvis", "left_hip", "right_hip", "left_knee", "right_knee", "left_shoulder", "right_shoulder", "left_elbow", "right_elbow"];

/** A character whose skeleton takes poses: every joint turns in the world as the figure's does, from its T-pose. */
export class Character {
  private readonly bones = new Map<number, { node: THREE.Object3D; rest: THREE.Quaternion }>();
  private readonly lift: number;

  constructor(readonly scene: THREE.Object3D, mapping: Mapping) {
    const missing = NEEDED.filter((name) => !mapping[name]);
    if (missing.length) throw new InvalidInputError(`the mapping lacks ${missing.join(", ")}; make it with: motionrt rig map FILE --json`);
    scene.updateMatrixWorld(true);
    const nodes = new Map(Object.entries(mapping).map(([name, node]) => [joint(name), this.node(node)]));
    const place = (j: number): THREE.Vector3 => nodes.get(j)!.getWorldPosition(new THREE.Vector3());
    const own = restPositions();
    const lowest = nodes.has(joint("left_ankle")) ? joint("left_ankle") : joint("left_knee");
    scene.scale.multiplyScalar((own[0][1] - own[lowest][1]) / (place(0).y - place(lowest).y)); // legs as long as the figure's
    scene.updateMatrixWorld(true);
    for (const [j, node] of nodes) this.bones.set(j, { node, rest: straightened(j, nodes, place) });
    const floor = new THREE.Box3().setFromObject(scene).min.y;
    this.lift = place(0).y - floor - (own[0][1] - Math.min(...own.map((one) => one[1])));
    scene.traverse((node) => {
      if ((node as THREE.Mesh).isMesh) Object.assign(node, { castShadow: true, frustumCulled: false });
    });
  }

  private node(name: string): THREE.Object3D {
    const found = this.scene.getObjectByName(name) ?? this.scene.getObjectByName(THREE.PropertyBinding.sanitizeNodeName(name));
    if (!found) throw new InvalidInputError(`the character has no node ${name}`);
    return found;
  }

  /** Show the character in a pose. */
  pose({ quaternions, root }: Pose): void {
    const { rotations } = forward(matricesOf(quaternions), root);
    for (let j = 0; j < JOINTS; j++) {
      const bone = this.bones.get(j);
      if (!bone) continue;
      const m = rotations.subarray(9 * j, 9 * j + 9);
      const turn = new THREE.Quaternion().setFromRotationMatrix(new THREE.Matrix4().set(m[0], m[1], m[2], 0, m[3], m[4], m[5], 0, m[6], m[7], m[8], 0, 0, 0, 0, 1));
      const parent = bone.node.parent!;
      parent.updateWorldMatrix(true, false);
      bone.node.quaternion.copy(parent.getWorldQuaternion(new THREE.Quaternion()).invert().multiply(turn).multiply(bone.rest));
      if (j === 0) {
        const wanted = new THREE.Vector3(root[0], root[1] + this.lift, root[2]);
        bone.node.position.copy(parent.worldToLocal(wanted));
      }
      bone.node.updateMatrix();
    }
    this.scene.updateMatrixWorld(true);
  }
}

/** The world's rotation of a node while the character stands in the figure's T-pose. */
function straightened(j: number, nodes: Map<number, THREE.Object3D>, place: (j: number) => THREE.Vector3): THREE.Quaternion {
  const rest = nodes.get(j)!.getWorldQuaternion(new THREE.Quaternion());
  const child = PARENTS.findIndex((parent, k) => parent === j && nodes.has(k) && !/hip|collar|spine|pelvis/.test(NAMES[k]));
  if (child < 0 || !/shoulder|elbow|hip|knee|wrist/.test(NAMES[j])) return rest;
  const [mine, wanted] = [place(child).sub(place(j)).normalize(), new THREE.Vector3().fromArray(OFFSETS[child] as number[]).normalize()];
  return new THREE.Quaternion().setFromUnitVectors(mine, wanted).multiply(rest);
}

const SYNONYMS: [string, RegExp][] = [
  ["pelvis", /^(hips?|pelvis)$/], ["spine1", /^(spine|spine0?1|abdomen)$/], ["spine2", /^(spine0?[12]|chest)$/], ["spine3", /^(spine0?[23]|upperchest|chest)$/],
  ["neck", /^neck(0?1)?$/], ["head", /^head$/],
  ["collar", /^(shoulder|clavicle|collar)$/], ["shoulder", /^(arm|upperarm)$/], ["elbow", /^(forearm|lowerarm)$/], ["wrist", /^(hand|wrist)$/],
  ["hip", /^(upleg|upperleg|thigh|hip)$/], ["knee", /^(leg|lowerleg|calf|shin|knee)$/], ["ankle", /^(foot|ankle)$/], ["foot", /^(toebase|toes?|ball)$/],
];
const OURS = new Set(NAMES);

/** A mapping by the names of a rig: smpl24, Mixamo, VRM, Unreal and the like; `motionrt rig map` looks at more than names. */
export function guessMapping(scene: THREE.Object3D): Mapping {
  const found: Mapping = {};
  scene.traverse((node) => {
    if (OURS.has(node.name)) found[node.name] = node.name;
    const plain = node.name.replace(/^(mixamorig\d*:?|j_bip_[clr]_|def[-_.]|bip0?01?[ _])/i, "");
    const side = /(^|[_.\s-])l($|[_.\s-])|left/i.test(plain) ? "left" : /(^|[_.\s-])r($|[_.\s-])|right/i.test(plain) ? "right" : /_l_/i.test(node.name) ? "left" : /_r_/i.test(node.name) ? "right" : "";
    const bare = plain.replace(/left|right/gi, "").replace(/(^|[_.\s-])[lr](?=$|[_.\s-])/gi, "").replace(/[^a-z0-9]/gi, "").toLowerCase();
    for (const [name, pattern] of SYNONYMS) {
      const key = OURS.has(name) ? name : `${side}_${name}`;
      if (OURS.has(key) && !(key in found) && pattern.test(bare) && (side !== "") !== OURS.has(name) && !Object.values(found).includes(node.name)) {
        found[key] = node.name;
        break;
      }
    }
  });
  return found;
}
