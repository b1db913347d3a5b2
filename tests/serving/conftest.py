"""A service on the loopback address, with instant models, and a library that it serves."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from fake_character_models import FakeCharacterModels
from fake_embedder import FakeEmbedder, open_fake
from motions import random_motion, walking
from service import TOKEN, Served
from tiny_models import TINY_GENERATORS

from motionrt.retrieval import build_gallery
from motionrt.runtime import Runtime

@pytest.fixture(scope="session")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("library")
    (folder / "ä").mkdir()
    walking(60).save(folder / "walk.bvh")
    walking(60, turn=0.6).save(folder / "ä" / "kreis.bvh")
    random_motion(300).save(folder / "long.npz")
    (folder / "captions.csv").write_text("file,caption,tags\nlong.npz,a robot dances,sci-fi\n")
    build_gallery(folder, open_fake)
    return folder


@pytest.fixture(scope="session")
def runtime() -> Runtime:
    made = Runtime(TINY_GENERATORS, variant="tiny")
    vars(made).update(model=FakeEmbedder(), character_models=FakeCharacterModels())
    return made


@pytest.fixture(scope="session")
def served(library: Path, runtime: Runtime) -> Iterator[Served]:
    pytest.importorskip("fastapi", reason="the extra serve is not installed")
    import uvicorn

    from motionrt.serving import Desk, make_app

    app = make_app(Desk(runtime, {"own": library}), token=TOKEN, origins=["https://studio.example"])
    server = uvicorn.Server(uvicorn.Config(app, host="127.0.0.1", port=0, log_level="error"))
    thread = threading.Thread(target=server.run, daemon=True)
    thread.start()
    while not server.started:
        assert thread.is_alive()
        time.sleep(0.02)
    yield Served(server.servers[0].sockets[0].getsockname()[1], app)
    server.should_exit = True
    thread.join(10)
