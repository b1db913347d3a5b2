// Frames on which several texts hold at their times, and what of a motion is kept (motionrt.synthesis.canvas).
import start from "./data/start.json";
import { WIDTH } from "./ego77";
import { PARTS } from "./skeleton";
import type { TokenFeatures } from "./text";
import type { Said } from "./words";

const OWNERS: readonly number[] = start.owners; // of every column the part that it belongs to

/** A text on a stretch of the canvas, as the denoiser is told it. */
export interface Piece {
  words: { features: TokenFeatures; slots: number[]; numbers: Float32Array; known: boolean[]; said: Said };
  first: number;
  weight: Float32Array; // of its frames
}

/** What of a motion is kept: features F x 77, and F x 6 which parts of which frames. */
export interface Held {
  motion: Float32Array;
  parts: Uint8Array;
}

export const nothing = (frames: number): Held => ({ motion: new Float32Array(frames * WIDTH), parts: new Uint8Array(frames * PARTS.length) });

/** What is held where it is, and the features F x 77 elsewhere. */
export const overlaid = ({ motion, parts }: Held, features: Float32Array): Float32Array =>
  features.map((value, i) => (parts[Math.floor(i / WIDTH) * PARTS.length + OWNERS[i % WIDTH]] ? motion[i] : value));

/** Both; where both keep something, the first counts. */
export const over = (first: Held, second: Held): Held => ({ motion: overlaid(first, second.motion), parts: first.parts.map((flag, i) => flag | second.parts[i]) });

/** The frames that belong to each piece, and what its text says. */
export function spans(pieces: Piece[]): { from: number; to: number; said: Said }[] {
  return pieces.flatMap(({ words, first, weight }) => {
    const own = Array.from(weight.keys()).filter((f) => weight[f] > 0.5);
    return own.length ? [{ from: first + own[0], to: first + own[own.length - 1] + 1, said: words.said }] : [];
  });
}
