// NumPy's .npy, as far as galleries need it: two dimensions, little-endian float32.
import { readFile } from "node:fs/promises";

/** { rows, columns, data: Float32Array } */
export async function readNpy(file) {
  const content = await readFile(file);
  if (content.toString("latin1", 0, 6) !== "\x93NUMPY") throw new Error(`${file} is no .npy file`);
  const long = content[6] > 1;
  const start = long ? 12 : 10;
  const end = start + (long ? content.readUInt32LE(8) : content.readUInt16LE(8));
  const header = content.toString("latin1", start, end);
  const shape = /'shape': \((\d+), (\d+)\)/.exec(header);
  if (!header.includes("'<f4'") || !header.includes("'fortran_order': False") || !shape)
    throw new Error(`${file}: expected a float32 matrix in C order, found ${header.trim()}`);
  const [rows, columns] = [Number(shape[1]), Number(shape[2])];
  const bytes = content.buffer.slice(content.byteOffset + end, content.byteOffset + end + 4 * rows * columns);
  return { rows, columns, data: new Float32Array(bytes) };
}
