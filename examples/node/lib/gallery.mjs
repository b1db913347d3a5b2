// A gallery as `motionrt gallery build` writes it: gallery.json names the segments and their files (docs/scale.md).
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { readColumns } from "./safetensors.mjs";

export class Gallery {
  static async open(folder) {
    const head = JSON.parse(await readFile(join(folder, "gallery.json"), "utf8"));
    if (head.format !== "motionrt-gallery" || head.version !== 2)
      throw new Error(`${folder} is no gallery of version 2; make it one: motionrt gallery compact`);
    const gallery = new Gallery();
    gallery.clips = [];
    gallery.windows = [];
    for (const { files } of head.segments) await gallery.#add(folder, files);
    return gallery;
  }

  /** The `k` clips whose best window is nearest to a unit vector: [{ score, id, start_s, end_s }], best first. */
  search(query, k = 10) {
    const best = new Map();
    for (const window of this.windows) {
      const score = dot(window, query);
      if (!(best.get(window.clip)?.score >= score)) best.set(window.clip, { score, ...window });
    }
    return [...best.values()]
      .sort((a, b) => b.score - a.score || a.clip - b.clip)
      .slice(0, k)
      .map(({ score, clip, start_s, end_s }) => ({ score, id: this.clips[clip].id, start_s, end_s }));
  }

  async #add(folder, files) {
    const table = await readColumns(join(folder, files.clips));
    const { vectors, scales } = await readColumns(join(folder, files.embeddings));
    if (!vectors) throw new Error(`${files.embeddings} is in float16: motionrt gallery compact --precision int8`);
    const deleted = files.deleted ? (await readColumns(join(folder, files.deleted))).clips.data : [];
    const gone = new Set(deleted);
    const first = this.clips.length;
    texts(table.ids.data, table.id_ends.data).forEach((id) => this.clips.push({ id }));
    const records = new DataView(table.windows.data.buffer);
    for (let row = 0; row < table.windows.shape[0]; row++) {
      const clip = records.getInt32(12 * row, true);
      if (gone.has(clip)) continue;
      const [start_s, end_s] = [records.getFloat32(12 * row + 4, true), records.getFloat32(12 * row + 8, true)];
      const vector = vectors.data.subarray(row * vectors.shape[1], (row + 1) * vectors.shape[1]);
      this.windows.push({ clip: first + clip, start_s, end_s, vector, scale: scales ? scales.data[row] : 1 });
    }
  }
}

function dot({ vector, scale }, query) {
  let sum = 0;
  for (let i = 0; i < vector.length; i++) sum += vector[i] * query[i];
  return scale * sum;
}

/** Texts in UTF-8, one behind the other, and where each ends. */
function texts(content, ends) {
  const decoder = new TextDecoder();
  return Array.from(ends, (end, i) => decoder.decode(content.subarray(i ? Number(ends[i - 1]) : 0, Number(end))));
}
