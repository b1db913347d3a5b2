"""A real PostgreSQL on this machine, out of pgserver's wheel, that a test may stop and start."""

from __future__ import annotations

import subprocess
from pathlib import Path

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
        self._control("-m", "immediate", "stop")
        self._control("-o", f'-h "" -k {sockets}', "-l", str(self._folder / "log"), "start")

    def stop(self) -> None:
        """End it, whoever started it last."""
        self._control("-m", "immediate", "stop", must=False)
        self._server.cleanup()

    def _control(self, *words: str, must: bool = True) -> None:
        command = [str(self._programs / "pg_ctl"), "-D", str(self._folder), "-w", "-t", "120", *words]
        subprocess.run(command, check=must, stdout=subprocess.DEVNULL, user=self._server.system_user)
