// A motion on flat ground while somebody is on feet or knees (motionrt.motion.feet.flat_ground).
import { LOOSE_SPEED, speeds, wayOf } from "./feet";
import { LEGS } from "./legs";
import { Motion } from "./motion";
import { clamp } from "./rotations";

const HIGHEST = 0.15; // metres above the lowest toe: what stands higher stands on something
const [SMOOTH_S, QUANTILE] = [0.8, 0.3]; // seconds of the average over time; of the heights of standing toes
const [LOW, UPRIGHT] = [0.2, 0.4]; // heights of the pelvis between which the ground of feet counts more and more

/** The motion, moved vertically so that standing feet lie at 0; who lies keeps the height. */
export function uprightGround(motion: Motion): Motion {
  const curve = groundCurve(motion);
  const root = motion.root.map((value, i) => (i % 3 === 1 ? value - curve[(i - 1) / 3] * shareOf(motion, (i - 1) / 3) : value));
  return new Motion(motion.rotations, root, motion.fps);
}

const shareOf = (motion: Motion, f: number): number => clamp((motion.at(f, 0, 1) - LOW) / (UPRIGHT - LOW), 0, 1);

/** Height of the toe joint of a standing foot over time. */
function groundCurve(motion: Motion): number[] {
  const toes = LEGS.map((leg) => wayOf(motion, leg[3]));
  const pace = toes.map((way) => speeds(way, motion.fps));
  const lower = toes[0].map((_, f) => Math.min(...toes.map((way) => way[f][1])));
  const lowest = quantile(lower, 0.01);
  const heights = lower.map((_, f) =>
    Math.min(...toes.map((way, i) => (pace[i][f] < LOOSE_SPEED / 2 && way[f][1] < lowest + HIGHEST ? way[f][1] : Infinity))),
  );
  const known = heights.filter(Number.isFinite);
  if (!known.length) return heights.map(() => lowest);
  const level = quantile(known, QUANTILE);
  const spread = SMOOTH_S * motion.fps;
  const reach = Math.ceil(3 * spread);
  return heights.map((_, f) => {
    let [weight, total] = [0, 0];
    for (let g = Math.max(0, f - reach); g <= Math.min(heights.length - 1, f + reach); g++) {
      if (!Number.isFinite(heights[g])) continue;
      const bell = Math.exp(-0.5 * ((f - g) / spread) ** 2);
      weight += bell;
      total += bell * (heights[g] - level);
    }
    return level + total / (weight + 0.1 * spread);
  });
}

function quantile(values: number[], share: number): number {
  const sorted = [...values].sort((a, b) => a - b);
  const place = share * (sorted.length - 1);
  const below = Math.floor(place);
  return sorted[below] + (place - below) * ((sorted[below + 1] ?? sorted[below]) - sorted[below]);
}
