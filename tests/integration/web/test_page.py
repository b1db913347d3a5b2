"""The demo page in a real browser: walks to clicks, acts on words, searches, takes a GLB, shows a crowd."""

from __future__ import annotations

import base64
import gzip
import io
import json
import os
import threading
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from chromium import Page, browser, find_chromium, wait_until

import motionrt
from motionrt.web import page_server, write_folder

from .conftest import BUILD, PACKAGE

WALK_MB, ALL_MB = 14, 45  # first loads, compressed


@pytest.fixture(scope="module")
def site(runtime: motionrt.Runtime, package: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    pages = PACKAGE / "dist" / "demo"
    if not (pages / "index.html").is_file():
        pytest.skip(f"the demo page is not built ({BUILD})")
    return write_folder(tmp_path_factory.mktemp("pages"), {"starter": runtime.gallery()}, pages=pages)


@pytest.fixture(scope="module")
def page(site: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    if find_chromium() is None:
        pytest.skip("no Chromium on this machine (Debian: apt install chromium)")
    pytest.importorskip("websockets", reason="websockets is not installed; the extra serve brings it")
    server = page_server(site)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    with browser(tmp_path_factory.mktemp("chromium")) as opened:
        page = opened.open(f"http://127.0.0.1:{server.server_address[1]}/", width=520, height=340, scale=0.5)
        page.wait("document.getElementById('status')?.textContent === 'Click the ground'", 120)
        yield page
    server.shutdown()


def character(page: Page) -> tuple[float, float, str]:
    """x, z and state of the character, a frame on."""
    found = json.loads(page.run("motionrt.tick(1/30).then(() => motionrt.where()).then(JSON.stringify)"))
    return found["x"], found["z"], found["state"]


def test_a_click_on_the_ground_is_where_the_character_walks(page: Page) -> None:
    page.run("motionrt.tick(0.1)")
    before = character(page)
    page.click_at(460, 190)
    page.wait("motionrt.times.clicked")
    page.run("motionrt.tick(1.5)")
    x, z, state = character(page)
    assert state == "walks"
    assert np.hypot(x - before[0], z - before[1]) > 0.3


def test_texts_are_embedded_in_the_page_as_in_python(page: Page, runtime: motionrt.Runtime) -> None:
    text = f"somebody number {np.random.default_rng().integers(10**6)} shuffles sideways and shrugs"
    found = np.array(json.loads(page.run(f"motionrt.remote.call.embed({text!r}).then(v => JSON.stringify([...v]))")))
    assert float(found @ runtime.embed_text(text)) > 0.999


def test_words_become_a_motion_that_is_played(page: Page) -> None:
    page.run("document.getElementById('text').value = 'raise both arms'")
    page.run("document.getElementById('do').click()")
    page.wait_text("“raise both arms”, seed", 240)
    page.run("motionrt.tick(0.5)")
    assert character(page)[2] == "acts"


def test_the_library_is_searched_and_a_hit_is_played(page: Page) -> None:
    page.run("document.getElementById('query').value = 'a person walks in a circle'")
    page.run("document.querySelector('#find button').click()")
    page.wait_text("5 clips", 60)
    assert "circle" in page.run("document.querySelector('#hits button').textContent")
    page.run("document.querySelector('#hits button').click()")
    wait_until(lambda: "5 clips" not in page.text(), 30, "the clip")


def test_a_glb_becomes_the_character(page: Page, runtime: motionrt.Runtime, tmp_path: Path) -> None:
    gallery = runtime.gallery()
    data = gallery.motion(gallery.clips[0].id)[:2].save(tmp_path / "hero.glb").read_bytes()
    source = f"data:model/gltf-binary;base64,{base64.b64encode(data).decode()}"
    page.run(f"fetch({source!r}).then(a => a.arrayBuffer()).then(b => motionrt.become(b))")
    page.wait_text("This is the character now", 30)
    page.run("motionrt.tick(0.2)")


def test_a_crowd_of_32_walks(page: Page) -> None:
    page.run("document.getElementById('crowd').click()")
    page.wait_text("32 characters", 120)
    page.run("motionrt.tick(0.2)")
    assert page.run("motionrt.waits.length") > 0


def test_ten_seconds_of_the_page_become_a_gif(page: Page, tmp_path: Path) -> None:
    image = pytest.importorskip("PIL.Image", reason="Pillow is not installed; the extra render brings it")
    kept = os.environ.get("MOTIONRT_PICTURES")  # a folder that keeps what is made
    out = (tmp_path if kept is None else Path(kept)) / "web_page.gif"
    crowd = "document.getElementById('crowd')"
    page.run(f"{crowd}.textContent === 'One character' && {crowd}.click()")
    page.wait(f"{crowd}.textContent === 'Crowd of 32'", 60)
    page.run("motionrt.remote.call.start({ x: 0, z: 0, heading: 0.5 })")
    shots = []

    def film(seconds: float) -> None:
        for _ in range(round(10 * seconds)):
            page.run("globalThis.ticked = false, void motionrt.tick(0.1).then(() => globalThis.ticked = true)")
            page.wait("ticked", 240)
            drawn = page.run("motionrt.stage.draw(), document.querySelector('canvas').toDataURL('image/png')")
            picture = image.open(io.BytesIO(base64.b64decode(drawn.partition(",")[2])))
            shots.append(picture.convert("RGB").resize((520, 340)).quantize(48))

    page.click_at(440, 200)
    film(5.5)
    page.run("void motionrt.act('raise both arms', 1)")
    page.wait_text("“raise both arms”, seed 1", 240)
    film(4.5)
    shots[0].save(out, save_all=True, append_images=shots[1:], duration=100, loop=0, optimize=True)
    with image.open(out) as made:
        assert made.n_frames == len(shots) == 100
    differ = [not np.array_equal(a, b) for a, b in pairwise(shots)]
    assert sum(differ) > 80


def test_nothing_comes_from_elsewhere_and_loads_stay_within_their_budgets(page: Page, site: Path) -> None:
    asked = {address.split("/", 3)[3] for address in page.requests() if address.startswith("http://127.0.0.1")}
    assert not [address for address in page.requests() if address.startswith("http") and "127.0.0.1" not in address]
    sizes = {path: len(gzip.compress((site / path).read_bytes())) for path in _files(site)}
    everything = sum(sizes[path] for path in sizes if "student" not in path and "galleries" not in path)
    walking = everything - sum(size for path, size in sizes.items() if "tmr_text" in path or "denoiser" in path)
    assert any(path.startswith("assets/worker") for path in asked)
    assert walking < WALK_MB * 1e6
    assert everything < ALL_MB * 1e6
    print(f"to walk {walking / 1e6:.1f} MB, all {everything / 1e6:.1f} MB")


def _files(site: Path) -> list[str]:
    return [path.relative_to(site).as_posix() for path in site.rglob("*") if path.is_file()]
