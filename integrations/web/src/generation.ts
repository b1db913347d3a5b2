// Text to motion by diffusion in motion space (motionrt.synthesis): the solver, the canvas, and the motion of it.
import { type Held, over, type Piece } from "./canvas";
import { clausesOf } from "./clauses";
import data from "./data/words.json";
import { checkedNumber, InvalidInputError } from "./errors";
import { between, decode, FPS, smoothed, WIDTH } from "./ego77";
import { lockFeet } from "./feet";
import { standing } from "./gestures";
import { uprightGround } from "./ground";
import { withHeads } from "./heads";
import { Motion } from "./motion";
import { fromPositions } from "./positions";
import { Random } from "./random";
import { numbers, type Sessions } from "./sessions";
import { JOINTS, PARTS } from "./skeleton";
import { stepWhereSliding } from "./sliding";
import { kept, planned, steered } from "./steering";
import type { TextEncoder, TokenFeatures } from "./text";
import { networkText } from "./wording";
import { parseQuery, slotsOf, targetsOf } from "./words";

const READ = 24; // tokens of a text that the network has learnt to read
const [HIGHEST, LOWEST, BEND] = [60, 0.15, 7]; // noise levels (Karras et al. 2022, eq. 5)
const [POSE_GUIDANCE, TURN_GUIDANCE] = [5, 1.3];
const [LATE, GUIDED] = [2.5, 2]; // noise levels below which the way is corrected, and down to which texts are guided
const SHORTEST_ACT_S = 1; // of acts of a text that follow one another; with less time they are one
const [NETWORK, OVERLAP] = [200, 5]; // frames at 20 fps: that the network sees, over which texts pass into each other
const SWINGS_FROM = 0.4; // m/s: a generated foot that swings drags more than a recorded one

export interface Sampling {
  /** Seconds, 0.5 to 10. */
  seconds?: number;
  /** The same seed gives the same motion as in Python. */
  seed?: number;
  /** Which of several samples of a seed. */
  sample?: number;
  steps?: number;
  guidance?: number;
  temperature?: number;
  footLock?: boolean;
  /** Standard normal numbers (frames at 20 fps x 77) instead of those of the seed. */
  noise?: Float32Array;
  /** Token features of the only text, where another encoder has made them. */
  features?: TokenFeatures;
  /** Called after every step with the share that is done. */
  onStep?: (share: number) => void;
}

/** A text of a timeline, whose time begins where the one before ends. */
export interface Line {
  text: string;
  seconds: number;
}

/** The acts of a text that follow one another, each with its share of the time; one line where there is one. */
function actsOf(text: string, seconds: number, whole: boolean): Line[] {
  const acts = whole ? [text] : clausesOf(text);
  const share = seconds / acts.length;
  if (acts.length < 2 || share < SHORTEST_ACT_S) return [{ text, seconds }];
  const times = [...acts.map((_, k) => rounded(10 * share * k) / 10), seconds];
  return acts.map((act, k) => ({ text: act, seconds: times[k + 1] - times[k] }));
}

/** Falling noise levels of so many steps. */
export function noiseLevels(steps: number): number[] {
  const [high, low] = [HIGHEST ** (1 / BEND), LOWEST ** (1 / BEND)];
  return Array.from({ length: steps }, (_, k) => (high + (steps > 1 ? k / (steps - 1) : 0) * (low - high)) ** BEND);
}

/** Draws motions of texts. */
export class Generator {
  constructor(private readonly sessions: Sessions, private readonly text: TextEncoder) {}

  /** A motion of a text, or of several one after another: 30 fps, from above the origin, facing +Z, feet on the floor. */
  async generate(what: string | Line[], sampling: Sampling = {}): Promise<Motion> {
    const single = typeof what === "string";
    const lines = single ? actsOf(what, checkedNumber(sampling.seconds ?? 4, "seconds", 0.5, 10), Boolean(sampling.features)) : what;
    if (!lines.length) throw new InvalidInputError("a timeline needs at least one text");
    if (!single) for (const line of lines) checkedNumber(line.seconds, "seconds of a line", 0.5, 9.5);
    const times = timesOf(lines);
    const { pieces, frames } = await this.pieces(lines, times, sampling.features);
    const rows = await this.draw(pieces, frames, sampling);
    const wanted = rounded(30 * times[times.length - 1].to);
    const motion = asMotion(rows, wanted);
    const drawn = motion.slice(0, Math.min(motion.frames, wanted));
    const finished = uprightGround(withHeads(drawn, lines.map(({ text }, i) => ({ text, ...times[i] }))).canonical().grounded());
    return sampling.footLock ?? true ? lockFeet(stepWhereSliding(finished), SWINGS_FROM) : finished;
  }

  private async pieces(lines: Line[], times: Time[], given?: TokenFeatures): Promise<{ pieces: Piece[]; frames: number }> {
    const all = rounded(times[times.length - 1].to * FPS) + 1;
    const frames = lines.length === 1 ? Math.min(all, NETWORK) : all;
    const spans = times.map(({ from, to }) => spanOf(from, to, frames));
    const weights = spans.map(([first, last]) => rampOf(first, last, frames));
    const total = new Float32Array(frames);
    weights.forEach((weight, i) => weight.forEach((value, f) => (total[spans[i][0] + f] += value)));
    const pieces: Piece[] = [];
    for (const [i, line] of lines.entries()) {
      const said = standing(parseQuery(line.text));
      const { tokens, features } = given ?? (await this.text.features(networkText(line.text)));
      const read = Math.min(tokens, READ);
      const words = { features: { tokens: read, features: features.slice(0, read * 384) }, slots: slotsOf(said), ...targetsOf(said, line.seconds), said };
      pieces.push({ words, first: spans[i][0], weight: weights[i].map((value, f) => value / total[spans[i][0] + f]) });
    }
    return { pieces, frames };
  }

  /** Raw `ego77` of a canvas. */
  private async draw(pieces: Piece[], frames: number, sampling: Sampling): Promise<Float32Array> {
    const steps = checkedNumber(sampling.steps ?? 12, "steps", 1, 1000);
    const weight = checkedNumber(sampling.guidance ?? POSE_GUIDANCE, "guidance", 0, 100);
    const guidance = Float32Array.of(1 + ((weight - 1) * (TURN_GUIDANCE - 1)) / (POSE_GUIDANCE - 1), weight);
    const temperature = Math.fround(checkedNumber(sampling.temperature ?? 1, "temperature", 0, 10));
    const noise = sampling.noise ?? new Random(sampling.seed ?? 0, sampling.sample ?? 0).normals(frames * WIDTH);
    if (noise.length !== frames * WIDTH) throw new InvalidInputError(`the noise must be ${frames} x ${WIDTH} numbers, not ${noise.length}`);
    const levels = noiseLevels(steps);
    let state: Float32Array = noise.map((value) => Math.fround(value * temperature) * levels[0]);
    let before: Float32Array | null = null;
    const plan = planned(pieces, frames);
    let held = plan;
    for (let k = 0; k < steps; k++) {
      const { clean, raw } = await this.estimate(pieces, held, state, levels[k], levels[k] >= GUIDED ? guidance : PLAIN);
      if (levels[k] < LATE) held = over(steered(raw, pieces), plan);
      sampling.onStep?.((k + 1) / steps);
      if (k === steps - 1) return kept(smoothed(raw), pieces, plan);
      const step = Math.log(levels[k] / levels[k + 1]);
      const share: number = before ? step / (2 * Math.log(levels[k - 1] / levels[k])) : 0;
      const ratio = levels[k + 1] / levels[k];
      const last: Float32Array | null = before;
      state = state.map((value, i) => ratio * value + (1 - ratio) * (last ? (1 + share) * clean[i] - share * last[i] : clean[i]));
      before = clean;
    }
    throw new InvalidInputError("steps must be a whole number");
  }

  /** Estimates of the whole canvas, normalised and raw, put together of those of its pieces. */
  private async estimate(pieces: Piece[], held: Held, state: Float32Array, level: number, guidance: Float32Array): Promise<{ clean: Float32Array; raw: Float32Array }> {
    const frames = held.motion.length / WIDTH;
    const [clean, raw, share] = [new Float32Array(frames * WIDTH), new Float32Array(frames * WIDTH), new Float32Array(frames)];
    for (const { words, first, weight } of pieces) {
      const count = weight.length;
      const { tokens, features } = words.features;
      const found = await this.sessions.run(
        "motion_denoiser",
        {
          noisy: this.sessions.float(state.slice(first * WIDTH, (first + count) * WIDTH), [1, count, WIDTH]),
          level: this.sessions.float(Float32Array.of(level), [1]),
          mask: this.sessions.flags(new Uint8Array(count).fill(1), [1, count]),
          token_features: this.sessions.float(features, [1, tokens, 384]),
          attention_mask: this.sessions.whole(new Uint8Array(tokens).fill(1), [1, tokens]),
          slots: this.sessions.whole(words.slots, [1, data.slots.length]),
          numbers: this.sessions.float(words.numbers, [1, data.targets.length]),
          known: this.sessions.flags(words.known, [1, data.targets.length]),
          held: this.sessions.float(held.motion.slice(first * WIDTH, (first + count) * WIDTH), [1, count, WIDTH]),
          holding: this.sessions.flags(held.parts.slice(first * PARTS.length, (first + count) * PARTS.length), [1, count, PARTS.length]),
          guidance: this.sessions.float(guidance, [1, 2]),
        },
        ["clean", "motion"],
      );
      const [c, r] = [numbers(found.clean), numbers(found.motion)];
      for (let f = 0; f < count; f++) {
        share[first + f] += weight[f];
        for (let n = 0; n < WIDTH; n++) {
          clean[(first + f) * WIDTH + n] += weight[f] * c[f * WIDTH + n];
          raw[(first + f) * WIDTH + n] += weight[f] * r[f * WIDTH + n];
        }
      }
    }
    for (let i = 0; i < clean.length; i++) {
      clean[i] /= share[Math.floor(i / WIDTH)];
      raw[i] /= share[Math.floor(i / WIDTH)];
    }
    return { clean, raw };
  }
}

const PLAIN = Float32Array.of(1, 1);

/** Features at 20 fps to a motion at 30 fps; for the longest text, of which so many frames are wanted, the last one goes on as it went. */
function asMotion(rows: Float32Array, wanted: number): Motion {
  const ratio = FPS / 30;
  const many = (frames: number): number => Math.floor((frames - 1) / ratio + 1e-6) + 1;
  const [width, frames] = [JOINTS * 3, rows.length / WIDTH];
  let [joints, count] = [decode(rows), many(frames)];
  if (count < wanted) {
    const [before, last] = [frames - 2, frames - 1].map((f) => joints.subarray(f * width, (f + 1) * width));
    joints = Float64Array.from([...joints, ...last.map((value, i) => 2 * value - before[i])]);
    count = many(frames + 1);
  }
  return fromPositions(between(joints, width, Array.from({ length: count }, (_, f) => f * ratio)), 30);
}

/** The nearest whole number, the even one of two that are as near. */
function rounded(value: number): number {
  const below = Math.floor(value);
  return below + (value - below === 0.5 ? below % 2 : Math.round(value - below));
}

/** Seconds from and to which a line holds. */
interface Time {
  from: number;
  to: number;
}

function timesOf(lines: Line[]): Time[] {
  let to = 0;
  return lines.map(({ seconds }) => ({ from: to, to: (to += seconds) }));
}

/** First frame and the one behind the last that a line is denoised in, with what overlaps. */
function spanOf(from: number, to: number, frames: number): [number, number] {
  const [first, last] = [rounded(from * FPS), Math.min(frames, rounded(to * FPS) + 1)];
  const more = Math.min(OVERLAP, Math.floor((NETWORK - (last - first)) / 2));
  return [Math.max(0, first - more), Math.min(frames, last + more)];
}

function rampOf(first: number, last: number, frames: number): Float32Array {
  const count = last - first;
  return Float32Array.from({ length: count }, (_, i) => {
    const rises = first > 0 ? (i + 1) / (2 * OVERLAP + 1) : 1;
    const falls = last < frames ? (count - i) / (2 * OVERLAP + 1) : 1;
    return Math.min(1, rises, falls);
  });
}
