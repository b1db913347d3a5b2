"""The portable WalkNet on WebGPU, as far as a machine without a GPU can tell: on Chromium's software GPU."""

from __future__ import annotations

import json
import shutil
import threading
from pathlib import Path

import numpy as np
import pytest
from chromium import browser, find_chromium

from motionrt.web import page_server

from .conftest import BUILD, PACKAGE

pytest.importorskip("torch", reason="torch is not installed; the export extra brings it")
pytest.importorskip("onnx", reason="onnx is not installed; the export extra brings it")
pytest.importorskip("websockets", reason="websockets is not installed; the extra serve brings it")

ROOT = Path(__file__).parents[3]
FLAGS = ("--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader", "--enable-features=Vulkan")
ENGINE = PACKAGE / "node_modules" / "onnxruntime-web" / "dist"
RUN = """
globalThis.out = null;
(async () => {
  const ort = await import("/ort.webgpu.bundle.min.mjs");
  ort.env.wasm.wasmPaths = "/";
  const session = await ort.InferenceSession.create("/walknet.onnx", { executionProviders: ["webgpu"] });
  const asked = await (await fetch("/asked.json")).json();
  const feeds = Object.fromEntries(Object.entries(asked).map(([name, { sizes, numbers }]) =>
    [name, new ort.Tensor("float32", Float32Array.from(numbers), sizes)]));
  return [...(await session.run(feeds, ["next"])).next.data];
})()
  .catch(String)
  .then((found) => (globalThis.out = JSON.stringify(found)));
0
"""


def test_walknet_on_webgpu_is_that_of_onnxruntime(tmp_path: Path) -> None:
    import onnxruntime

    from motionrt_export.portable import portable
    from motionrt_export.sources import Sources

    if find_chromium() is None:
        pytest.skip("no Chromium on this machine (Debian: apt install chromium)")
    if not (ENGINE / "ort.webgpu.bundle.min.mjs").is_file():
        pytest.skip(f"onnxruntime-web is not installed ({BUILD})")
    site = tmp_path / "site"
    site.mkdir()
    for path in [*ENGINE.glob("ort.webgpu.bundle.min.mjs"), *ENGINE.glob("*.asyncify.*")]:
        shutil.copy(path, site)
    (site / "index.html").write_text("<p>WebGPU")
    content = portable(Sources(ROOT / "models").source("walknet")).SerializeToString()
    (site / "walknet.onnx").write_bytes(content)
    session = onnxruntime.InferenceSession(content, providers=["CPUExecutionProvider"])
    draw = np.random.default_rng(0)
    sizes = {info.name: [size if isinstance(size, int) else 1 for size in info.shape] for info in session.get_inputs()}
    sizes["frames"] = [1, 30, 219]
    feeds = {name: draw.normal(0.5, 0.2, shape).astype(np.float32) for name, shape in sizes.items()}
    asked = {name: {"sizes": sizes[name], "numbers": array.ravel().tolist()} for name, array in feeds.items()}
    (site / "asked.json").write_text(json.dumps(asked))
    with page_server(site) as server, browser(tmp_path, *FLAGS) as opened:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        page = opened.open(f"http://127.0.0.1:{server.server_address[1]}/")
        page.wait("document.readyState === 'complete'")
        if not page.run("navigator.gpu?.requestAdapter().then((found) => Boolean(found))"):
            pytest.skip("this Chromium has no WebGPU")
        page.run(RUN)
        found = json.loads(page.wait("out", 300))
        server.shutdown()
    np.testing.assert_allclose(found, session.run(["next"], feeds)[0][0], atol=1e-4, err_msg=str(found)[:200])
