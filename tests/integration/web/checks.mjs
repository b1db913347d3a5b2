// What the tests ask of motionrt-web in Node.js: reads jobs as JSON from stdin, writes their results as JSON to stdout.
import { InvalidInputError, LoadError, MotionRT, Motion, Random, Tokenizer, compose, gesturesOf, parseQuery, slotsOf, targetsOf, toBVH, toGLB } from "motionrt-web";
import { folder } from "motionrt-web/node";
import { readFileSync, writeFileSync } from "node:fs";

const input = JSON.parse(readFileSync(0, "utf8"));
const files = folder(input.site);
const open = () => MotionRT.open({ from: files });
const motionOf = ({ rotations, root }) => new Motion(Float32Array.from(rotations), Float32Array.from(root));
const plain = ({ rotations, root }) => ({ rotations: [...rotations], root: [...root] });

const jobs = {
  async tokens({ texts }) {
    const tokenizer = new Tokenizer(JSON.parse(new TextDecoder().decode(await files("tokenizer.json"))));
    return texts.map((text) => tokenizer.encode(text));
  },
  said: ({ texts, seconds }) =>
    texts.map((text) => {
      const said = parseQuery(text);
      const { numbers, known } = targetsOf(said, seconds);
      return { slots: slotsOf(said), numbers: [...numbers], known };
    }),
  gestures: ({ texts }) => texts.map((text) => gesturesOf(parseQuery(text))),
  normals: ({ seed, sample, count }) => [...new Random(seed, sample).normals(count)],
  async embed({ texts }) {
    const rt = await open();
    const found = [];
    for (const text of texts) found.push([...(await rt.text.embed(text))]);
    return found;
  },
  search: async ({ text, k }) => (await open()).search(text, k),
  async walk({ goals, frames, speed }) {
    const crowd = await (await open()).crowd([{ x: 0, z: 0, heading: 0 }]);
    const found = [];
    for (let f = 0; f < frames; f++) {
      const [x, z, heading] = goals.filter(({ from }) => from <= f).pop().goal;
      found.push([...(await crowd.step([{ x, z, heading }], speed))[0]]);
    }
    return found;
  },
  async crowd({ places, goals, frames }) {
    const crowd = await (await open()).crowd(places);
    let last;
    for (let f = 0; f < frames; f++) last = await crowd.step(goals);
    return last.map((frame) => [...frame]);
  },
  async generate({ text, seconds, seed, steps, features, width }) {
    const given = features && { tokens: features.length / width, features: Float32Array.from(features) };
    return plain(await (await open()).generate(text, { seconds, seed, steps, features: given }));
  },
  async motions({ asked }) {
    const rt = await open();
    const found = [];
    for (const { what, seconds, seed, footLock } of asked) found.push(plain(await rt.generate(what, { seconds, seed, footLock })));
    return found;
  },
  async stroll({ x, z, frames }) {
    const stroller = await (await open()).stroller();
    stroller.walkTo(x, z);
    const found = [];
    for (let f = 0; f < frames; f++) found.push([...(await stroller.step())]);
    return { frames: found, state: stroller.state };
  },
  compose: ({ layers }) => plain(compose(layers.map(({ motion, parts }) => ({ motion: motionOf(motion), parts })))),
  files({ motion, bvh, glb }) {
    writeFileSync(bvh, toBVH(motionOf(motion)));
    writeFileSync(glb, toGLB(motionOf(motion)));
  },
  async clip({ id }) {
    return plain(await (await (await open()).gallery()).motion(id));
  },
  async errors() {
    const rt = await open();
    const wrong = {
      empty: () => rt.text.embed("  "),
      seconds: () => rt.generate("walk", { seconds: 11 }),
      goal: async () => (await rt.crowd([{ x: 0, z: 0, heading: 0 }])).step([{ x: NaN, z: 0, heading: 0 }]),
      part: () => compose([{ motion: standing() }, { motion: standing(), parts: ["tail"] }]),
      missing: () => MotionRT.open({ from: folder("/nowhere") }),
    };
    const found = {};
    for (const [name, call] of Object.entries(wrong))
      await Promise.resolve()
        .then(call)
        .catch((error) => (found[name] = { kind: error instanceof InvalidInputError ? "input" : error instanceof LoadError ? "load" : error.name, message: error.message }));
    return found;
  },
};

function standing() {
  const rotations = Float32Array.from({ length: 216 }, (_, i) => (i % 9 === 0 || i % 9 === 4 || i % 9 === 8 ? 1 : 0));
  return new Motion(rotations, Float32Array.of(0, 0.9, 0));
}

process.stdout.write(JSON.stringify((await jobs[input.job](input)) ?? null));
