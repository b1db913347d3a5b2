// The lexicon's patterns in JavaScript, and small ways of asking them (motionrt.text.patterns).
export type Table = [string, string][];

const LONGEST = 1000; // characters of a text that are read

const [ASCII, ANY] = [new Map<string, RegExp>(), new Map<string, RegExp>()];

/** A Python pattern as JavaScript's, whose \w and \b know ASCII alone otherwise; that is quicker where it is enough. */
function compiled(pattern: string, text: string): RegExp {
  const plain = /^[\x00-\x7f]*$/.test(text);
  const known = plain ? ASCII : ANY;
  let found = known.get(pattern);
  if (!found) {
    const word = "[\\p{L}\\p{N}_]";
    const wider: Record<string, string> = { w: word, b: `(?:(?<=${word})(?!${word})|(?<!${word})(?=${word}))`, d: "\\p{Nd}" };
    const source = pattern.replace(/\(\?P</g, "(?<");
    found = plain ? new RegExp(source, "g") : new RegExp(source.replace(/\\([wbd])/g, (_, kind: string) => wider[kind]), "gu");
    known.set(pattern, found);
  }
  found.lastIndex = 0;
  return found;
}

export interface Found {
  start: number;
  end: number;
  text: string;
  groups: Record<string, string | undefined>;
}

/** Every place where a text holds a pattern. */
export function matches(text: string, pattern: string): Found[] {
  return [...text.matchAll(compiled(pattern, text))].map((match) => ({
    start: match.index,
    end: match.index + match[0].length,
    text: match[0],
    groups: match.groups ?? {},
  }));
}

/** Whether a text holds a pattern. */
export function has(text: string, pattern: string): boolean {
  return compiled(pattern, text).test(text);
}

/** The text with a mark in place of what matches. */
export const without = (text: string, patterns: string[]): string => patterns.reduce((rest, pattern) => rest.replace(compiled(pattern, rest), "_"), text);
/** The text with other words in place of what matches; `$1` stands for what the first brackets hold. */
export const replaced = (text: string, pattern: string, instead: string): string => text.replace(compiled(pattern, text), instead);
/** What lies between the matches. */
export const parted = (text: string, pattern: string): string[] => {
  const found = matches(text, pattern);
  return [...found, { start: text.length }].map(({ start }, i) => text.slice(i ? found[i - 1].end : 0, start));
};
/** The name of the first pattern of a table that the text holds. */
export const first = (text: string, table: Table): string | null => table.find(([, pattern]) => has(text, pattern))?.[0] ?? null;
/** The sides that are named in places where the patterns look. */
export const sides = (text: string, patterns: string[]): Set<string> =>
  new Set(patterns.flatMap((pattern) => matches(text, pattern).map((match) => match.groups.side!)));
/** The one element of a set, or null. */
export const only = (found: Set<string>): string | null => (found.size === 1 ? [...found][0] : null);

/** Lower case, without accents, hyphens and doubled spaces. */
export function plain(text: string): string {
  const letters = [...text].slice(0, LONGEST).join("").normalize("NFKD").toLowerCase().replaceAll("\u2019", "'");
  return letters
    .replace(/\p{M}/gu, (mark) => (/\p{Mc}/u.test(mark) ? mark : ""))
    .replace(/[-_/\u2010-\u2015]+/g, " ")
    .split(/[\s\x1c-\x1f\x85]+/u)
    .filter(Boolean)
    .join(" ");
}
