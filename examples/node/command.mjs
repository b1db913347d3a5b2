// What the three programs share: options, --help, errors in one line, and motionrt with native code where it is installed.
import { parseArgs } from "node:util";
import { InvalidInputError, MotionRT, MotionRTError } from "motionrt-web";
import { folder } from "motionrt-web/node";

/** Run `main({ values, positionals })`; `options` are those of parseArgs with a `help` each. */
export async function command(usage, options, main) {
  const all = {
    site: { type: "string", default: "site", help: "folder that `motionrt web export --native` wrote" },
    json: { type: "boolean", default: false, help: "print JSON" },
    help: { type: "boolean", short: "h", default: false, help: "show this" },
    ...options,
  };
  try {
    const { values, positionals } = parseArgs({ allowPositionals: true, options: all });
    if (values.help) return console.log(help(usage, all));
    await main({ values, positionals });
  } catch (error) {
    const wrong = error instanceof InvalidInputError || String(error.code).startsWith("ERR_PARSE_ARGS");
    if (!wrong && !(error instanceof MotionRTError)) throw error;
    console.error(`error: ${error.message}`);
    process.exitCode = wrong ? 2 : 1;
  }
}

function help(usage, options) {
  const lines = Object.entries(options).map(([name, { short, help, default: usual }]) => {
    const flag = `${short ? `-${short}, ` : ""}--${name}`;
    return `  ${flag.padEnd(18)} ${help}${usual === undefined || usual === false ? "" : ` (default: ${usual})`}`;
  });
  return [`usage: node ${usage}`, "", ...lines].join("\n");
}

/** motionrt, by onnxruntime-node where there is one and by WebAssembly elsewhere. */
export async function open(site) {
  const engine = await import("onnxruntime-node").catch(() => undefined);
  return MotionRT.open({ from: folder(site), engine });
}

/** A number of the command line. */
export function number(text, name) {
  const value = Number(text);
  if (text === "" || !Number.isFinite(value)) throw new InvalidInputError(`--${name} takes a number, not '${text}'`);
  return value;
}
