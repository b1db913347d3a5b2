// Motion of words as BVH or GLB: node generate.mjs "kick with the left foot" --seed 1 -o kick.bvh
import { writeFile } from "node:fs/promises";
import { toBVH, toGLB } from "motionrt-web";
import { command, number, open } from "./command.mjs";

const options = {
  seconds: { type: "string", default: "4", help: "0.5 to 10" },
  seed: { type: "string", default: "0", help: "the same seed gives the same motion" },
  out: { type: "string", short: "o", default: "motion.bvh", help: "file to write, .bvh or .glb" },
};
await command('generate.mjs "TEXT" [options]', options, async ({ values, positionals }) => {
  const rt = await open(values.site);
  const motion = await rt.generate(positionals.join(" "), { seconds: number(values.seconds, "seconds"), seed: number(values.seed, "seed") });
  if (values.json) return console.log(JSON.stringify({ rotations: [...motion.rotations], root: [...motion.root] }));
  await writeFile(values.out, values.out.endsWith(".glb") ? toGLB(motion) : toBVH(motion));
  console.log(`${values.out}: ${motion.seconds.toFixed(1)} s`);
});
