// A gallery as `motionrt gallery build` writes it: gallery.json names the clips and the files beside it.
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { readNpy } from "./npy.mjs";

export class Gallery {
  static async open(folder) {
    const head = JSON.parse(await readFile(join(folder, "gallery.json"), "utf8"));
    if (head.format !== "motionrt-gallery" || head.version !== 1) throw new Error(`${folder} is no gallery of version 1`);
    const embeddings = await readNpy(join(folder, head.files.embeddings));
    const windows = await readWindows(join(folder, head.files.windows));
    return Object.assign(new Gallery(), { clips: head.clips, embeddings, windows });
  }

  /** The `k` clips whose best window is nearest to a unit vector: [{ score, id, start_s, end_s }], best first. */
  search(query, k = 10) {
    const best = new Map();
    this.windows.forEach((window, row) => {
      const score = this.#dot(row, query);
      if (!(best.get(window.clip)?.score >= score)) best.set(window.clip, { score, ...window });
    });
    return [...best.values()]
      .sort((a, b) => b.score - a.score || a.clip - b.clip)
      .slice(0, k)
      .map(({ score, clip, start_s, end_s }) => ({ score, id: this.clips[clip].id, start_s, end_s }));
  }

  #dot(row, query) {
    const { columns, data } = this.embeddings;
    let sum = 0;
    for (let i = 0, at = row * columns; i < columns; i++, at++) sum += data[at] * query[i];
    return sum;
  }
}

/** Records of (clip: int32, start_s: float32, end_s: float32). */
async function readWindows(file) {
  const content = await readFile(file);
  const start = content[6] > 1 ? 12 : 10;
  const end = start + (content[6] > 1 ? content.readUInt32LE(8) : content.readUInt16LE(8));
  const header = content.toString("latin1", start, end);
  const fields = [...header.matchAll(/\('(\w+)', '(<[if]\d)'\)/g)].map(([, name, type]) => ({ name, type }));
  const size = fields.reduce((sum, { type }) => sum + Number(type[2]), 0);
  const read = { "<i4": "readInt32LE", "<i8": "readBigInt64LE", "<f4": "readFloatLE", "<f8": "readDoubleLE" };
  const windows = [];
  for (let at = end; at + size <= content.length; ) {
    const window = {};
    for (const { name, type } of fields) {
      window[name] = Number(content[read[type]](at));
      at += Number(type[2]);
    }
    windows.push(window);
  }
  return windows;
}
