// Files and models: loaded when they are needed, with progress, kept by the browser's cache.
import * as ort from "onnxruntime-web/wasm";
import { LoadError } from "./errors";

export type Tensors = Record<string, ort.Tensor>;

/** How far a file is: `total` is 0 where the server does not say. */
export interface Progress {
  file: string;
  loaded: number;
  total: number;
}

/** Gives a file's content by its name, such as `models/walknet.int8.onnx`. */
export type Source = (file: string) => Promise<Uint8Array>;

/** Files below an address, kept in the browser's cache under their address and `version`. */
export function fetched(base: string | URL, onProgress?: (progress: Progress) => void, version = "1"): Source {
  return async (file) => {
    const address = new URL(file, base);
    const store = "caches" in globalThis ? await caches.open(`motionrt-${version}`).catch(() => null) : null;
    const kept = await store?.match(address);
    const answer = kept ?? (await fetch(address).catch((error: unknown) => fail(file, String(error))));
    if (!answer.ok) fail(file, `${answer.status} ${answer.statusText}`);
    const content = await read(answer, file, onProgress);
    if (!kept) await store?.put(address, new Response(content as unknown as BodyInit)).catch(() => undefined); // a full disk is no reason to stop
    return content;
  };
}

function fail(file: string, why: string): never {
  throw new LoadError(`cannot load ${file}: ${why}`);
}

async function read(answer: Response, file: string, onProgress?: (progress: Progress) => void): Promise<Uint8Array> {
  const total = Number(answer.headers.get("content-length") ?? 0);
  if (!answer.body) return new Uint8Array(await answer.arrayBuffer());
  const parts: Uint8Array[] = [];
  let loaded = 0;
  for (const reader = answer.body.getReader(); ; ) {
    const { done, value } = await reader.read();
    if (done) break;
    parts.push(value);
    loaded += value.length;
    onProgress?.({ file, loaded, total });
  }
  const out = new Uint8Array(loaded);
  let at = 0;
  for (const part of parts) {
    out.set(part, at);
    at += part.length;
  }
  return out;
}

/** An onnxruntime: `onnxruntime-web`, or `onnxruntime-node` where native code may run. */
export type Engine = Pick<typeof ort, "InferenceSession" | "Tensor">;

/** Models by name, each opened once, and tensors for them. */
export class Sessions {
  private readonly open = new Map<string, Promise<ort.InferenceSession>>();

  /** `files`: name of a model -> its file, as the description of the models says. */
  constructor(readonly source: Source, private readonly files: Readonly<Record<string, string>>, private readonly engine: Engine = ort) {}

  session(model: string): Promise<ort.InferenceSession> {
    let found = this.open.get(model);
    if (!found) {
      found = this.opened(model);
      found.catch(() => this.open.delete(model));
      this.open.set(model, found);
    }
    return found;
  }

  async run(model: string, feeds: Tensors, outputs: string[]): Promise<Tensors> {
    return (await (await this.session(model)).run(feeds, outputs)) as Tensors;
  }

  float(data: Float32Array, shape: number[]): ort.Tensor {
    return new this.engine.Tensor("float32", data, shape);
  }

  whole(values: ArrayLike<number>, shape: number[]): ort.Tensor {
    return new this.engine.Tensor("int64", BigInt64Array.from(Array.from(values), BigInt), shape);
  }

  flags(values: ArrayLike<boolean | number>, shape: number[]): ort.Tensor {
    return new this.engine.Tensor("bool", Uint8Array.from(Array.from(values as ArrayLike<number>), Number), shape);
  }

  private async opened(model: string): Promise<ort.InferenceSession> {
    const file = this.files[model];
    if (!file) throw new LoadError(`no file of the model ${model}; there are: ${Object.keys(this.files).join(", ")}`);
    const content = await this.source(file);
    try {
      return await this.engine.InferenceSession.create(content, this.engine === ort ? { executionProviders: ["wasm"] } : { intraOpNumThreads: 1 });
    } catch (error) {
      throw new LoadError(`${file} does not open: ${error instanceof Error ? error.message : String(error)}`);
    }
  }
}

export const numbers = (tensor: ort.Tensor): Float32Array => tensor.data as Float32Array;

/** Where onnxruntime's WebAssembly lies, and how many threads it may use. */
export function configure(wasm: { paths?: string; threads?: number }): void {
  if (wasm.paths) ort.env.wasm.wasmPaths = wasm.paths;
  ort.env.wasm.numThreads = wasm.threads ?? 1;
}
