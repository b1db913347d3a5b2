"""PostgreSQL under load: several clients, a server that dies in the middle, one that never comes back."""

from __future__ import annotations

import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from engine_library import library
from engine_servers import STAMP, Server

from motionrt.engines import PostgresStore, open_store
from motionrt.errors import EngineError
from motionrt.retrieval import Filter, Gallery


def part(whole: Gallery, first: int, last: int) -> Gallery:
    rows = np.flatnonzero((whole.windows["clip"] >= first) & (whole.windows["clip"] < last))
    windows = whole.windows[rows].copy()
    windows["clip"] -= first
    return Gallery(
        whole.clips[first:last],
        whole.embeddings[rows],
        windows,
        STAMP,
        attributes=whole.attributes[rows],  # type: ignore[index]
    )


def test_eight_clients_lose_nothing_and_see_nothing_wrong_while_the_server_is_restarted(postgres: Server) -> None:
    whole = library(160, seed=5)
    address = f"{postgres.address}#crowd"
    open_store(address, STAMP).close()
    put: set[str] = set()
    lock, over = threading.Lock(), threading.Event()

    def write(client: int) -> int:
        store = PostgresStore(postgres.address, "crowd", patience_s=120)
        for first in range(client * 40, client * 40 + 40, 4):
            store.upsert(part(whole, first, first + 4))
            with lock:
                put.update(clip.id for clip in whole.clips[first : first + 4])
            time.sleep(0.05)
        store.close()
        return 40

    def read(client: int) -> int:
        store = PostgresStore(postgres.address, "crowd", patience_s=120)
        draw, seen = np.random.default_rng(client), 0
        owners = whole.windows["clip"]
        while not over.is_set():
            with lock:
                sure = sorted(put)
            if not sure:
                time.sleep(0.02)
                continue
            wanted = sure[int(draw.integers(len(sure)))]
            row = int(np.flatnonzero([whole.clips[n].id == wanted for n in owners])[0])
            (found,) = store.nearest(whole.embeddings[row : row + 1], 3, Filter())
            assert found.clips[0] == wanted  # what was put in is found, whatever happens meanwhile
            assert found.embeddings[0] @ whole.embeddings[row] == pytest.approx(1, abs=1e-5)
            seen += 1
        store.close()
        return seen

    with ThreadPoolExecutor(8) as pool:
        readers = [pool.submit(read, client) for client in range(4)]
        writers = [pool.submit(write, client) for client in range(4)]
        time.sleep(1.0)
        try:
            postgres.restart()
        except BaseException:
            over.set()
            raise
        assert sum(writer.result(timeout=300) for writer in writers) == 160
        time.sleep(0.3)
        over.set()
        assert all(reader.result(timeout=300) > 0 for reader in readers)
    store = open_store(address)
    assert len(store) == len(whole.windows)
    store.close()


def test_a_server_that_is_away_for_good_is_told_in_time() -> None:
    pytest.importorskip("psycopg", reason="the extra postgres is not installed")
    began = time.monotonic()
    with pytest.raises(EngineError, match="cannot be reached"):
        PostgresStore("postgresql://nobody@127.0.0.1:9/none", "x", STAMP, patience_s=1.0)
    assert time.monotonic() - began < 15


def test_the_graph_finds_nearly_all(postgres: Server) -> None:
    store = PostgresStore(postgres.address, "graph", STAMP)
    whole = library(1500, seed=9)
    store.upsert(whole)
    store.index()
    queries = np.asarray(whole.embeddings)[::100]
    exact = store.nearest(queries, 10, Filter())
    near = store.nearest(queries, 10, Filter(), approximate=True)
    pairs = [[set(zip(one.clips, one.spans[:, 0].tolist(), strict=True)) for one in both] for both in (exact, near)]
    shares = [len(a & b) / 10 for a, b in zip(*pairs, strict=True)]
    assert np.mean(shares) > 0.9
    for told in (Filter(where="turn > 90"), Filter(folder="b", where="turn > 60"), Filter(min_s=99)):
        alike = [store.nearest(queries, 200, told, approximate=choice) for choice in (False, True)]
        assert [len(one.clips) for one in alike[0]] == [len(one.clips) for one in alike[1]]
    store.close()
