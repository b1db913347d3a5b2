// The acts of a text that follow one another, each in words that stand alone (motionrt.text.clauses).
import data from "./data/words.json";
import { has, matches, parted, replaced } from "./patterns";
import { worded } from "./wording";
import { parseQuery } from "./words";

const lex = data.lexicon as Record<string, any>;
const LOW = ["sitting", "kneeling", "lying", "crouching", "crawling"];

/** The acts of a text in the order in which they happen; the text itself where there is one, or all are at once. */
export function clausesOf(text: string): string[] {
  const whole = worded(text);
  let parts = split(whole, lex.THEN).flatMap(ordered);
  const listed = parts.length > 1 || has(whole, lex.LIST);
  parts = merged(parts.flatMap((part) => both(part, listed)).map(bare));
  return parts.length < 2 ? [text] : continued(parts);
}

const trimmed = (words: string): string => words.replace(/^[ ,.]+|[ ,.]+$/g, "");
const split = (words: string, pattern: string): string[] => parted(words, pattern).map(trimmed).filter(Boolean);
const bare = (words: string): string => replaced(trimmed(words), lex.LEADS, "").trim();

/** The two acts of "this before that" and "this after that", the earlier one first. */
function ordered(words: string): string[] {
  for (const [pattern, firstIsBehind] of [[lex.BEFORE, false], [lex.AFTER, true]] as [string, boolean][]) {
    const [found] = matches(words, pattern);
    if (!found) continue;
    let [ahead, behind] = [trimmed(words.slice(0, found.start)), trimmed(words.slice(found.end))];
    if (!ahead) {
      const [subject] = matches(behind, lex.NEW_SUBJECT);
      if (!subject) return [words];
      [ahead, behind] = [trimmed(behind.slice(subject.end)), trimmed(behind.slice(0, subject.start))];
    }
    if (acts(ahead) && acts(behind)) return firstIsBehind ? [behind, ahead] : [ahead, behind];
  }
  return [words];
}

/** The acts of "this and that" where somebody cannot do both at once, and of a list of them. */
function both(words: string, listed: boolean): string[] {
  for (const { start, end, text } of matches(words, lex.AND)) {
    const [ahead, behind] = [words.slice(0, start), bare(words.slice(end))];
    if (has(behind, lex.JOINS)) continue;
    const [goes, on] = [has(ahead, lex.GOES), goesOn(behind)];
    const [stopped, stops] = [has(ahead, `\\b${lex.STOPS}`), has(behind, `^(?:\\w+ly )?${lex.STOPS}`)];
    const low = LOW.includes(parseQuery(ahead).posture_end) && LOW.includes(parseQuery(behind).posture_lowest);
    const follows = (stopped && on && !goes) || (goes && stops && !stopped);
    const named = listed && text.includes(",") && has(behind, lex.VERB) && acts(ahead) && acts(behind);
    if (!low && (follows || named)) return [ahead, ...both(behind, listed)];
  }
  return [words];
}

const goesOn = (words: string): boolean => has(words, `^(?:\\w+ly )?(?:${lex.GOES}|carr)`) && !["none", null].includes(parseQuery(words).travel ?? null);

function acts(words: string): boolean {
  const said = parseQuery(words);
  return Boolean(said.action || said.turn || said.travel || said.posture_lowest || said.level || said.arms_up);
}

/** Parts without an act belong to the one before; a part without a verb has that of the one before. */
function merged(parts: string[]): string[] {
  const found: string[] = [];
  for (const part of parts) {
    const before = found[found.length - 1];
    if (found.length && has(part, "^with\\b|^(?:the )?(?:left|right)\\b")) found.push(`${before.split(" with ")[0].split(" the ")[0]} ${part}`);
    else if (found.length && !acts(part)) found[found.length - 1] = `${before}, ${part}`;
    else found.push(part);
  }
  return found.length > 1 && !acts(found[0]) ? [`${found[0]}, ${found[1]}`, ...found.slice(2)] : found;
}

/** The clauses, told what those before them have left: a posture, and a turn after which the way back is forward. */
function continued(parts: string[]): string[] {
  let low: string | null = null;
  let turned = false;
  return parts.map((given) => {
    const said = parseQuery(given);
    const goes = has(given, lex.GOES) && (said.posture_lowest ?? null) === null;
    let part = turned && goes && !has(given, lex.BACKWARD) ? replaced(given, "\\bback\\b", "forward") : given;
    if (low && said.level === "up") part = ["lying", "kneeling", "crawling"].includes(low) && !part.includes("from") ? `${part} from the floor` : part;
    else if (low && goes) part = `stands up and ${part}`;
    else if (low && (said.posture_lowest ?? null) === null) part = `${part} while ${low}`;
    turned ||= said.turn === "around";
    const end: string | null = said.posture_lowest || said.level ? said.posture_end ?? null : low;
    low = end !== null && LOW.includes(end) && !goes ? end : null;
    return part;
  });
}
