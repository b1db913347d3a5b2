// Heads that look, nod and shake, which joint positions cannot say: their turns are added to the drawn motion (motionrt.synthesis.heads).
import { gesturesOf, type HeadGesture } from "./gestures";
import { Motion } from "./motion";
import { clamp, matrixOf, multiply } from "./rotations";
import { JOINTS, joint } from "./skeleton";
import { parseQuery } from "./words";

const RAMP_S = 0.4; // seconds over which a head begins and ends

/** A motion whose head does what texts say of it from and to their seconds, half in the neck; itself where they say nothing. */
export function withHeads(motion: Motion, lines: { text: string; from: number; to: number }[]): Motion {
  const said = lines.map(({ text, from, to }) => ({ from, to, head: gesturesOf(parseQuery(text)).head }));
  const rotations = motion.rotations.slice();
  let found = false;
  for (let f = 0; f < motion.frames; f++) {
    let [down, left] = [0, 0];
    for (const { from, to, head } of said) {
      const share = head ? shareAt(f / motion.fps, from, to, head) : 0;
      down += share * (head?.down ?? 0);
      left += share * (head?.left ?? 0);
    }
    if (!down && !left) continue;
    found = true;
    const half = turned(down / 2, left / 2);
    for (const name of ["neck", "head"]) rotations.set(multiply(half, motion.rotation(f, joint(name))), (f * JOINTS + joint(name)) * 9);
  }
  return found ? new Motion(rotations, motion.root, motion.fps) : motion;
}

/** How far a head is turned at a time, -1 to 1. */
function shareAt(time: number, from: number, to: number, { hz }: HeadGesture): number {
  const weight = clamp(Math.min(time - from, to - time) / RAMP_S, 0, 1);
  return weight * (hz ? Math.sin(2 * Math.PI * hz * (time - from)) : 1);
}

/** The rotation by `down` about X and `left` about Y as one, radians. */
function turned(down: number, left: number): number[] {
  const angle = Math.hypot(down, left);
  const sine = Math.sin(angle / 2) / angle;
  return matrixOf([Math.cos(angle / 2), down * sine, left * sine, 0]);
}
