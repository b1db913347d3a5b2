// A text in the plain words that the lexicon knows, its slips of the pen mended (motionrt.text.wording and spelling).
import data from "./data/words.json";
import { plain, replaced, type Table } from "./patterns";

const lex = data.lexicon as Record<string, any>;
const [LONG, MIDDLE] = [6, 5]; // letters of a word from which another letter is a slip, and one too few or too many
const SPELT = (lex.SPELT as string).split(" ");
const KEPT = new Set([...SPELT, ...(lex.RIGHT as string).split(" ")]);
const KNOWN = new Map<string, string[]>();
for (const word of SPELT) KNOWN.set(word[0], [...(KNOWN.get(word[0]) ?? []), word]);

/** Lower case, slips of the pen mended, other people's words replaced by plain ones. */
export function worded(text: string): string {
  let words = plain(text).replace(/[a-z]{3,}/g, right);
  for (const [pattern, instead] of lex.WORDING as Table) words = replaced(words, pattern, instead);
  return words.split(" ").filter(Boolean).join(" ");
}

/** What a network reads of a text: the text itself where all of its words are plain, else the plain words for it. */
export function networkText(text: string): string {
  const words = worded(text);
  return words === plain(text) ? text : words;
}

function right(word: string): string {
  if (KEPT.has(word)) return word;
  if (word === "teh") return "the";
  const swapped = word[1] === word[0] ? [] : KNOWN.get(word[1]) ?? [];
  return [...(KNOWN.get(word[0]) ?? []), ...swapped].find((known) => slipped(word, known)) ?? word;
}

/** Whether one slip makes a word of another one: a letter too few or too many, another one, two exchanged. */
function slipped(word: string, known: string): boolean {
  const longer = word.length - known.length;
  if (longer === 0) {
    const off = [...word].flatMap((letter, i) => (letter === known[i] ? [] : [i]));
    if (off.length === 1) return known.length >= LONG && off[0] > 0;
    return off.length === 2 && off[1] === off[0] + 1 && word[off[0]] === known[off[1]] && word[off[1]] === known[off[0]];
  }
  if (word[0] !== known[0]) return false;
  if (longer === -1) return known.length >= MIDDLE && places(known).some((k) => dropped(known, k) === word);
  if (longer !== 1) return false;
  const extra = places(word).filter((k) => dropped(word, k) === known);
  return extra.length > 0 && (known.length >= MIDDLE || extra.some((k) => word[k] === word[k - 1]));
}

const places = (word: string): number[] => Array.from({ length: word.length - 1 }, (_, i) => i + 1);
const dropped = (word: string, k: number): string => word.slice(0, k) + word.slice(k + 1);
