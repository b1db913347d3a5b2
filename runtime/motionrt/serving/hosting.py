"""Running the service: uvicorn on an address, until Ctrl-C."""

from __future__ import annotations

from typing import Any

import uvicorn

LOOPBACK = ("127.0.0.1", "localhost", "::1")


def serve(app: Any, *, host: str, port: int) -> None:
    """Serve an ASGI application until the process is told to stop; what is under way is finished first."""
    uvicorn.run(
        app,
        host=host,
        port=port,
        log_level="warning",
        access_log=False,
        server_header=False,
        ws_max_size=65536,
        timeout_graceful_shutdown=10,
    )
