// NumPy's default generator: `default_rng([seed, sample]).standard_normal(n, dtype=float32)`, number for number.
//
// SeedSequence (O'Neill's seed_seq), PCG64 XSL-RR, and the ziggurat of 256 layers in float32.
import { InvalidInputError } from "./errors";

const MASK32 = 0xffffffffn;
const MASK64 = (1n << 64n) - 1n;
const MASK128 = (1n << 128n) - 1n;
const MULTIPLIER = 47026247687942121848144207491837523525n;

/** Words of 32 bits that a SeedSequence of these whole numbers gives. */
function seedWords(entropy: readonly bigint[], count: number): number[] {
  const given: number[] = [];
  for (const value of entropy) {
    if (value < 0n) throw new InvalidInputError("a seed is a whole number from 0");
    let rest = value;
    do {
      given.push(Number(rest & MASK32));
      rest >>= 32n;
    } while (rest > 0n);
  }
  const pool = [0, 0, 0, 0];
  let constant = 0x43b0d7e5;
  const hash = (value: number): number => {
    value = (value ^ constant) >>> 0;
    constant = Math.imul(constant, 0x931e8875) >>> 0;
    value = Math.imul(value, constant) >>> 0;
    return (value ^ (value >>> 16)) >>> 0;
  };
  const mix = (x: number, y: number): number => {
    const result = (Math.imul(x, 0xca01f9dd) - Math.imul(y, 0x4973f715)) >>> 0;
    return (result ^ (result >>> 16)) >>> 0;
  };
  for (let i = 0; i < 4; i++) pool[i] = hash(given[i] ?? 0);
  for (let from = 0; from < 4; from++) for (let to = 0; to < 4; to++) if (from !== to) pool[to] = mix(pool[to], hash(pool[from]));
  for (let from = 4; from < given.length; from++) for (let to = 0; to < 4; to++) pool[to] = mix(pool[to], hash(given[from]));
  const words: number[] = [];
  constant = 0x8b51f9dd;
  for (let i = 0; i < count; i++) {
    let value = (pool[i % 4] ^ constant) >>> 0;
    constant = Math.imul(constant, 0x58f38ded) >>> 0;
    value = Math.imul(value, constant) >>> 0;
    words.push((value ^ (value >>> 16)) >>> 0);
  }
  return words;
}

const TAIL = 3.6541528853610088; // where the last layer of the ziggurat begins
const INVERSE = Math.fround(0.27366123732975828); // of that
const AREA = 0.004928673233974658; // of a layer

/** Widths, heights and borders of the layers, as float32 and uint32. */
const { widths, heights, borders } = (() => {
  const widths = new Float32Array(256);
  const heights = new Float32Array(256);
  const borders = new Uint32Array(256);
  const scale = 2 ** 23;
  let edge = TAIL;
  let before = TAIL;
  const q = AREA / Math.exp(-0.5 * edge * edge);
  borders[0] = Math.round((edge / q) * scale);
  widths[0] = q / scale;
  widths[255] = edge / scale;
  heights[0] = 1;
  heights[255] = Math.exp(-0.5 * edge * edge);
  for (let i = 254; i >= 1; i--) {
    edge = Math.sqrt(-2 * Math.log(AREA / edge + Math.exp(-0.5 * edge * edge)));
    borders[i + 1] = Math.round((edge / before) * scale);
    before = edge;
    heights[i] = Math.exp(-0.5 * edge * edge);
    widths[i] = edge / scale;
  }
  borders[1] = 0;
  return { widths, heights, borders };
})();

/** PCG64 seeded by a SeedSequence. */
export class Random {
  private state = 0n;
  private readonly increment: bigint;
  private half: number | null = null;

  constructor(...entropy: (number | bigint)[]) {
    const words = seedWords(entropy.map(BigInt), 8).map(BigInt);
    const [a, b, c, d] = [0, 2, 4, 6].map((i) => words[i] | (words[i + 1] << 32n));
    this.increment = ((((c << 64n) | d) << 1n) | 1n) & MASK128;
    this.step();
    this.state = (this.state + ((a << 64n) | b)) & MASK128;
    this.step();
  }

  private step(): void {
    this.state = (this.state * MULTIPLIER + this.increment) & MASK128;
  }

  private next64(): bigint {
    this.step();
    const value = ((this.state >> 64n) ^ this.state) & MASK64;
    const turn = this.state >> 122n;
    return ((value >> turn) | (value << ((64n - turn) & 63n))) & MASK64;
  }

  private next32(): number {
    if (this.half !== null) {
      const kept = this.half;
      this.half = null;
      return kept;
    }
    const next = this.next64();
    this.half = Number(next >> 32n);
    return Number(next & MASK32);
  }

  /** A float32 from 0 up to 1. */
  private uniform(): number {
    return Math.fround((this.next32() >>> 8) * (1 / 16777216));
  }

  /** `count` numbers of a standard normal distribution. */
  normals(count: number): Float32Array {
    const out = new Float32Array(count);
    for (let i = 0; i < count; i++) out[i] = this.normal();
    return out;
  }

  private normal(): number {
    for (;;) {
      const bits = this.next32();
      const layer = bits & 0xff;
      const negative = (bits >>> 8) & 1;
      const size = (bits >>> 9) & 0x007fffff;
      const x = Math.fround(Math.fround(size) * widths[layer]);
      const signed = negative ? -x : x;
      if (size < borders[layer]) return signed;
      if (layer === 0) {
        for (;;) {
          const away = Math.fround(-INVERSE * Math.fround(Math.log1p(-this.uniform())));
          const y = Math.fround(-Math.fround(Math.log1p(-this.uniform())));
          if (Math.fround(y + y) > Math.fround(away * away)) {
            const far = Math.fround(Math.fround(TAIL) + away);
            return (size >>> 8) & 1 ? -far : far;
          }
        }
      }
      const step = Math.fround(Math.fround(heights[layer - 1] - heights[layer]) * this.uniform());
      const between = Math.fround(step + heights[layer]);
      if (between < Math.exp(-0.5 * x * x)) return signed;
    }
  }
}
