"""A folder of static files over HTTP, isolated so that a page may use threads."""

from __future__ import annotations

from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

from motionrt.errors import InvalidInputError

TYPES = {".wasm": "application/wasm", ".mjs": "text/javascript", ".js": "text/javascript", ".glb": "model/gltf-binary"}


class _Files(SimpleHTTPRequestHandler):
    extensions_map = {**SimpleHTTPRequestHandler.extensions_map, **TYPES}  # noqa: RUF012  # the library's own form

    def end_headers(self) -> None:
        """Isolation (COOP, COEP), and no copy of a page that may have been built anew."""
        self.send_header("Cross-Origin-Opener-Policy", "same-origin")
        self.send_header("Cross-Origin-Embedder-Policy", "require-corp")
        self.send_header("Cache-Control", "no-cache")
        super().end_headers()

    def log_message(self, format: str, *args: object) -> None:  # noqa: A002  # the library's name
        """Say nothing."""


def page_server(folder: str | Path, host: str = "127.0.0.1", port: int = 0) -> ThreadingHTTPServer:
    """A server of the files of ``folder``; its ``serve_forever`` serves, its ``server_address`` says where.

    Raises:
        InvalidInputError: no ``index.html`` there, or an address that cannot be had.
    """
    path = Path(folder)
    if not (path / "index.html").is_file():
        raise InvalidInputError(f"{path} holds no index.html; write it with: motionrt web export {path} --pages FOLDER")
    try:
        return ThreadingHTTPServer((host, port), partial(_Files, directory=str(path)))
    except (OSError, OverflowError) as error:
        raise InvalidInputError(f"cannot serve on {host}:{port}: {error}") from error
