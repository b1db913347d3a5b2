// node retrieve.mjs "a person walks and turns left" [--gallery FOLDER] [-k 5] [--json]
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
    k: { type: "string", short: "k", default: "5" },
    json: { type: "boolean", default: false },
  },
});
const encoder = await TextEncoder.open(join(values.models, "tmr_text.int8.onnx"), join(values.models, "tokenizer.json"));
const embedding = await encoder.embed(positionals.join(" "));
const hits = (await Gallery.open(values.gallery)).search(embedding, Number(values.k));
if (values.json) console.log(JSON.stringify({ tokens: encoder.tokens(positionals.join(" ")), embedding: [...embedding], hits }));
else hits.forEach(({ score, id, start_s, end_s }) => console.log(`${score.toFixed(3)}  ${id}  ${start_s.toFixed(1)}-${end_s.toFixed(1)} s`));
