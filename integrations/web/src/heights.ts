// How high a text says that the pelvis is in time (motionrt.text.ways).
import { FPS } from "./ego77";
import type { Said } from "./words";

const HEIGHTS: Record<string, number> = { standing: 0.94, crouching: 0.58, sitting: 0.5, crawling: 0.45, kneeling: 0.44, lying: 0.09 }; // metres
const [FIRST, LAST, LATEST_S, CHANGE_S, LEAST_CHANGE] = [0.4, 0.7, 2, 0.2, 0.2];
const OVER = 0.1; // metres

/** Heights of the pelvis in metres of a text that goes down or up on the spot, of so many frames at 20 fps; else null. */
export function heightsOf(said: Said, frames: number): number[] | null {
  const goes = (value: unknown): boolean => Boolean(value) && value !== "none";
  const course = goes(said.travel) || goes(said.turn) || said.path || said.jumps ? null : courseOf(said);
  if (!course) return null;
  const [start, middle, end] = course;
  const seconds = (frames - 1) / FPS;
  const first = Math.min((middle === null ? FIRST : 1 - LAST) * seconds, LATEST_S);
  const changed = (time: number): number => 1 / (1 + Math.exp(-time / CHANGE_S));
  return Array.from({ length: frames }, (_, f) => {
    const height = start + ((middle ?? end) - start) * changed(f / FPS - first);
    return middle === null ? height : height + (end - middle) * changed(f / FPS - LAST * seconds);
  });
}

function courseOf(said: Said): [number, number | null, number] | null {
  const up = HEIGHTS.standing;
  const height = (name: string | null | undefined): number | null => HEIGHTS[name ?? ""] ?? null;
  let [start, end] = [height(said.posture_start), height(said.posture_end)];
  const lowest = height(said.posture_lowest);
  let middle: number | null = null;
  if (said.level === "up") [start, end] = [start ?? lowest ?? (/\b(?:floor|ground)\b/.test(said.text) ? 0.3 : HEIGHTS.sitting), up];
  else if (said.level === "down") [start, end] = [up, end ?? lowest];
  else if (said.level === "down and up" || ((start === null || start === up) && end === up && lowest !== null)) [start, middle, end] = [up, lowest, up];
  if (start === null || end === null) return null;
  return Math.max(start, end) - Math.min(start, end, middle ?? end) >= LEAST_CHANGE ? [start, middle, end] : null;
}

/** Metres below which the pelvis stays in a text of one low posture; else null. */
export function ceilingOf(said: Said): number | null {
  const low: string | null = said.posture_lowest ?? null;
  const stays = low !== null && low === said.posture_start && low === said.posture_end && (!said.level || said.level === "level");
  const height = HEIGHTS[low ?? ""] ?? HEIGHTS.standing;
  return stays && height < HEIGHTS.standing ? height + OVER : null;
}
