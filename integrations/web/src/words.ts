// What a text says about a motion: motionrt's parser, with the patterns of its lexicon (data/words.json).
import data from "./data/words.json";
import { first, type Found, has, matches, only, sides, type Table, without } from "./patterns";
import { worded } from "./wording";

export type Said = Record<string, any>;

const lex = data.lexicon as Record<string, any>;
const OTHER: Record<string, string> = { left: "right", right: "left" };
const SEVERAL = -1;

/** What `text` says: attributes by name, undefined or null where it says nothing. */
export function parseQuery(text: string): Said {
  const whole = worded(text);
  const said: Said = {};
  for (const [pattern, meaning] of lex.NEGATED_MEANING as [string, Said][]) if (has(whole, pattern)) Object.assign(said, meaning);
  const words = without(without(whole, [lex.NEGATION]), lex.NO_SIDES);
  const actions = Object.keys(lex.ACTIONS).filter((name) => has(words, lex.ACTIONS[name]));
  const found: Said = { text, action: actions[0] ?? null };
  found.actions = actions
    .map((name) => ({ name, place: matches(words, lex.ACTIONS[name])[0]?.start ?? words.length }))
    .sort((a, b) => a.place - b.place)
    .map(({ name }) => name);
  for (const part of [turnOf, pathOf, travelOf, speedOf, armsOf, handsOf, feetOf, posturesOf, jumpsOf, repeatsOf])
    Object.assign(found, part(words, found));
  Object.assign(found, movesOf(found), said);
  if (said.still || found.speed === "still") {
    Object.assign(found, { still: true, travel: "none", steps: "none", speed: "still", legs_move: 1 });
    found.arms_move = found.arms_move || (found.arm ? null : 1);
  }
  return found;
}

function turnOf(words: string, _found: Said): Said {
  const text = without(words, [lex.NOT_PATHS]);
  const side = turnSide(text);
  let kind = first(text, lex.TURNS);
  if (kind === null && has(text, lex.NO_TURN) && side === null) return { turn: "none", turn_side: null };
  if (kind === null && side && has(text, lex.TURN_VERBS)) kind = "turn";
  if (matches(text, lex.TURN_WORDS).length > 1 && has(text, lex.SEVERAL_PARTS)) kind = null;
  return { turn: kind, turn_side: side };
}

function turnSide(text: string): string | null {
  const clock = new Set((lex.CLOCKWISE as Table).filter(([pattern]) => has(text, pattern)).map(([, side]) => side));
  if (clock.size) return only(clock);
  return has(text, lex.BOTH_SIDES) ? null : only(sides(text, lex.TURN_SIDE));
}

function pathOf(words: string, found: Said): Said {
  const text = without(words, [lex.NOT_PATHS]);
  const side = found.turn_side;
  const goes = has(text, lex.GOES);
  const course = first(text, lex.COURSES);
  if (course) return { course, turn: null, turn_side: null };
  if (has(text, lex.SPINS) && found.turn !== "around") return { path: "spin", path_side: side, turn: found.turn === "full" ? "full" : null };
  if (has(text, lex.CIRCLES) && found.turn !== "around")
    return { path: found.turn === "full" && !goes ? "spin" : "circle", path_side: side, turn: null };
  if (has(text, lex.CURVES)) return { path: "curve", path_side: side, turn: found.turn === "around" ? "around" : null };
  if (found.turn === "full") return { path: "spin", path_side: side, turn: "full" };
  return has(text, lex.NO_TURN) && side === null && (found.turn === null || found.turn === "none") ? { path: "straight" } : {};
}

function travelOf(words: string, found: Said): Said {
  if (has(words, lex.STEPS_IN_PLACE)) return { travel: "none", steps: "in place" };
  const kinds = (lex.TRAVELS as Table).filter(([, pattern]) => has(words, pattern)).map(([name]) => name);
  const goes = has(words, lex.GOES);
  if (kinds.length > 1 || (goes && kinds.includes("none"))) return goes ? { steps: "along" } : {};
  if (!kinds.length || kinds[0] === "forward") return onward(words, found, goes, kinds.length > 0);
  if (kinds[0] === "side") return aside(words, goes);
  return kinds[0] === "backward" ? back(words, found) : { travel: "none" };
}

function onward(words: string, found: Said, goes: boolean, ahead: boolean): Said {
  const to = has(words, lex.BOTH_SIDES) ? null : only(sides(words, [lex.SIDEWAYS_TO, lex.WARD]));
  if (!ahead && to && found.turn === null && (found.path ?? null) === null) return goes ? { steps: "along", turn_side: to } : { travel: to };
  if (goes && found.path !== "spin") return { travel: "forward", steps: "along" };
  if (ahead && has(words, lex.MOVES_ON)) return { travel: "forward" };
  const quiet = lex.IN_PLACE_ACTIONS.includes(found.action) && !has(words, lex.STEPS_OR_TURNS);
  return quiet && !has(words, lex.SEVERAL_CLAUSES) ? { travel: "none" } : {};
}

function back(words: string, found: Said): Said {
  const returns = found.turn !== null || matches(words, lex.GOES).length > 1;
  return returns && !has(words, lex.BACKWARD) ? { steps: "along" } : { travel: "backward", steps: "along" };
}

function aside(words: string, goes: boolean): Said {
  if (goes && has(words, lex.SEVERAL_PARTS)) return { steps: "along" };
  const named = has(words, lex.BOTH_SIDES) ? new Set<string>() : sides(words, [lex.ANY_SIDE]);
  return { travel: only(named) ?? "sideways", steps: "along", turn_side: null };
}

const QUIET = ["stand", "sit", "lie", "kneel", "squat", "imitate"];
const ODD_PACES = ["walk fast", "run slow", "jog slow", "slow fast"];

function speedOf(words: string, found: Said): Said {
  const speed = first(words, lex.SPEEDS);
  const pace = first(words, lex.PACES);
  const clauses = has(words, lex.SEVERAL_CLAUSES);
  let mixed = found.actions.some((name: string) => !lex.ALONE_WITH.includes(name)) || clauses;
  if (speed === "still") mixed = found.actions.some((name: string) => !QUIET.includes(name)) || has(words, lex.GOES) || clauses;
  else if (found.travel === "none" || found.turn === "turn" || found.turn === "around") mixed = true;
  return { speed: mixed || ODD_PACES.includes(`${speed} ${pace}`) ? null : speed, pace };
}

function armsOf(words: string): Said {
  const patterns = !has(words, lex.LEG_ACTS) || has(words, lex.ARM_ACTS) ? lex.ARM_SIDE : lex.ARM_SIDE.slice(0, 1);
  const named = sides(words, patterns);
  let arm: string | null = only(named) ?? (named.size || has(words, lex.BOTH_ARMS) ? "both" : null);
  let up = first(words, lex.ARMS_UP);
  if (up === "both" && only(named) && !has(words, lex.PAIR)) up = "one";
  if (up === "one") {
    if (!named.size && has(words, lex.PAIR_WAVES)) return { arm: "both", arms_up: "both" };
    up = arm !== null && arm in OTHER ? arm : named.size === 2 ? "both" : "one";
    arm = named.size ? arm : null;
  }
  return { arm, arms_up: up };
}

function handsOf(words: string): Said {
  const said: [string, string][] = [["hands_low", lex.HANDS_LOW], ["hands_together", `${lex.TOGETHER}|${lex.CLAPS}`], ["lean", lex.LEANS]];
  return Object.fromEntries(said.filter(([, pattern]) => has(words, pattern)).map(([name]) => [name, true]));
}

function feetOf(words: string): Said {
  const support = only(sides(words, [lex.SUPPORT]));
  const named = sides(words, lex.LEG_SIDE);
  const leg = only(named) ?? (named.size ? "both" : null);
  if (support && !has(words, `kick|(?:lift|rais)\\w* (?:the |his |her )?${OTHER[support]}`))
    return { leg: null, foot_lift: words.includes("kneel") ? null : OTHER[support] };
  if (!has(words, lex.FOOT_LIFT)) return { leg };
  if (leg !== null && leg in OTHER) return { leg, foot_lift: leg };
  return { leg, foot_lift: leg === "both" || has(words, lex.HIGH_BOTH) ? "both" : "one" };
}

type Event = [number, string];
const UPRIGHT = ["walk", "run", "jog", "march", "wave", "turn", "clap", "kick", "punch", "throw"];

function posturesOf(given: string, found: Said): Said {
  const words = without(given, lex.NOT_POSTURES);
  const events = eventsOf(words);
  const low = events.map(([, name]) => name).filter((name) => name !== "rise" && name !== "standing");
  if (!low.length) return upright(events, found);
  const deepest = low.reduce((a, b) => (data.postures.indexOf(b) > data.postures.indexOf(a) ? b : a));
  if (low.every((name) => lex.DIP_POSTURES.includes(name) || name === "upside down")) return dip(words, deepest, events);
  const [start, end] = [startOf(words, events), endOf(words, events)];
  return { posture_start: start, posture_end: end, posture_lowest: deepest, level: levelOf(start, end) };
}

function eventsOf(words: string): Event[] {
  const found: Event[] = [];
  const rises = matches(words, lex.RISES);
  for (const [name, pattern] of lex.POSTURE_STATES as Table)
    for (const match of matches(words, pattern)) {
      const place = match.start;
      if (name === "standing" && rises.some(({ start, end }) => start <= place && place < end)) continue;
      const risen = rises.find(({ end }) => end <= place && place <= end + 30 && has(sliced(words, end - 5, place + 5), lex.FROM));
      found.push([risen ? risen.start - 1 : place, name]);
    }
  found.push(...rises.map(({ start }): Event => [start, "rise"]));
  return found.sort((a, b) => a[0] - b[0] || (a[1] < b[1] ? -1 : a[1] > b[1] ? 1 : 0));
}

/** As Python slices: a start below 0 counts from the end. */
const sliced = (text: string, start: number, end: number): string => text.slice(start, end);

function upright(events: Event[], found: Said): Said {
  const names = events.map(([, name]) => name);
  if (names.includes("rise")) return { posture_end: "standing", level: "up" };
  if (names.includes("standing") || UPRIGHT.includes(found.action)) return { posture_start: "standing", posture_end: "standing", level: "level" };
  return {};
}

function dip(words: string, deepest: string, events: Event[]): Said {
  const ends: Said = events[events.length - 1][1] === "rise" ? { posture_end: "standing" } : {};
  if (deepest === "bent") return ends;
  if (has(words, lex.CROUCHED) && !has(words, lex.SEVERAL_CLAUSES))
    return { posture_start: deepest, posture_end: deepest, posture_lowest: deepest };
  if (has(words, lex.STAY_WORDS)) return { posture_end: deepest, posture_lowest: deepest };
  const down: Said = deepest === "crouching" && !has(words, lex.SEVERAL_CLAUSES) ? { level: "down and up" } : {};
  return { posture_lowest: deepest, ...down, ...ends };
}

const walks = (words: string): Found[] => matches(words, lex.GOES).filter(({ text }) => !text.startsWith("crawl"));

function startOf(words: string, events: Event[]): string | null {
  const [place, name] = events[0];
  if (name === "rise") return null;
  if (name === "standing" || walks(words).some(({ start }) => start < place)) return "standing";
  if (matches(words, lex.DOWN_WORDS).some(({ start, end }) => start <= place && place < end)) return "standing";
  return lex.DIP_POSTURES.includes(name) ? null : name;
}

function endOf(words: string, events: Event[]): string | null {
  const [place, name] = events[events.length - 1];
  if (name === "rise" || name === "standing" || walks(words).some(({ start }) => start > place)) return "standing";
  return lex.DIP_POSTURES.includes(name) || name === "upside down" ? null : name;
}

function levelOf(start: string | null, end: string | null): string | null {
  if (end === "standing") return start === "standing" ? "down and up" : "up";
  if (start === "standing") return end ? "down" : null;
  return start && start === end ? "level" : null;
}

function jumpsOf(words: string, found: Said): Said {
  if (!has(words, lex.JUMPS)) return lex.NO_JUMP_ACTIONS.includes(found.action) ? { jumps: 0 } : {};
  const count = countOf(words);
  if (count !== null) return { jumps: count };
  return { jumps: has(words, lex.MANY) || has(words, lex.MANY_JUMPS) ? SEVERAL : 1 };
}

function repeatsOf(words: string): Said {
  const repeats = countOf(words) ?? (has(words, lex.MANY) ? SEVERAL : null);
  return { repeats, ...(has(words, lex.CLAPS) ? { claps: repeats || SEVERAL } : {}) };
}

function countOf(words: string): number | null {
  const match = matches(words, lex.TIMES)[0];
  if (!match) return null;
  const word = match.groups.w || match.groups.n!;
  return lex.NUMBERS[word] ?? parseInt(word, 10);
}

function movesOf(found: Said): Said {
  const [arms, legs, torso] = lex.MOVES[found.action ?? ""] ?? [0, 0, 0];
  const moves: Said = { arms_move: arms || null, legs_move: legs || null, torso_move: torso || null };
  if (found.steps === "along" && (moves.legs_move ?? 0) < 3) moves.legs_move = null;
  return moves;
}

const LEVELS = (data.classes as Record<string, string[]>).arms_move;

/** Classes of what a text says, in the order of the generator's input `slots`; 0 is unknown. */
export function slotsOf(s: Said): number[] {
  const named: Record<string, string | null | undefined> = {
    ...s,
    turn: turnSaid(s),
    path: s.path ? [s.path, s.path_side].filter(Boolean).join(" ") : null,
    jumps: s.jumps === undefined || s.jumps === null ? null : s.jumps === 0 ? "none" : s.jumps === 1 ? "once" : "several",
  };
  for (const name of ["arms_move", "legs_move", "torso_move"]) named[name] = s[name] ? LEVELS[s[name] - 1] : null;
  for (const name of ["hands_low", "hands_together", "lean"]) named[name] = s[name] ? "yes" : null;
  return data.slots.map((slot) => (named[slot] ? (data.classes as Record<string, string[]>)[slot].indexOf(named[slot]!) + 1 : 0));
}

function turnSaid(s: Said): string | null {
  if (!s.turn || s.turn === "none") return s.turn ?? null;
  if (s.turn === "full") return s.turn_side ? `full ${s.turn_side}` : null;
  if (s.turn === "around") return s.turn_side ? `around ${s.turn_side}` : "around";
  return s.turn_side ?? "turn";
}

const TURNS: Record<string, number> = { turn: 80, around: 178, full: 360 }; // degrees
const BENDS: Record<string, number> = { curve: 108, circle: 290 };
const SPEEDS: Record<string, number> = { still: 0.05, slow: 0.45, walk: 1, jog: 2, run: 3 }; // m/s
const LEFT: Record<string, number> = { left: 1, right: -1 };

/** The numbers that a text stands for in a motion of so many seconds, and which of them it says at all. */
export function targetsOf(s: Said, seconds: number): { numbers: Float32Array; known: boolean[] } {
  const found: Record<string, number> = {};
  if (s.turn === "none" || s.path === "straight") found.turn = 0;
  else if (s.turn) {
    found.spin_extent = TURNS[s.turn];
    if (s.turn_side in LEFT) found.turn = LEFT[s.turn_side] * TURNS[s.turn];
  }
  if (s.path === "straight") found.path_bend = 0;
  else if (s.path in BENDS && s.path_side in LEFT) found.path_bend = LEFT[s.path_side] * BENDS[s.path];
  else if (s.path === "spin") found.spin_extent = 380;
  const pace = SPEEDS[s.speed];
  if (pace !== undefined) found.speed_mean = pace;
  if (s.travel === "forward" && !s.path && (!s.turn || s.turn === "none")) found.walk_forward = (pace || 0.6) * seconds;
  else if (s.travel === "backward") found.walk_forward = -0.55 * seconds;
  else if (s.travel in LEFT) Object.assign(found, { walk_forward: 0, walk_left: LEFT[s.travel] * 0.42 * seconds });
  else if (s.travel === "none") Object.assign(found, { walk_forward: 0, walk_left: 0 });
  const scales = data.scales as Record<string, number>;
  return {
    numbers: Float32Array.from(data.targets, (name) => Math.tanh((found[name] ?? 0) / scales[name])),
    known: data.targets.map((name) => name in found),
  };
}
