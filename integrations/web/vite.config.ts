import { defineConfig } from "vite";

export default defineConfig({
  build: {
    outDir: "dist/lib",
    target: "es2022",
    minify: false,
    lib: { entry: { index: "src/index.ts", three: "src/three.ts", worker: "src/worker.ts", node: "src/node.ts" }, formats: ["es"] },
    rollupOptions: { external: [/^onnxruntime-web/, /^three/, /^node:/] },
  },
});
