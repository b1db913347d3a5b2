// node retrieve.mjs "a person walks and turns left" [--gallery FOLDER] [-k 5] [--tower tmr_student] [--json]
import { join } from "node:path";
import { parseArgs } from "node:util";
import { Gallery } from "./lib/gallery.mjs";
import { TextEncoder } from "./lib/text.mjs";

const ROOT = join(import.meta.dirname, "..", "..");
const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: {
    gallery: { type: "string", default: join(ROOT, "runtime/motionrt/_assets/starter") },
    models: { type: "string", default: join(ROOT, "models") },
    tower: { type: "string", default: "tmr_text" },
    k: { type: "string", short: "k", default: "5" },
    json: { type: "boolean", default: false },
  },
});
const tower = join(values.models, `${values.tower}.int8.onnx`);
const encoder = await TextEncoder.open(tower, join(values.models, "tokenizer.json"));
const embedding = await encoder.embed(positionals.join(" "));
const hits = (await Gallery.open(values.gallery)).search(embedding, Number(values.k));
if (values.json) console.log(JSON.stringify({ tokens: encoder.tokens(positionals.join(" ")), embedding: [...embedding], hits }));
else hits.forEach(({ score, id, start_s, end_s }) => console.log(`${score.toFixed(3)}  ${id}  ${start_s.toFixed(1)}-${end_s.toFixed(1)} s`));
