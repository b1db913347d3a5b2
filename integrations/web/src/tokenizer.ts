// BERT WordPiece as models/tokenizer.json describes it: lower case, accents stripped, [CLS] and [SEP] around.
import characters from "./data/characters.json";
import { LoadError } from "./errors";

export const MAX_TOKENS = 128; // [CLS] and [SEP] among them
const LONGEST_WORD = 100; // characters
const SPECIAL = ["[PAD]", "[UNK]", "[CLS]", "[SEP]", "[MASK]"];

const DROPPED = 1, SPACE = 2, ALONE = 3;

/** What becomes of every character, by its code. */
let kinds: Uint8Array | undefined;

function kindOf(letter: string): number {
  if (!kinds) {
    kinds = new Uint8Array(0x110000);
    for (const [kind, ranges] of [[DROPPED, characters.dropped], [SPACE, characters.space], [ALONE, characters.alone]] as const)
      for (const [first, count] of ranges) kinds.fill(kind, first, first + count);
  }
  return kinds[letter.codePointAt(0)!];
}

export class Tokenizer {
  private readonly vocabulary: Map<string, number>;

  /** `description`: what models/tokenizer.json holds. */
  constructor(description: unknown) {
    const vocabulary = (description as { model?: { type?: string; vocab?: Record<string, number> } })?.model?.vocab;
    if (!vocabulary || SPECIAL.some((word) => !(word in vocabulary)))
      throw new LoadError("the file of the tokenizer holds no WordPiece vocabulary: give tokenizer.json");
    this.vocabulary = new Map(Object.entries(vocabulary));
  }

  /** Ids with [CLS] and [SEP], no padding, cut at 128. */
  encode(text: string): number[] {
    const ids: number[] = [];
    for (const part of this.parted(text)) {
      if (SPECIAL.includes(part)) ids.push(this.vocabulary.get(part)!);
      else for (const word of words(normalised(part))) this.pieces(word, ids);
    }
    return [this.vocabulary.get("[CLS]")!, ...ids.slice(0, MAX_TOKENS - 2), this.vocabulary.get("[SEP]")!];
  }

  /** The text with names of special tokens apart: they are looked for before anything is changed. */
  private parted(text: string): string[] {
    return text.split(/(\[PAD\]|\[UNK\]|\[CLS\]|\[SEP\]|\[MASK\])/).filter((part) => part.length > 0);
  }

  private pieces(word: string, ids: number[]): void {
    const letters = [...word];
    const found: number[] = [];
    const unknown = this.vocabulary.get("[UNK]")!;
    if (letters.length > LONGEST_WORD) return void ids.push(unknown);
    for (let start = 0; start < letters.length; ) {
      let end = letters.length;
      let id: number | undefined;
      for (; end > start; end--) {
        id = this.vocabulary.get((start ? "##" : "") + letters.slice(start, end).join(""));
        if (id !== undefined) break;
      }
      if (id === undefined) return void ids.push(unknown);
      found.push(id);
      start = end;
    }
    ids.push(...found);
  }
}

/** Lower case without accents and control characters; white space as spaces. */
function normalised(text: string): string {
  let clean = "";
  for (const letter of text) {
    const kind = kindOf(letter);
    if (kind !== DROPPED) clean += kind === SPACE ? " " : letter;
  }
  let lower = "";
  for (const letter of clean.normalize("NFD")) if (kindOf(letter) !== DROPPED) lower += letter.toLowerCase(); // one by one: no rule looks at neighbours
  return lower;
}

function words(text: string): string[] {
  const found: string[] = [];
  for (const piece of text.split(" ")) {
    let word = "";
    for (const letter of piece) {
      if (kindOf(letter) !== ALONE) word += letter;
      else {
        if (word) found.push(word);
        found.push(letter);
        word = "";
      }
    }
    if (word) found.push(word);
  }
  return found;
}
