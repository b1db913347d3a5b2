// Feet that slide along the floor through a long contact take steps instead (motionrt.motion.feet.sliding).
import { BLEND_S, faded, LOOSE_SPEED, MAX_SHIFT, moved, runsOf, speeds, STRICT_HEIGHT, STRICT_SPEED, wayOf } from "./feet";
import { LEGS } from "./legs";
import type { Motion } from "./motion";
import { add, minus, times, type Vec3 } from "./rotations";

const STRAYS = 0.1; // metres that a foot may be off the place where it stands before it is lifted
const [SWING_S, REST_S] = [0.3, 0.13]; // seconds that a foot is in the air, and stands at least
const LIFT = 0.05; // metres
const [SLOWEST, QUICKEST, SHORTEST_S, LEAP_S] = [0.3, 2.2, 0.1, 0.25]; // m/s of a pelvis; how long neither foot stands, and around a leap
const UPRIGHT = 0.6; // metres that the pelvis is high: who crawls or kneels drags the feet

interface Flight {
  began: number;
  start: Vec3;
  end: Vec3;
}

/** The motion, on the floor, with steps in place of slides; its feet are to be locked afterwards. */
export function stepWhereSliding(motion: Motion): Motion {
  const toes = LEGS.map((leg) => wayOf(motion, leg[3]));
  const neither = neitherOf(toes, motion);
  const sliding = toes.map((way) => slidingOf(way, neither, motion));
  if (!sliding.flat().some(Boolean)) return motion;
  const offsets = stepped(toes, sliding, motion.fps).map((offset, i) => faded(offset, sliding[i], BLEND_S * motion.fps));
  return moved(motion, offsets, sliding);
}

/** When somebody who walks has neither foot standing, and does not leap. */
function neitherOf(toes: Vec3[][], motion: Motion): boolean[] {
  const flat = (way: Vec3[]): number[] => speeds(way.map(([x, , z]): Vec3 => [x, 0, z]), motion.fps);
  const [one, other] = toes.map(flat);
  const body = flat(wayOf(motion, 0));
  const lowest = toes[0].map(([, y], f) => Math.min(y, toes[1][f][1]));
  const reach = Math.round(LEAP_S * motion.fps);
  const leaps = lowest.map((_, f) => lowest.slice(Math.max(f - reach, 0), f + reach + 1).some((y) => y > STRICT_HEIGHT));
  const found = lowest.map((y, f) => y < STRICT_HEIGHT && Math.min(one[f], other[f]) > STRICT_SPEED && body[f] > SLOWEST && body[f] < QUICKEST && !leaps[f]);
  const flags = new Array<boolean>(found.length).fill(false);
  for (const { start, stop } of runsOf(found)) if (stop - start >= Math.round(SHORTEST_S * motion.fps)) flags.fill(true, start, stop);
  return flags;
}

/** The frames in which a toe of somebody upright travels along the floor too far to be pinned. */
function slidingOf(way: Vec3[], neither: boolean[], motion: Motion): boolean[] {
  const speed = speeds(way, motion.fps);
  const flags = new Array<boolean>(way.length).fill(false);
  for (const { start, stop } of runsOf(way.map(([, y], f) => ((y < STRICT_HEIGHT && speed[f] < LOOSE_SPEED) || neither[f]) && motion.at(f, 0, 1) > UPRIGHT))) {
    const part = way.slice(start, stop);
    const [x, z] = [0, 2].map((i) => Math.max(...part.map((toe) => toe[i])) - Math.min(...part.map((toe) => toe[i])));
    if (Math.hypot(x, z) > 2 * MAX_SHIFT) flags.fill(true, start, stop);
  }
  return flags;
}

/** What moves each toe from where it slides to where it stands or swings; 0 elsewhere. */
function stepped(toes: Vec3[][], sliding: boolean[][], fps: number): Vec3[][] {
  const frames = toes[0].length;
  const [swing, rest] = [Math.max(3, Math.round(SWING_S * fps)), Math.max(2, Math.round(REST_S * fps))];
  const offset = toes.map((way) => way.map((): Vec3 => [0, 0, 0]));
  const place = toes.map((way) => way[0]);
  const landed = [-rest, -rest]; // frames
  const aloft: (Flight | null)[] = [null, null];
  for (let f = 0; f < frames; f++)
    for (const foot of [0, 1]) {
      const now = toes[foot][f];
      if (!sliding[foot][f]) {
        aloft[foot] = null;
        landed[foot] = f;
        continue;
      }
      if (f === 0 || !sliding[foot][f - 1]) place[foot] = standing(toes[foot], sliding[foot], f);
      const off = Math.hypot(now[0] - place[foot][0], now[2] - place[foot][2]);
      if (!aloft[foot] && off > STRAYS && !aloft[1 - foot] && f - landed[foot] >= rest)
        aloft[foot] = { began: f, start: place[foot], end: standing(toes[foot], sliding[foot], Math.min(f + swing, frames - 1)) };
      const flight = aloft[foot];
      const s = flight ? Math.min(1, (f - flight.began) / swing) : 0;
      const wanted = flight ? add(flight.start, times(minus(flight.end, flight.start), s * s * (3 - 2 * s))) : place[foot];
      offset[foot][f] = [wanted[0] - now[0], (flight ? LIFT * Math.sin(Math.PI * s) : 0) - Math.max(now[1], 0), wanted[2] - now[2]];
      if (flight && s >= 1) {
        place[foot] = flight.end;
        aloft[foot] = null;
        landed[foot] = f;
      }
    }
  return offset;
}

/** Where a foot that lands at a frame stands: as far ahead on its way as it may stray. */
function standing(way: Vec3[], sliding: boolean[], frame: number): Vec3 {
  const stop = sliding.indexOf(false, frame);
  const ahead = way.slice(frame, stop < 0 ? way.length : Math.max(stop, frame + 1));
  return ahead.find(([x, , z]) => Math.hypot(x - ahead[0][0], z - ahead[0][2]) >= STRAYS) ?? ahead[ahead.length - 1];
}
