// MotionRT in a Web Worker: `serveWorker()` inside the worker, `RemoteMotionRT` in the page. Nothing of the page waits.
import type { Hit } from "./gallery";
import type { Line } from "./generation";
import { MotionRTError } from "./errors";
import { Motion } from "./motion";
import { MotionRT } from "./runtime";
import type { Progress } from "./sessions";
import { Steering, Stroller } from "./stroller";
import { type Crowd, type Goal, WIDTH } from "./walking";

export interface RemoteOptions {
  from: string;
  wasm?: string;
  threads?: number;
  tower?: "tmr_text" | "tmr_student";
}

interface Plain {
  rotations: Float32Array;
  root: Float32Array;
  fps: number;
}

export interface RemoteSampling {
  seconds?: number;
  seed?: number;
  steps?: number;
  guidance?: number;
}

/** What the worker does; every method is called by name. */
class Desk {
  private rt!: MotionRT;
  private stroller: Stroller | null = null;
  private crowd: { crowd: Crowd; steering: Steering[] } | null = null;

  constructor(private readonly tell: (kind: string, value: unknown) => void) {}

  async open(options: RemoteOptions): Promise<string[]> {
    this.rt = await MotionRT.open({ ...options, onProgress: (progress: Progress) => this.tell("progress", progress) });
    return Object.keys(this.rt.described.models);
  }

  async start(place: Goal): Promise<void> {
    this.stroller = await this.rt.stroller(place);
  }

  walkTo(x: number, z: number): void {
    this.stroller?.walkTo(x, z);
  }

  async act(motion: Plain): Promise<void> {
    this.stroller?.act(new Motion(motion.rotations, motion.root, motion.fps));
  }

  async step(): Promise<{ frame: Float32Array; state: string }> {
    if (!this.stroller) throw new MotionRTError("no character has started");
    return { frame: Float32Array.from(await this.stroller.step()), state: this.stroller.state };
  }

  async startCrowd(places: Goal[]): Promise<void> {
    this.crowd = { crowd: await this.rt.crowd(places), steering: places.map(({ heading }) => new Steering(heading)) };
  }

  /** All frames of the crowd in one array, N x 219. */
  async stepCrowd(goals: { x: number; z: number }[], speed: number): Promise<Float32Array> {
    if (!this.crowd) throw new MotionRTError("no crowd has started");
    const { crowd, steering } = this.crowd;
    const frames = await crowd.step(goals.map((goal, i) => steering[i].aim(...crowd.place(i), goal)), speed);
    const out = new Float32Array(frames.length * WIDTH);
    frames.forEach((frame, i) => out.set(frame, i * WIDTH));
    return out;
  }

  async generate(what: string | Line[], sampling: RemoteSampling): Promise<Plain> {
    return plain(await this.rt.generate(what, { ...sampling, onStep: (share) => this.tell("step", share) }));
  }

  async embed(text: string): Promise<Float32Array> {
    return this.rt.text.embed(text);
  }

  search(text: string, k: number, gallery: string): Promise<Hit[]> {
    return this.rt.search(text, k, gallery);
  }

  async clip(id: string, gallery: string): Promise<Plain> {
    return plain(await (await this.rt.gallery(gallery)).motion(id));
  }

  async clips(gallery: string): Promise<{ id: string; text: string }[]> {
    return (await this.rt.gallery(gallery)).clips.map(({ id, text }) => ({ id, text }));
  }
}

function plain({ rotations, root, fps }: Motion): Plain {
  return { rotations, root, fps };
}

/** Answer a page's calls, one at a time; for the script of a worker. */
export function serveWorker(): void {
  const port = globalThis as unknown as DedicatedWorkerGlobalScope;
  const desk = new Desk((kind, value) => port.postMessage({ kind, value }));
  let last: Promise<void> = Promise.resolve();
  port.onmessage = ({ data }: MessageEvent<{ number: number; method: keyof Desk; args: unknown[] }>) => {
    last = last.then(async () => {
      try {
        const value = await (desk[data.method] as (...args: unknown[]) => unknown).apply(desk, data.args);
        port.postMessage({ number: data.number, value });
      } catch (error) {
        port.postMessage({ number: data.number, error: error instanceof Error ? `${error.message}` : String(error) });
      }
    });
  };
}

type Answers = { [K in keyof Desk]: Desk[K] extends (...args: infer A) => infer R ? (...args: A) => Promise<Awaited<R>> : never };

/** The worker's methods as promises; a failure is a MotionRTError. */
export class RemoteMotionRT {
  /** Told how far files are. */
  onProgress: (progress: Progress) => void = () => undefined;
  /** Told the share of a generation that is done. */
  onStep: (share: number) => void = () => undefined;
  readonly call: Answers;
  private readonly waiting = new Map<number, { done: (value: unknown) => void; failed: (error: Error) => void }>();
  private number = 0;

  constructor(private readonly worker: Worker) {
    worker.onmessage = ({ data }) => this.told(data);
    worker.onerror = (event) => this.waiting.forEach(({ failed }) => failed(new MotionRTError(event.message)));
    this.call = new Proxy({} as Answers, { get: (_, method: string) => (...args: unknown[]) => this.ask(method, args) });
  }

  private ask(method: string, args: unknown[]): Promise<unknown> {
    return new Promise((done, failed) => {
      this.waiting.set(++this.number, { done, failed });
      this.worker.postMessage({ number: this.number, method, args });
    });
  }

  private told(data: { kind?: string; number?: number; value?: unknown; error?: string }): void {
    if (data.kind === "progress") return this.onProgress(data.value as Progress);
    if (data.kind === "step") return this.onStep(data.value as number);
    const { done, failed } = this.waiting.get(data.number!)!;
    this.waiting.delete(data.number!);
    if (data.error === undefined) done(data.value);
    else failed(new MotionRTError(data.error));
  }
}
