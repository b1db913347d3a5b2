// What benchmarks/web.py asks of Node.js: milliseconds of motionrt-web there, by onnxruntime-web or onnxruntime-node.
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const { site, web, native, frames, texts } = JSON.parse(readFileSync(0, "utf8"));
const { MotionRT } = await import(pathToFileURL(`${web}/dist/lib/index.js`));
const { folder } = await import(pathToFileURL(`${web}/dist/lib/node.js`));
const rt = await MotionRT.open({ from: folder(site), engine: native ? await import(native) : undefined });

async function timed(count, call) {
  const times = [];
  for (let n = 0; n < count; n++) {
    const began = performance.now();
    await call(n);
    times.push(performance.now() - began);
  }
  const later = times.slice(Math.floor(count / 4)).sort((a, b) => a - b);
  return later[Math.floor(later.length / 2)];
}

const goal = { x: 2, z: 6, heading: 0.4 };
const one = await rt.crowd([{ x: 0, z: 0, heading: 0 }]);
const places = Array.from({ length: 32 }, (_, i) => ({ x: 2 * (i % 8), z: 3 * Math.floor(i / 8), heading: i }));
const crowd = await rt.crowd(places);
const told = {
  "walk, a frame": await timed(frames, () => one.step([goal])),
  "crowd of 32, a character": (await timed(frames / 3, () => crowd.step(places.map(() => goal)))) / 32,
  "text to hits": await timed(texts.length, (n) => rt.search(texts[n], 10)),
  "motion of 4 s": await timed(3, (n) => rt.generate(texts[n], { seconds: 4, seed: n })),
};
process.stdout.write(JSON.stringify(told));
