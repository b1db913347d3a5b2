import { compose, type Layer } from "./composing";
import { LoadError } from "./errors";
import { Gallery, type Hit } from "./gallery";
import { Generator, type Line, type Sampling } from "./generation";
import type { Motion } from "./motion";
import { configure, type Engine, fetched, type Progress, Sessions, type Source } from "./sessions";
import { Stroller } from "./stroller";
import { TextEncoder as TextTower } from "./text";
import { Tokenizer } from "./tokenizer";
import { Crowd, type Goal, strideAt } from "./walking";

export interface Options {
  /** Address of the folder that `motionrt web export` wrote, or a function that gives its files. */
  from: string | URL | Source;
  /** How far a file is; only where `from` is an address. */
  onProgress?: (progress: Progress) => void;
  /** Folder of onnxruntime's WebAssembly files; where they are not beside the script. */
  wasm?: string;
  /** Threads of onnxruntime; more than one needs a page that is isolated (COOP and COEP). */
  threads?: number;
  /** Another onnxruntime than onnxruntime-web, such as `onnxruntime-node`. */
  engine?: Engine;
  /** What embeds texts for a search: `tmr_text` also serves the generator, `tmr_student` is quicker and loads 9 MB. */
  tower?: "tmr_text" | "tmr_student";
}

/** models.json of the folder. */
export interface Described {
  version: string;
  models: Record<string, { file: string; bytes: number }>;
  galleries: string[];
}

/** Everything, with models that open when they are first needed. */
export class MotionRT {
  readonly text: TextTower;
  private readonly generator: Generator;
  private readonly galleries = new Map<string, Promise<Gallery>>();
  private tokenizerFile?: Promise<Tokenizer>;

  private constructor(readonly sessions: Sessions, readonly described: Described, tower: string) {
    this.text = new TextTower(sessions, () => this.tokenizer(), tower);
    this.generator = new Generator(sessions, this.text);
  }

  static async open(options: Options): Promise<MotionRT> {
    configure({ paths: options.wasm, threads: options.threads });
    const plain = typeof options.from === "function" ? options.from : fetched(options.from, undefined, "head");
    const described = parsed<Described>(await plain("models.json"), "models.json");
    if (!described.models) throw new LoadError("models.json names no models; write the folder with: motionrt web export");
    const source = typeof options.from === "function" ? options.from : fetched(options.from, options.onProgress, described.version);
    const files = Object.fromEntries(Object.entries(described.models).map(([name, { file }]) => [name, file]));
    return new MotionRT(new Sessions(source, files, options.engine), described, options.tower ?? "tmr_text");
  }

  tokenizer(): Promise<Tokenizer> {
    return (this.tokenizerFile ??= this.sessions.source("tokenizer.json").then((content) => new Tokenizer(parsed(content, "tokenizer.json"))));
  }

  gallery(name = "starter"): Promise<Gallery> {
    let found = this.galleries.get(name);
    if (!found) this.galleries.set(name, (found = Gallery.open(this.sessions.source, `galleries/${name}`)));
    return found;
  }

  /** The clips of a gallery that a text fits best, by their embeddings. */
  async search(text: string, k = 10, gallery = "starter"): Promise<Hit[]> {
    const query = await this.text.embed(text);
    return (await this.gallery(gallery)).search(query, k);
  }

  /** A motion of a text, or of a timeline: 30 fps; the same numbers for a seed as in Python. */
  generate(what: string | Line[], sampling?: Sampling): Promise<Motion> {
    return this.generator.generate(what, sampling);
  }

  compose(layers: readonly Layer[]): Motion {
    return compose(layers);
  }

  /** One character for a game's loop. */
  async stroller(place: Goal = { x: 0, z: 0, heading: 0 }, speed?: number): Promise<Stroller> {
    await this.sessions.session("walknet");
    return new Stroller(this.sessions, place, speed);
  }

  /** Characters in mid-stride. */
  async crowd(places: readonly Goal[]): Promise<Crowd> {
    await this.sessions.session("walknet");
    return new Crowd(this.sessions, places.map(strideAt));
  }
}

function parsed<T>(content: Uint8Array, file: string): T {
  try {
    return JSON.parse(new TextDecoder().decode(content)) as T;
  } catch {
    throw new LoadError(`${file} is no JSON`);
  }
}
