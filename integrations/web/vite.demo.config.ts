import { copyFileSync, mkdirSync } from "node:fs";
import { defineConfig, type Plugin } from "vite";

/** onnxruntime's WebAssembly lies beside the page, so that nothing comes from elsewhere. */
const engine: Plugin = {
  name: "onnxruntime-files",
  closeBundle() {
    mkdirSync("dist/demo/ort", { recursive: true });
    for (const end of ["mjs", "wasm"])
      copyFileSync(`node_modules/onnxruntime-web/dist/ort-wasm-simd-threaded.${end}`, `dist/demo/ort/ort-wasm-simd-threaded.${end}`);
  },
};

export default defineConfig({
  root: "demo",
  base: "./",
  plugins: [engine],
  resolve: { conditions: ["onnxruntime-web-use-extern-wasm", "module", "browser", "import", "default"] },
  worker: { format: "es" },
  build: { outDir: "../dist/demo", emptyOutDir: true, target: "es2022", chunkSizeWarningLimit: 1500 },
});
