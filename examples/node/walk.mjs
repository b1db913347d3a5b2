// node walk.mjs --to 1.5,4 [--heading 0] [--speed 1.2] [--frames 300] [-o walk.bvh] [--json]
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { parseArgs } from "node:util";
import { bvh } from "./lib/bvh.mjs";
import { Walker } from "./lib/walker.mjs";

const NEAR = 0.3; // metres from the goal at which the walk ends
const { values } = parseArgs({
  options: {
    to: { type: "string", default: "1.5,4" },
    heading: { type: "string", default: "0" },
    speed: { type: "string", default: "1.2" },
    frames: { type: "string", default: "300" },
    models: { type: "string", default: join(import.meta.dirname, "..", "..", "models") },
    out: { type: "string", short: "o", default: "walk.bvh" },
    json: { type: "boolean", default: false },
  },
});
const { skeleton, stride } = JSON.parse(await readFile(join(import.meta.dirname, "start.json"), "utf8"));
const walker = await Walker.open(join(values.models, "walknet.int8.onnx"), stride);
const [x, z] = values.to.split(",").map(Number);
const goal = { x, z, heading: Number(values.heading) };
const frames = [];
const away = () => Math.hypot(walker.place[0] - x, walker.place[1] - z);
while (frames.length < Number(values.frames) && away() > NEAR) frames.push(await walker.step(goal, Number(values.speed)));

if (values.json) console.log(JSON.stringify({ frames: frames.map((frame) => [...frame]) }));
else {
  await writeFile(values.out, bvh(skeleton, frames));
  console.log(`${values.out}: ${(frames.length / 30).toFixed(1)} s, ${away().toFixed(2)} m from the goal`);
}
