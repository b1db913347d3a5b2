// Frames of 219 numbers as a BVH file in centimetres.
import { eulerZXY } from "./rotations.mjs";

const CHANNELS = "Zrotation Xrotation Yrotation", TIP = "0 8 0";

/** `skeleton`: { names, parents, offsets } with offsets in metres. */
export function bvh({ names, parents, offsets }, frames, fps = 30) {
  const order = [];
  const lines = ["HIERARCHY"];
  const joint = (index, indent) => {
    order.push(index);
    const root = parents[index] < 0;
    const offset = root ? [0, 0, 0] : offsets[index].map((metres) => 100 * metres);
    lines.push(`${indent}${root ? "ROOT" : "JOINT"} ${names[index]}`, `${indent}{`);
    lines.push(`${indent}\tOFFSET ${numbers(offset)}`);
    lines.push(`${indent}\tCHANNELS ${root ? `6 Xposition Yposition Zposition ${CHANNELS}` : `3 ${CHANNELS}`}`);
    const children = parents.flatMap((parent, child) => (parent === index ? [child] : []));
    children.forEach((child) => joint(child, `${indent}\t`));
    if (!children.length) lines.push(`${indent}\tEnd Site`, `${indent}\t{`, `${indent}\t\tOFFSET ${TIP}`, `${indent}\t}`);
    lines.push(`${indent}}`);
  };
  joint(0, "");
  lines.push("MOTION", `Frames: ${frames.length}`, `Frame Time: ${(1 / fps).toFixed(10)}`);
  for (const frame of frames) {
    const root = [216, 217, 218].map((i) => 100 * frame[i]);
    const angles = order.flatMap((index) => eulerZXY(frame.slice(9 * index, 9 * index + 9)));
    lines.push(numbers([...root, ...angles]));
  }
  return lines.join("\n") + "\n";
}

const numbers = (values) => values.map((value) => value.toFixed(6)).join(" ");
