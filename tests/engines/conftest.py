"""Real engines on this machine: PostgreSQL 16 with pgvector out of pgserver's wheel, and Milvus Lite."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from engine_servers import STAMP, Server

from motionrt.engines import GalleryStore, open_store


@pytest.fixture(scope="session")
def postgres() -> Iterator[Server]:
    pytest.importorskip("pgserver", reason="pgserver is not installed")
    pytest.importorskip("psycopg", reason="the extra postgres is not installed")
    with tempfile.TemporaryDirectory(prefix="motionrt-postgres-", ignore_cleanup_errors=True) as folder:
        server = Server(Path(folder))  # not in pytest's, which another pytest closes to the server's user
        yield server
        server.stop()


@pytest.fixture(scope="session")
def milvus(tmp_path_factory: pytest.TempPathFactory) -> str:
    pytest.importorskip("pymilvus", reason="the extra milvus is not installed")
    pytest.importorskip("milvus_lite", reason="milvus-lite is not installed")
    return f"milvus://{tmp_path_factory.mktemp('milvus') / 'library.db'}"


@pytest.fixture(params=["postgres", "milvus"])
def address(request: pytest.FixtureRequest) -> str:
    """Of a library of the test's own, in each of the engines."""
    found = request.getfixturevalue(request.param)
    name = "t" + str(abs(hash(request.node.nodeid)) % 10**9)
    return f"{found if isinstance(found, str) else found.address}#{name}"


@pytest.fixture
def store(address: str) -> Iterator[GalleryStore]:
    opened = open_store(address, STAMP)
    yield opened
    opened.close()
