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
        control = [str(self._programs / "pg_ctl"), "-D", str(self._folder), "-w", "-t", "120"]
        options = ["-o", f'-h "" -k {sockets}', "-l", str(self._folder / "log")]
        for command in ([*control, "-m", "immediate", "stop"], [*control, *options, "start"]):
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL, user=self._server.system_user)

    def stop(self) -> None:
        self._server.cleanup()
