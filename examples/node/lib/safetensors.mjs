// Columns of a safetensors file: eight bytes with the length of a JSON header, the header, and the arrays.
import { readFile } from "node:fs/promises";

const ARRAYS = { F64: Float64Array, F32: Float32Array, I64: BigInt64Array, I8: Int8Array, U32: Uint32Array, U8: Uint8Array };

/** { name: { shape, data } } */
export async function readColumns(file) {
  const content = await readFile(file);
  const start = 8 + Number(content.readBigUInt64LE(0));
  const { __metadata__, ...header } = JSON.parse(content.toString("utf8", 8, start));
  const columns = {};
  for (const [name, { dtype, shape, data_offsets: [first, last] }] of Object.entries(header)) {
    if (!ARRAYS[dtype]) continue;
    const bytes = content.buffer.slice(content.byteOffset + start + first, content.byteOffset + start + last);
    columns[name] = { shape, data: new ARRAYS[dtype](bytes) };
  }
  return columns;
}
