import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { Motion, poseBetween, toGLB } from "../src/index";
import { Character, Figures, guessMapping, type Mapping, type Pose } from "../src/three";
import { RemoteMotionRT } from "../src/worker";
import { Stage } from "./stage";

const FPS = 30;
const AHEAD = 3; // frames that are kept ready
const CROWD = 32;
const WIDTH = 219;
const COLOURS = ["#4f86c6", "#e07a5f", "#81b29a", "#f2cc8f", "#7d6b91", "#3d9a9b", "#d1687f", "#8fa34a"];

const get = <T extends HTMLElement>(id: string): T => document.getElementById(id) as T;
const say = (text: string): void => void (get("status").textContent = text);

/** Frames at 30 fps that a display of any rate shows, interpolated; asks for more before it runs out. */
class Playback {
  private frames: Float32Array[] = [];
  private shown = 0; // share of the way from the first frame to the second
  private asking = 0;
  readonly waits: number[] = []; // ms from asking to having

  constructor(private readonly next: () => Promise<Float32Array>) {}

  /** The pair of frames to show after so many seconds, and how far between them; null while there are none. */
  advance(seconds: number): { before: Float32Array; after: Float32Array; weight: number } | null {
    this.fill();
    if (this.frames.length < 2) return this.frames.length ? { before: this.frames[0], after: this.frames[0], weight: 0 } : null;
    this.shown += seconds * FPS;
    while (this.shown >= 1 && this.frames.length > 2) {
      this.frames.shift();
      this.shown--;
    }
    this.shown = Math.min(this.shown, 1);
    return { before: this.frames[0], after: this.frames[1], weight: this.shown };
  }

  /** Whether there are frames to go on with; asks for them otherwise. */
  get ready(): boolean {
    this.fill();
    return this.frames.length > 2;
  }

  private fill(): void {
    for (; this.frames.length + this.asking < AHEAD + 1; this.asking++) {
      const asked = performance.now();
      this.next()
        .then((frame) => {
          this.frames.push(frame);
          this.waits.push(performance.now() - asked);
        })
        .catch((error: Error) => say(error.message))
        .finally(() => this.asking--);
    }
  }
}

const stage = new Stage();
const remote = new RemoteMotionRT(new Worker(new URL("./worker.ts", import.meta.url), { type: "module" }));
const files = new Map<string, number>();
const times: Record<string, number> = { start: performance.now() };
let figures = new Figures(1, COLOURS);
let character: Character | null = null;
let single: Playback | null = null;
let crowd: { playback: Playback; goals: { x: number; z: number }[] } | null = null;
let state = "loads";
let last: Motion | null = null;
let drawn = 0;
stage.scene.add(figures);

remote.onProgress = ({ file, loaded, total }) => {
  files.set(file, loaded);
  const bar = get("bar");
  bar.style.visibility = loaded < total ? "visible" : "hidden";
  (bar.firstElementChild as HTMLElement).style.width = `${(100 * loaded) / (total || loaded)}%`;
  if (loaded < total) say(`Loading ${file.split("/").pop()} … ${(loaded / 1e6).toFixed(1)} of ${(total / 1e6).toFixed(1)} MB`);
};
remote.onStep = (share) => say(`Making the motion … ${Math.round(100 * share)} %`);

/** Run an action of the panel; what goes wrong is said there. */
async function attempt(button: HTMLButtonElement, work: () => Promise<void>): Promise<void> {
  button.disabled = true;
  try {
    await work();
  } catch (error) {
    say(error instanceof Error ? error.message : String(error));
  } finally {
    button.disabled = false;
  }
}

async function act(text: string, seed = Math.floor(Math.random() * 2 ** 31)): Promise<void> {
  const { rotations, root, fps } = await remote.call.generate(text, { seconds: 4, seed });
  await play(new Motion(rotations, root, fps), `“${text}”, seed ${seed}`);
}

async function play(motion: Motion, name: string): Promise<void> {
  last = motion;
  get<HTMLButtonElement>("save").disabled = false;
  await leaveCrowd();
  await remote.call.act(motion);
  say(name);
}

async function search(text: string): Promise<void> {
  const hits = await remote.call.search(text, 5, "starter");
  get("hits").replaceChildren(
    ...hits.map(({ id, text: caption, score }) => {
      const item = document.createElement("li");
      const button = document.createElement("button");
      const points = document.createElement("span");
      button.textContent = caption || id;
      points.textContent = score.toFixed(2);
      button.append(points);
      button.onclick = () =>
        attempt(button, async () => {
          const { rotations, root, fps } = await remote.call.clip(id, "starter");
          await play(new Motion(rotations, root, fps), caption || id);
        });
      item.append(button);
      return item;
    }),
  );
  say(`${hits.length} clips`);
}

const somewhere = (): { x: number; z: number } => ({ x: (Math.random() - 0.5) * 14, z: (Math.random() - 0.5) * 14 });

async function startCrowd(): Promise<void> {
  if (character) stage.scene.remove(character.scene);
  character = null;
  const places = Array.from({ length: CROWD }, (_, i) => ({ x: 2 * (i % 8) - 7, z: 3 * Math.floor(i / 8) - 5, heading: Math.random() * 6 }));
  await remote.call.startCrowd(places);
  const goals = places.map(somewhere);
  show(new Figures(CROWD, COLOURS));
  crowd = { goals, playback: new Playback(() => remote.call.stepCrowd(goals, 1.2)) };
  stage.camera.position.set(9, 7, 12);
  stage.controls.target.set(0, 0.5, 0);
  get("crowd").textContent = "One character";
  say("32 characters, each to places of its own");
}

async function leaveCrowd(): Promise<void> {
  if (!crowd) return;
  crowd = null;
  show(new Figures(1, COLOURS));
  get("crowd").textContent = "Crowd of 32";
}

function show(next: Figures): void {
  stage.scene.remove(figures);
  figures.dispose();
  stage.scene.add((figures = next));
}

async function become(glb: ArrayBuffer, mapping?: Mapping): Promise<void> {
  const { scene } = await new GLTFLoader().parseAsync(glb, "");
  const next = new Character(scene, mapping ?? guessMapping(scene));
  if (character) stage.scene.remove(character.scene);
  stage.scene.add(scene);
  character = next;
  figures.visible = false;
  say("This is the character now");
}

function walkTo(x: number, z: number): void {
  stage.mark(x, z);
  times.clicked = performance.now();
  void remote.call.walkTo(x, z);
}

let shown: Pose | null = null;

/** Where the character is, and what it does. */
const where = (): { x: number; z: number; state: string } => ({ x: shown?.root[0] ?? 0, z: shown?.root[2] ?? 0, state });

let before = performance.now();
let manual = false; // whether time stands still but for tick()
function frame(now: number): void {
  if (!manual) advance(Math.min((now - before) / 1000, 0.1), now);
  before = now;
  requestAnimationFrame(frame);
}

/** Let so much time pass, however long the models and the picture take: for recordings. */
async function tick(seconds: number): Promise<void> {
  manual = true;
  for (let left = seconds; left > 1e-6; left -= 1 / FPS) {
    const playback = crowd?.playback ?? single!;
    while (!playback.ready) await new Promise((done) => setTimeout(done, 2));
    advance(Math.min(left, 1 / FPS), performance.now());
  }
}

/** Go on by so many seconds, and draw. */
function advance(seconds: number, now: number): void {
  if (crowd) {
    const found = crowd.playback.advance(seconds);
    for (let i = 0; found && i < CROWD; i++) {
      const part = (all: Float32Array): Float32Array => all.subarray(i * WIDTH, (i + 1) * WIDTH);
      const pose = poseBetween(part(found.before), part(found.after), found.weight);
      figures.pose(i, pose);
      const goal = crowd.goals[i];
      if (Math.hypot(goal.x - pose.root[0], goal.z - pose.root[2]) < 0.6) crowd.goals[i] = somewhere();
    }
  } else if (single) {
    const found = single.advance(seconds);
    if (found) {
      const pose: Pose = (shown = poseBetween(found.before, found.after, found.weight));
      if (character) character.pose(pose);
      else figures.pose(0, pose);
      stage.look(pose.root[0], pose.root[2]);
      times.shown ??= now;
    }
  }
  stage.draw();
  drawn++;
}

addEventListener("dragover", (event) => event.preventDefault());
document.addEventListener("drop", (event) => {
  event.preventDefault();
  void dropped([...(event.dataTransfer?.files ?? [])]).catch((error: Error) => say(error.message));
});

/** A GLB, and beside it perhaps the mapping that `motionrt rig map --json` wrote. */
async function dropped(given: File[]): Promise<void> {
  const glb = given.find(({ name }) => name.toLowerCase().endsWith(".glb"));
  const mapping = given.find(({ name }) => name.toLowerCase().endsWith(".json"));
  if (!glb) throw new Error("Drop a .glb file, with a mapping (.json) beside it if you have one");
  await become(await glb.arrayBuffer(), mapping ? (JSON.parse(await mapping.text()) as Mapping) : undefined);
}

get<HTMLFormElement>("act").onsubmit = (event) => {
  event.preventDefault();
  void attempt(get("do"), () => act(get<HTMLInputElement>("text").value || get<HTMLInputElement>("text").placeholder));
};
get<HTMLFormElement>("find").onsubmit = (event) => {
  event.preventDefault();
  void attempt(get("find").querySelector("button")!, () => search(get<HTMLInputElement>("query").value));
};
get("crowd").onclick = () => attempt(get("crowd"), () => (crowd ? leaveCrowd() : startCrowd()));
get("save").onclick = () => {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([toGLB(last!) as BlobPart], { type: "model/gltf-binary" }));
  link.download = "motion.glb";
  link.click();
  URL.revokeObjectURL(link.href);
};
stage.onGround((x, z) => walkTo(x, z));

/** For tests of the page, and for whoever plays with the console. */
const handle = {
  remote, stage, files, times, act, become, walkTo, startCrowd, tick, where,
  get drawn() { return drawn; },
  get state() { return state; },
  get waits() { return (crowd?.playback ?? single)?.waits ?? []; },
};
Object.assign(globalThis, { motionrt: handle });

const start = new URL(".", location.href);
await remote.call.open({ from: start.href, wasm: new URL("ort/", start).href });
await remote.call.start({ x: 0, z: 0, heading: 0.5 });
single = new Playback(async () => {
  const found = await remote.call.step();
  state = found.state;
  return found.frame;
});
say("Click the ground");
requestAnimationFrame(frame);
