// NumPy's .npy and .npz, as far as galleries need them: float32 matrices, records of numbers, stored archives.
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

/** Records of little-endian numbers, one object each. */
export function readRecords(content: Uint8Array, file: string): Record<string, number>[] {
  const { text, end } = header(content, file);
  const fields = [...text.matchAll(/\('(\w+)', '<([if])(\d)'\)/g)].map(([, name, kind, size]) => ({ name, kind, size: Number(size) }));
  const width = fields.reduce((sum, { size }) => sum + size, 0);
  if (!width) throw new LoadError(`${file}: expected records, found ${text.trim()}`);
  const view = new DataView(content.buffer, content.byteOffset);
  const found: Record<string, number>[] = [];
  for (let at = end; at + width <= content.length; ) {
    const record: Record<string, number> = {};
    for (const { name, kind, size } of fields) {
      record[name] = kind === "f" ? (size === 4 ? view.getFloat32(at, true) : view.getFloat64(at, true)) : size === 4 ? view.getInt32(at, true) : Number(view.getBigInt64(at, true));
      at += size;
    }
    found.push(record);
  }
  return found;
}
