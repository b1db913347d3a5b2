// What a text says is met: gestures, limbs, ways and heights are brought to it while a motion is drawn (motionrt.synthesis.steering).
import { calm } from "./calming";
import { type Held, nothing, over, overlaid, type Piece, spans } from "./canvas";
import { FPS, WIDTH } from "./ego77";
import { carried, shareOf } from "./footing";
import { gestured } from "./gesturing";
import { ceilingOf, headingsOf, heightsOf, stridesOf } from "./heights";
import { PARTS } from "./skeleton";
import { brought, wayOf } from "./ways";
import type { Said } from "./words";

const GLOBAL = PARTS.indexOf("global");
const [AHEAD, HEIGHT] = [2, 3]; // columns of the way forward and of the pelvis

/** The root of texts that go down or up on the spot, and of jumps. */
export function planned(pieces: Piece[], frames: number): Held {
  const held = nothing(frames);
  for (const { from, to, said } of spans(pieces)) {
    const strides = stridesOf(said, to - from);
    heightsOf(said, to - from)?.forEach((height, i) => {
      held.motion[(from + i) * WIDTH + AHEAD] = (strides?.[i] ?? 0) / FPS;
      held.motion[(from + i) * WIDTH + HEIGHT] = height;
      held.parts[(from + i) * PARTS.length + GLOBAL] = 1;
    });
  }
  return held;
}

/** What must be otherwise about a motion F x 77 so that it does what the texts of its pieces say. */
export function steered(raw: Float32Array, pieces: Piece[]): Held {
  const held = nothing(raw.length / WIDTH);
  for (const { from, to, said } of spans(pieces)) {
    const { motion, parts } = asSaid(raw.slice(from * WIDTH, to * WIDTH), said);
    held.motion.set(motion, from * WIDTH);
    held.parts.set(parts, from * PARTS.length);
  }
  return held;
}

/** The motion with all that its texts ask for. */
export function kept(raw: Float32Array, pieces: Piece[], plan: Held): Float32Array {
  return overlaid(over(steered(raw, pieces), plan), raw);
}

/** The same of the frames of one text. */
function asSaid(given: Float32Array, said: Said): Held {
  const led = gestured(given, said);
  let rows = overlaid(led, given);
  const changed = calm(rows, said);
  const share = rows.length > WIDTH ? shareOf(said) : 0;
  if (share) {
    rows = carried(rows, share);
    changed[GLOBAL] = true;
  }
  const ceiling = ceilingOf(said);
  if (ceiling !== null && lowered(rows, Math.fround(ceiling))) changed[GLOBAL] = true;
  const headings = headingsOf(said, rows.length / WIDTH);
  if (headings) {
    for (let f = 1; f < headings.length; f++) rows[(f - 1) * WIDTH] = headings[f] - headings[f - 1];
    changed[GLOBAL] = true;
  }
  const way = wayOf(said, rows.length / WIDTH / FPS);
  const found = way && brought(rows, way);
  if (found) changed[GLOBAL] = true;
  return { motion: found ?? rows, parts: led.parts.map((flag, i) => flag | Number(changed[i % PARTS.length])) };
}

/** Keep the pelvis below a height, in place; whether anything had to be done. */
function lowered(rows: Float32Array, ceiling: number): boolean {
  let found = false;
  for (let i = HEIGHT; i < rows.length; i += WIDTH)
    if (rows[i] > ceiling) {
      rows[i] = ceiling;
      found = true;
    }
  return found;
}
