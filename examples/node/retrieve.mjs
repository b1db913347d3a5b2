// Clips that a text describes: node retrieve.mjs "a person walks and turns left"
import { command, number, open } from "./command.mjs";

const options = {
  k: { type: "string", short: "k", default: "5", help: "how many" },
  gallery: { type: "string", default: "starter", help: "which gallery of the folder" },
};
await command('retrieve.mjs "TEXT" [options]', options, async ({ values, positionals }) => {
  const rt = await open(values.site);
  const text = positionals.join(" ");
  const embedding = await rt.text.embed(text);
  const hits = (await rt.gallery(values.gallery)).search(embedding, number(values.k, "k"));
  if (values.json) console.log(JSON.stringify({ tokens: await rt.text.tokens(text), embedding: [...embedding], hits }));
  else hits.forEach(({ score, id, start_s, end_s }) => console.log(`${score.toFixed(3)}  ${id}  ${start_s.toFixed(1)}-${end_s.toFixed(1)} s`));
});
