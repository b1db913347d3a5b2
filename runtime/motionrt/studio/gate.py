"""Who may come in: the address, the origin, the token, how many windows, and how much they send.

A page on the loopback address is open to every web page that the same browser shows: they can connect to it, and with
a name that resolves to 127.0.0.1 they can even read it. So every request must name this machine (``Host``), every
socket must come from this very page (``Origin``), and both must know a token that only the printed address has.
"""

from __future__ import annotations

import hmac
import http
import secrets
import socket
from collections.abc import Awaitable, Callable
from http.cookies import CookieError, SimpleCookie
from ipaddress import ip_address
from typing import Any
from urllib.parse import parse_qs, urlsplit

from motionrt.limits import limits
from motionrt.studio.page_script import with_script
from motionrt.studio.traffic import metered

ANY = ("0.0.0.0", "::", "")
LOOPBACK = ("127.0.0.1", "localhost", "::1")
_COOKIE = "Path=/; HttpOnly; SameSite=Strict"
HEADERS = {
    "X-Frame-Options": "DENY",
    "Content-Security-Policy": "frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-store",
}


class Gate:
    """What a request must bring.

    Args:
        host: the address that is served.
        port: its port.
    """

    def __init__(self, host: str, port: int) -> None:
        self.host, self.port = host, port
        self.token = secrets.token_urlsafe(24)
        self.windows = 0
        self.installed = False
        self._browsers: list[str | None] = []

    @property
    def url(self) -> str:
        """The address to open, with the token."""
        shown = "127.0.0.1" if self.host in ANY else self.host
        return f"http://{f'[{shown}]' if ':' in shown else shown}:{self.port}/?token={self.token}"

    @property
    def cookie(self) -> str:
        """Its name; cookies do not know ports, so the name does."""
        return f"motionrt-{self.port}"

    @property
    def browser_cookie(self) -> str:
        """The name of the cookie that tells browsers apart, so that a reload finds the work of its own window."""
        return f"{self.cookie}-browser"

    def arrived(self, request: Any) -> None:
        """A socket was let in; viser numbers them in the order of this."""
        self._browsers.append(self._read_cookie(request, self.browser_cookie))

    def browser_of(self, number: int) -> str | None:
        """Which browser the socket of a number came from; None where it does not say."""
        return self._browsers[number] if 0 <= number < len(self._browsers) else None

    def refusal(self, request: Any, *, is_socket: bool) -> tuple[http.HTTPStatus, str] | None:
        """Why a request is refused, or None."""
        if not self._names_us(_only(request, "Host")):
            return http.HTTPStatus.FORBIDDEN, "this address is not served here"
        if not self._knows(request):
            return http.HTTPStatus.FORBIDDEN, "open the address that was printed, with its token"
        if is_socket and not self._from_here(request):
            return http.HTTPStatus.FORBIDDEN, "another page may not connect"
        if is_socket and self.windows >= limits().windows:
            return http.HTTPStatus.SERVICE_UNAVAILABLE, f"{self.windows} windows are open; close one"
        return None

    def admit(self, request: Any, response: Any) -> Any:
        """The response with what keeps the page to itself, and the cookie for whoever brought the token."""
        for name, value in HEADERS.items():
            response.headers[name] = value
        if self._token_of(request) is not None:
            response.headers["Set-Cookie"] = f"{self.cookie}={self.token}; {_COOKIE}"
            if self._read_cookie(request, self.browser_cookie) is None:
                response.headers["Set-Cookie"] = f"{self.browser_cookie}={secrets.token_urlsafe(16)}; {_COOKIE}"
        return response

    def _names_us(self, host: str | None) -> bool:
        name = _host_name(host, self.port)
        if name is None:
            return False
        if self.host in ANY:
            return name in LOOPBACK or name in _own_names() or _is_address(name)
        return name == self.host.lower() or (self.host in LOOPBACK and name in LOOPBACK)

    def _from_here(self, request: Any) -> bool:
        origin, host = _only(request, "Origin"), _only(request, "Host")
        return origin is not None and host is not None and origin.lower() == f"http://{host.lower()}"

    def _knows(self, request: Any) -> bool:
        given = (self._token_of(request), self._cookie_of(request))
        return any(hmac.compare_digest(word.encode(), self.token.encode()) for word in given if word is not None)

    def _token_of(self, request: Any) -> str | None:
        return next(iter(parse_qs(urlsplit(request.path).query, max_num_fields=20).get("token", [])), None)

    def _cookie_of(self, request: Any) -> str | None:
        return self._read_cookie(request, self.cookie)

    @staticmethod
    def _read_cookie(request: Any, name: str) -> str | None:
        for header in request.headers.get_all("Cookie"):
            try:
                found = SimpleCookie(header).get(name)
            except CookieError:
                continue
            if found is not None:
                return found.value
        return None


def serving_through(gate: Gate, serve: Callable[..., Any]) -> Callable[..., Any]:
    """``websockets.asyncio.server.serve`` with the gate before everything that is served at its port.

    Calls for other ports, as of other servers in the same process, go through as they are.
    """

    def guarded(handler: Callable[[Any], Awaitable[None]], host: Any = None, port: Any = None, **options: Any) -> Any:
        if (host, port) != (gate.host, gate.port):
            return serve(handler, host, port, **options)
        gate.installed = True
        answer = options.pop("process_request")

        def process(connection: Any, request: Any) -> Any:
            is_socket = "websocket" in request.headers.get("Upgrade", "").lower()
            refused = gate.refusal(request, is_socket=is_socket)
            if refused is not None:
                return connection.respond(*refused)
            response = answer(connection, request)
            return response if response is None else gate.admit(request, with_script(request.path, response))

        async def handle(connection: Any) -> None:
            gate.windows += 1
            gate.arrived(connection.request)
            try:
                await handler(metered(connection))
            finally:
                gate.windows -= 1

        return serve(handle, host, port, process_request=process, **options)

    return guarded


def _only(request: Any, name: str) -> str | None:
    """A header that must stand there once."""
    values = request.headers.get_all(name)
    return values[0].strip() if len(values) == 1 else None


def _host_name(host: str | None, port: int) -> str | None:
    """The name in ``Host`` if its port is ours."""
    if host is None:
        return None
    try:
        parts = urlsplit(f"//{host}")
        name, given = parts.hostname, parts.port
    except ValueError:
        return None
    return name if name and (80 if given is None else given) == port and parts.path == "" else None


def _own_names() -> tuple[str, ...]:
    name = socket.gethostname().lower()
    return name, f"{name}.local", socket.getfqdn().lower()


def _is_address(name: str) -> bool:
    """Whether it is a plain number, which nobody can let resolve to another machine."""
    try:
        ip_address(name)
    except ValueError:
        return False
    return True
