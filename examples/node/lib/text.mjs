// Text -> unit vector: WordPiece ids into tmr_text, whose graph holds the sentence encoder and TMR's head.
import { readFile } from "node:fs/promises";
import { Tokenizer } from "@huggingface/tokenizers";
import { InferenceSession, Tensor } from "onnxruntime-node";

const MAX_TOKENS = 128; // [CLS] and [SEP] among them

export class TextEncoder {
  static async open(model, tokenizer) {
    const session = await InferenceSession.create(model, { intraOpNumThreads: 1 });
    const words = new Tokenizer(JSON.parse(await readFile(tokenizer, "utf8")), {});
    return Object.assign(new TextEncoder(), { session, words });
  }

  /** Ids with [CLS] and [SEP], no padding. */
  tokens(text) {
    const { ids } = this.words.encode(text);
    return ids.length > MAX_TOKENS ? [...ids.slice(0, MAX_TOKENS - 1), ids[ids.length - 1]] : ids;
  }

  /** 256 numbers of length 1. */
  async embed(text) {
    if (!text.trim()) throw new Error("the text is empty");
    const ids = BigInt64Array.from(this.tokens(text), BigInt);
    const shape = [1, ids.length];
    const feeds = {
      input_ids: new Tensor("int64", ids, shape),
      embed: new Tensor("bool", [true], []),
      attention_mask: new Tensor("int64", BigInt64Array.from(ids, () => 1n), shape),
    };
    const { embedding } = await this.session.run(feeds, ["embedding"]);
    return embedding.data;
  }
}
