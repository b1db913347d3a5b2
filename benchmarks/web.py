"""What the models take in the page, in Node.js and in Python, side by side: walking, a crowd, a text, a motion.

(cd integrations/web && npm install && npm run build && npm run demo)
python -m motionrt_export portable --only walknet tmr_text motion_denoiser -o build/portable
python benchmarks/web.py --portable build/portable -o docs/results/web.json

Milliseconds are medians; the first quarter is left out. The texts are new ones every time. The page is the demo page in
headless Chromium, its models in a Web Worker, and drawing rests meanwhile. Node.js also computes natively where
examples/node is installed.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import motionrt
from motionrt.locomotion.crowd import Crowd, history_of
from motionrt.locomotion.starting_poses import stride
from motionrt.models import Sessions
from motionrt.models.walknet import WalkModel
from motionrt.retrieval import EMBEDDING_ONLY
from motionrt.web import page_server, write_folder

ROOT = Path(__file__).parents[1]
WEB = ROOT / "integrations" / "web"
NATIVE = ROOT / "examples" / "node" / "node_modules" / "onnxruntime-node" / "dist" / "index.js"
FRAMES = 90
MODELS = ("walknet", "tmr_text", "motion_denoiser")

sys.path.insert(0, str(ROOT / "tests" / "helpers"))

IN_PAGE = """
(async () => {
  await motionrt.tick(0.05);
  const call = motionrt.remote.call, texts = TEXTS;
  const timed = async (count, work) => {
    const times = [];
    for (let n = 0; n < count; n++) {
      const began = performance.now();
      await work(n);
      times.push(performance.now() - began);
    }
    const later = times.slice(Math.floor(count / 4)).sort((a, b) => a - b);
    return later[Math.floor(later.length / 2)];
  };
  const places = Array.from({ length: 32 }, (_, i) => ({ x: 2 * (i % 8), z: 3 * Math.floor(i / 8), heading: i }));
  await call.walkTo(2, 6);
  const told = { "walk, a frame": await timed(FRAMES, () => call.step()) };
  await call.startCrowd(places);
  const goals = places.map(() => ({ x: 2, z: 6 }));
  told["crowd of 32, a character"] = await timed(FRAMES / 3, () => call.stepCrowd(goals, 1.2)) / 32;
  told["text to hits"] = await timed(texts.length, (n) => call.search(texts[n], 10, "starter"));
  told["motion of 4 s"] = await timed(3, (n) => call.generate(texts[n], { seconds: 4, seed: n }));
  return JSON.stringify(told);
})()
"""


def new_texts(count: int) -> list[str]:
    """Texts that nothing has seen."""
    draw = np.random.default_rng()
    return [f"somebody number {draw.integers(10**6)} walks to the left and waves" for _ in range(count)]


def timed(count: int, call: Callable[[int], Any]) -> float:
    """Median milliseconds."""
    times = []
    for number in range(count):
        began = time.perf_counter()
        call(number)
        times.append(1000 * (time.perf_counter() - began))
    return float(np.median(times[count // 4 :]))


def in_python() -> dict[str, float]:
    """The shipped files by motionrt, in one thread."""
    runtime = motionrt.Runtime(threads=1, text_tower="full")
    model, texts = WalkModel(Sessions(threads=1)), new_texts(16)
    history = history_of(stride())[None].astype(np.float64)
    one, crowd = Crowd(model, history), Crowd(model, np.repeat(history, 32, axis=0))
    goals = np.tile([[2.0, 6.0, 0.4]], (32, 1))
    return {
        "walk, a frame": timed(FRAMES, lambda _: one.step(goals[:1])),
        "crowd of 32, a character": timed(FRAMES // 3, lambda _: crowd.step(goals)) / 32,
        "text to hits": timed(16, lambda n: runtime.retrieve(texts[n], k=10, weights=EMBEDDING_ONLY, anyway=True)),
        "motion of 4 s": timed(3, lambda n: runtime.generate(texts[n], seconds=4, seed=n)),
    }


def in_node(site: Path, *, native: bool) -> dict[str, float]:
    """A site's files in Node.js."""
    asked = {"site": str(site), "web": str(WEB), "frames": FRAMES, "texts": new_texts(16)}
    given = json.dumps(asked | {"native": NATIVE.as_uri() if native else None})
    command = ["node", str(Path(__file__).with_suffix(".mjs"))]
    done = subprocess.run(command, input=given, capture_output=True, text=True, encoding="utf-8", check=True)
    return dict(json.loads(done.stdout))


def in_page(site: Path, place: Path) -> dict[str, float]:
    """A site's files in headless Chromium; and when the first frame is shown after the page is asked for."""
    from chromium import browser

    place.mkdir()
    with page_server(site) as server, browser(place) as opened:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        page = opened.open(f"http://127.0.0.1:{server.server_address[1]}/", width=520, height=340, scale=0.5)
        page.wait("globalThis.motionrt?.times.shown", 120)
        first = page.run("motionrt.times.shown")
        script = IN_PAGE.replace("TEXTS", json.dumps(new_texts(16))).replace("FRAMES", str(FRAMES))
        told = dict(json.loads(page.run(script)))
        server.shutdown()
    return {"first frame": first, **told}


def sites(place: Path, portable: Path | None) -> dict[str, Path]:
    """Folders for the page: of the shipped files, of the same without rounding, and of the portable ones."""
    galleries, pages = {"starter": motionrt.Runtime().gallery()}, WEB / "dist" / "demo"
    found = {
        "shipped": write_folder(place / "shipped", galleries, pages=pages),
        "exact": write_folder(place / "exact", galleries, pages=pages, exact=True),
    }
    if portable is not None:
        found["portable"] = write_folder(place / "portable", galleries, pages=pages)
        told = json.loads((found["portable"] / "models.json").read_text(encoding="utf-8"))
        for name in MODELS:
            file = portable / f"{name}.portable.onnx"
            (found["portable"] / "models" / file.name).write_bytes(file.read_bytes())
            told["models"][name] = {"file": f"models/{file.name}", "bytes": file.stat().st_size}
        told["version"] = "portable"
        (found["portable"] / "models.json").write_text(json.dumps(told), encoding="utf-8")
    return found


def main() -> None:
    """Measure, print and write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--portable", type=Path, help="folder of the portable files")
    parser.add_argument("-o", "--out", type=Path)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        place = Path(name)
        found = sites(place, arguments.portable)
        as_shipped = write_folder(place / "native", {"starter": motionrt.Runtime().gallery()}, native=True)
        told = {"Python, shipped": in_python()}
        for files, site in found.items():
            told[f"Chromium, {files}"] = in_page(site, place / f"browser-{files}")
            told[f"Node.js, {files}"] = in_node(site, native=False)
            if NATIVE.is_file():
                told[f"Node.js with onnxruntime-node, {files}"] = in_node(
                    as_shipped if files == "shipped" else site, native=True
                )
    for where, times in told.items():
        print(f"{where}: " + ", ".join(f"{what} {ms:.2f} ms" for what, ms in times.items()), flush=True)
    if arguments.out is not None:
        arguments.out.write_text(json.dumps(told, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
