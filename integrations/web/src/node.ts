// Files of a folder for Node.js.
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { LoadError } from "./errors";
import type { Source } from "./sessions";

/** Files below a folder, such as one that `motionrt web export` wrote. */
export function folder(path: string): Source {
  return async (file) => {
    try {
      return await readFile(join(path, file));
    } catch (error) {
      throw new LoadError(`cannot read ${join(path, file)}: ${(error as NodeJS.ErrnoException).code ?? String(error)}`);
    }
  };
}
