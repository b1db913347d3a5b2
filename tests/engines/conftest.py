"""Real engines on this machine: PostgreSQL 16 with pgvector out of pgserver's wheel, and Milvus Lite."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from motionrt.engines import GalleryStore, open_store
from motionrt.retrieval.records import ModelStamp

STAMP = ModelStamp("fake", "f" * 64)


class Server:
    """A PostgreSQL that a test may stop and start."""

    def __init__(self, folder: Path) -> None:
        import pgserver

        self._server = pgserver.get_server(folder, cleanup_mode="stop")
        self.address = self._server.get_uri()
        self._folder = folder
        self._programs = Path(pgserver.__file__).parent / "pginstall" / "bin"

    def restart(self) -> None:
        """As after a crash: connections break, and what was committed is recovered."""
        sockets = self.address.partition("host=")[2]
        control = [str(self._programs / "pg_ctl"), "-D", str(self._folder), "-w", "-t", "120"]
        options = ["-o", f'-h "" -k {sockets}', "-l", str(self._folder / "log")]
        for command in ([*control, "-m", "immediate", "stop"], [*control, *options, "start"]):
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL, user=self._server.system_user)

    def stop(self) -> None:
        self._server.cleanup()


@pytest.fixture(scope="session")
def postgres(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    pytest.importorskip("pgserver", reason="pgserver is not installed")
    pytest.importorskip("psycopg", reason="the extra postgres is not installed")
    server = Server(tmp_path_factory.mktemp("postgres"))
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
