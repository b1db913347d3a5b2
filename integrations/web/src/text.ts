import { checkedText } from "./errors";
import { numbers, type Sessions, type Tensors } from "./sessions";
import type { Tokenizer } from "./tokenizer";

/** What the sentence encoder says of a text: T x 384, one row a token. */
export interface TokenFeatures {
  tokens: number;
  features: Float32Array;
}

/** Texts to unit vectors in the space of motions, and to token features. */
export class TextEncoder {
  constructor(private readonly sessions: Sessions, private readonly tokenizer: () => Promise<Tokenizer>, private readonly tower = "tmr_text") {}

  /** Ids with [CLS] and [SEP], no padding. */
  async tokens(text: string): Promise<number[]> {
    return (await this.tokenizer()).encode(checkedText(text));
  }

  /** 256 numbers of length 1. */
  async embed(text: string): Promise<Float32Array> {
    return numbers((await this.run(this.tower, text, true, "embedding")).out).slice();
  }

  async features(text: string): Promise<TokenFeatures> {
    const { out, tokens } = await this.run("tmr_text", text, false, "token_features");
    return { tokens, features: numbers(out) };
  }

  private async run(model: string, text: string, embed: boolean, output: string): Promise<{ out: Tensors[string]; tokens: number }> {
    const ids = await this.tokens(text);
    const feeds: Tensors = { input_ids: this.sessions.whole(ids, [1, ids.length]), attention_mask: this.sessions.whole(ids.map(() => 1), [1, ids.length]) };
    if ((await this.sessions.session(model)).inputNames.includes("embed")) feeds.embed = this.sessions.flags([embed], []);
    return { out: (await this.sessions.run(model, feeds, [output]))[output], tokens: ids.length };
  }
}
