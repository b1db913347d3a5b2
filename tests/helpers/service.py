"""Where the service of a test is, and what opens it."""

from __future__ import annotations

from dataclasses import dataclass

TOKEN = "a token for tests"


@dataclass
class Served:
    """A service on the loopback address."""

    port: int
    app: object

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.port}"
