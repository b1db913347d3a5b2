// NumPy's .npy, as far as galleries need it: float32 in C order.
import { LoadError } from "./errors";

interface Header {
  text: string;
  end: number;
}

function header(content: Uint8Array, file: string): Header {
  const magic = content.subarray(0, 6);
  if (magic[0] !== 0x93 || String.fromCharCode(...magic.subarray(1)) !== "NUMPY") throw new LoadError(`${file} is no .npy file`);
  const view = new DataView(content.buffer, content.byteOffset);
  const long = content[6] > 1;
  const start = long ? 12 : 10;
  const end = start + (long ? view.getUint32(8, true) : view.getUint16(8, true));
  return { text: new TextDecoder("latin1").decode(content.subarray(start, end)), end };
}

/** A float32 array in C order with its shape. */
export function readFloats(content: Uint8Array, file: string): { shape: number[]; data: Float32Array } {
  const { text, end } = header(content, file);
  const shape = /'shape': \(([^)]*)\)/.exec(text)?.[1].split(",").filter((part) => part.trim()).map(Number);
  if (!text.includes("'<f4'") || !text.includes("'fortran_order': False") || !shape)
    throw new LoadError(`${file}: expected float32 numbers in C order, found ${text.trim()}`);
  const count = shape.reduce((a, b) => a * b, 1);
  if (content.length < end + 4 * count) throw new LoadError(`${file} ends too early`);
  const bytes = content.slice(end, end + 4 * count);
  return { shape, data: new Float32Array(bytes.buffer, bytes.byteOffset, count) };
}
