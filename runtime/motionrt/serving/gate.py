"""Who may ask, and how much at once: a token, a number of requests, a number of bytes."""

from __future__ import annotations

import asyncio
import hmac
import json
import time
from collections.abc import Awaitable, Callable, MutableMapping, Sequence
from typing import Any
from urllib.parse import parse_qs

from motionrt.errors import InvalidInputError
from motionrt.limits import how_to_raise, limits
from motionrt.serving.metrics import Metrics

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]

OPEN = ("/health",)
"""Paths that need no token."""

HEADERS = [
    (b"x-content-type-options", b"nosniff"),
    (b"cache-control", b"no-store"),
    (b"referrer-policy", b"no-referrer"),
]
_REFUSED = 4401  # how a WebSocket is closed that brings no token


class TooLargeError(InvalidInputError):
    """A body has more bytes than may be sent."""


class Gate:
    """ASGI middleware before the app.

    Args:
        app: what is served.
        token: what clients send as ``Authorization: Bearer TOKEN``, or ``?token=`` for a WebSocket; None lets all in.
        origins: web pages that may ask, as in ``https://example.org``; programs send no origin.
        active: requests that are worked on at once; as many more wait, and the others are told to come back.
        metrics: what is counted.
    """

    def __init__(self, app: Any, token: str | None, origins: Sequence[str], active: int, metrics: Metrics) -> None:
        self._app, self._token, self._origins, self._metrics = app, token, tuple(origins), metrics
        self._slots, self._most = asyncio.Semaphore(active), 2 * active

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let a request in, or say why not."""
        if scope["type"] == "http":
            await self._http(scope, receive, send)
        elif scope["type"] == "websocket":
            await self._socket(scope, receive, send)
        else:
            await self._app(scope, receive, send)

    async def _http(self, scope: Scope, receive: Receive, send: Send) -> None:
        began, status = time.perf_counter(), 500

        async def sending(message: MutableMapping[str, Any]) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
                message["headers"] = [*message.get("headers", []), *HEADERS]
            await send(message)

        try:
            refusal = self._refusal(scope)
            if refusal is not None:
                await _answer(sending, *refusal)
                return
            self._metrics.active += 1
            try:
                async with self._slots:
                    await self._app(scope, _bounded(receive), sending)
            finally:
                self._metrics.active -= 1
        finally:
            route = scope.get("route")
            self._metrics.note(getattr(route, "path", "other"), status, time.perf_counter() - began)

    def _refusal(self, scope: Scope) -> tuple[int, str, str] | None:
        headers = dict(scope["headers"])
        origin = headers.get(b"origin")
        if origin is not None and origin.decode("latin-1") not in self._origins:
            return 403, "Forbidden", "this web page may not ask here; start the server with --origin to let it"
        if scope["path"] not in OPEN and not self._knows(headers.get(b"authorization", b"")):
            return 401, "Unauthorized", "send the token: Authorization: Bearer TOKEN"
        if self._metrics.active >= self._most:
            return 503, "Busy", "too many requests at once; come back in a second"
        if int(headers.get(b"content-length", b"0") or b"0") > limits().upload_bytes:
            return 413, "TooLargeError", how_to_raise("upload_bytes")
        return None

    async def _socket(self, scope: Scope, receive: Receive, send: Send) -> None:
        headers = dict(scope["headers"])
        given = parse_qs(scope.get("query_string", b"").decode("latin-1"), max_num_fields=20).get("token", [""])[0]
        known = self._knows(headers.get(b"authorization", b"")) or self._knows(b"Bearer " + given.encode())
        origin = headers.get(b"origin")
        if not known or (origin is not None and origin.decode("latin-1") not in self._origins):
            await receive()
            await send({"type": "websocket.close", "code": _REFUSED, "reason": "send the token: ?token=TOKEN"})
            return
        await self._app(scope, receive, send)

    def _knows(self, authorization: bytes) -> bool:
        return self._token is None or hmac.compare_digest(authorization, b"Bearer " + self._token.encode())


def _bounded(receive: Receive) -> Receive:
    """The same, until more bytes have come than a body may have."""
    left = int(limits().upload_bytes)

    async def receiving() -> MutableMapping[str, Any]:
        nonlocal left
        message = await receive()
        left -= len(message.get("body", b""))
        if left < 0:
            raise TooLargeError(how_to_raise("upload_bytes"))
        return message

    return receiving


async def _answer(send: Send, status: int, kind: str, message: str) -> None:
    body = json.dumps({"error": {"type": kind, "message": message}}).encode()
    headers = [(b"content-type", b"application/json"), (b"content-length", str(len(body)).encode())]
    if status == 503:
        headers.append((b"retry-after", b"1"))
    if status == 401:
        headers.append((b"www-authenticate", b"Bearer"))
    await send({"type": "http.response.start", "status": status, "headers": headers})
    await send({"type": "http.response.body", "body": body})
