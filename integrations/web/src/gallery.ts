// A gallery as `motionrt web export` writes it: clips, the spans that were embedded, their vectors, and motions.
import { InvalidInputError, LoadError } from "./errors";
import { Motion } from "./motion";
import { readFloats } from "./npy";
import { matrixOf } from "./rotations";
import { JOINTS } from "./skeleton";
import type { Source } from "./sessions";

export interface Hit {
  score: number;
  id: string;
  text: string;
  start_s: number;
  end_s: number;
}

interface Clip {
  id: string;
  text: string;
  seconds: number;
}

/** Clip, start and end in seconds. */
type Window = [number, number, number];

export class Gallery {
  private constructor(
    readonly clips: readonly Clip[],
    private readonly windows: readonly Window[],
    private readonly width: number,
    private readonly embeddings: Float32Array,
    private readonly read: ((file: string) => Promise<Uint8Array>) | null,
  ) {}

  /** Read the gallery in `folder` of a source; LoadError where it is none. */
  static async open(source: Source, folder: string): Promise<Gallery> {
    const head = JSON.parse(new TextDecoder().decode(await source(`${folder}/gallery.json`)));
    if (head.version !== 1) throw new LoadError(`${folder} is no gallery of version 1; write it with: motionrt web export`);
    const { shape, data } = readFloats(await source(`${folder}/embeddings.npy`), "embeddings.npy");
    if (shape[0] !== head.windows.length) throw new LoadError(`${folder}: ${shape[0]} embeddings of ${head.windows.length} windows`);
    return new Gallery(head.clips, head.windows, shape[1], data, head.motions ? (file) => source(`${folder}/clips/${file}`) : null);
  }

  /** The `k` clips whose best window is nearest to a unit vector, best first. */
  search(query: Float32Array, k = 10): Hit[] {
    if (query.length !== this.width) throw new InvalidInputError(`the gallery's vectors have ${this.width} numbers, not ${query.length}`);
    const best = new Map<number, { score: number; row: number }>();
    this.windows.forEach(([clip], row) => {
      const score = this.score(row, query);
      if (!((best.get(clip)?.score ?? -Infinity) >= score)) best.set(clip, { score, row });
    });
    return [...best.entries()]
      .sort(([a, x], [b, y]) => y.score - x.score || a - b)
      .slice(0, k)
      .map(([clip, { score, row }]) => {
        const [, start_s, end_s] = this.windows[row];
        return { score, id: this.clips[clip].id, text: this.clips[clip].text, start_s, end_s };
      });
  }

  /** The motion of a clip, 30 fps; InvalidInputError where the gallery carries none. */
  async motion(id: string): Promise<Motion> {
    const number = this.clips.findIndex((clip) => clip.id === id);
    if (number < 0 || !this.read) throw new InvalidInputError(number < 0 ? `no clip ${id} in the gallery` : "the gallery carries no motions");
    const { shape, data } = readFloats(await this.read(`${number}.npy`), `${number}.npy`);
    const [rotations, root] = [new Float32Array(shape[0] * JOINTS * 9), new Float32Array(shape[0] * 3)];
    for (let f = 0; f < shape[0]; f++) {
      const row = data.subarray(f * shape[1], (f + 1) * shape[1]);
      root.set(row.subarray(0, 3), 3 * f);
      for (let j = 0; j < JOINTS; j++) rotations.set(matrixOf(Array.from(row.subarray(3 + 4 * j, 7 + 4 * j))), (f * JOINTS + j) * 9);
    }
    return new Motion(rotations, root);
  }

  private score(row: number, query: Float32Array): number {
    let sum = 0;
    for (let i = 0, at = row * this.width; i < this.width; i++, at++) sum += this.embeddings[at] * query[i];
    return sum;
  }
}
