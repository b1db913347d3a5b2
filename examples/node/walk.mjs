// A walk to a place as BVH or GLB: node walk.mjs --to 1.5,4 -o walk.bvh
import { writeFile } from "node:fs/promises";
import { InvalidInputError, Motion, toBVH, toGLB } from "motionrt-web";
import { command, number, open } from "./command.mjs";

const NEAR = 0.3; // metres from the goal at which the walk ends
const options = {
  to: { type: "string", default: "1.5,4", help: "X,Z in metres" },
  heading: { type: "string", default: "0", help: "to arrive with, radians from +Z towards +X" },
  speed: { type: "string", default: "1.2", help: "m/s" },
  frames: { type: "string", default: "300", help: "at most so many, 30 a second" },
  out: { type: "string", short: "o", default: "walk.bvh", help: "file to write, .bvh or .glb" },
};
await command("walk.mjs [options]", options, async ({ values }) => {
  const [x, z, ...rest] = values.to.split(",").map((part) => number(part, "to"));
  if (z === undefined || rest.length) throw new InvalidInputError("--to takes X,Z, as in 1.5,4");
  const goal = { x, z, heading: number(values.heading, "heading") };
  const crowd = await (await open(values.site)).crowd([{ x: 0, z: 0, heading: 0 }]);
  const frames = [];
  const away = () => Math.hypot(crowd.place(0)[0] - x, crowd.place(0)[1] - z);
  while (frames.length < number(values.frames, "frames") && away() > NEAR)
    frames.push((await crowd.step([goal], number(values.speed, "speed")))[0]);
  if (values.json) return console.log(JSON.stringify({ frames: frames.map((frame) => [...frame]) }));
  const motion = Motion.fromFrames(frames);
  await writeFile(values.out, values.out.endsWith(".glb") ? toGLB(motion) : toBVH(motion));
  console.log(`${values.out}: ${motion.seconds.toFixed(1)} s, ${away().toFixed(2)} m from the goal`);
});
