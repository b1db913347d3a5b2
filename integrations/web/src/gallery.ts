// A gallery as `motionrt gallery build` writes it: gallery.json names the clips and the files beside it.
import { InvalidInputError, LoadError } from "./errors";
import { readFloats, readRecords } from "./npy";
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
  text?: string;
}

export class Gallery {
  private constructor(readonly clips: Clip[], private readonly width: number, private readonly embeddings: Float32Array, private readonly windows: Record<string, number>[]) {}

  /** Read the gallery in `folder` of a source; LoadError where it is none. */
  static async open(source: Source, folder: string): Promise<Gallery> {
    const head = JSON.parse(new TextDecoder().decode(await source(`${folder}/gallery.json`)));
    if (head.format !== "motionrt-gallery" || head.version !== 1)
      throw new LoadError(`${folder} is no gallery of version 1; export it with: motionrt gallery export`);
    const file = (name: string): string => `${folder}/${head.files[name]}`;
    const { shape, data } = readFloats(await source(file("embeddings")), file("embeddings"));
    const windows = readRecords(await source(file("windows")), file("windows"));
    if (shape[0] !== windows.length) throw new LoadError(`${folder}: ${shape[0]} embeddings of ${windows.length} windows`);
    return new Gallery(head.clips, shape[1], data, windows);
  }

  /** The `k` clips whose best window is nearest to a unit vector, best first. */
  search(query: Float32Array, k = 10): Hit[] {
    if (query.length !== this.width) throw new InvalidInputError(`the gallery's vectors have ${this.width} numbers, not ${query.length}`);
    const best = new Map<number, { score: number; row: number }>();
    this.windows.forEach(({ clip }, row) => {
      const score = this.score(row, query);
      if (!((best.get(clip)?.score ?? -Infinity) >= score)) best.set(clip, { score, row });
    });
    return [...best.entries()]
      .sort(([a, x], [b, y]) => y.score - x.score || a - b)
      .slice(0, k)
      .map(([clip, { score, row }]) => {
        const { id, text } = this.clips[clip];
        return { score, id, text: text ?? "", start_s: this.windows[row].start_s, end_s: this.windows[row].end_s };
      });
  }

  private score(row: number, query: Float32Array): number {
    let sum = 0;
    for (let i = 0, at = row * this.width; i < this.width; i++, at++) sum += this.embeddings[at] * query[i];
    return sum;
  }
}
