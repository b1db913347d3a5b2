"""A language model behind an OpenAI-compatible endpoint, by the standard library alone."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from http.client import HTTPException, HTTPResponse
from numbers import Real
from typing import Any
from urllib.error import HTTPError
from urllib.parse import urlsplit
from urllib.request import Request, urlopen

from motionrt.errors import InvalidInputError, LabellingError

Complete = Callable[[str], str]
_SHOWN = 200  # characters of a refusal that an error message quotes
_LONGEST_S = 3600.0
_MOST = 1 << 20  # bytes of an answer


@dataclass(frozen=True)
class Endpoint:
    """Where ``prompt -> answer`` goes: ``POST {url}/chat/completions``. Nothing is sent before it is called.

    Attributes:
        url: base address, such as ``http://localhost:8000/v1``; with or without ``/chat/completions``.
        model: name of the model there.
        api_key: sent as a bearer token where given.
        timeout_s: seconds to wait for an answer, at most an hour.

    Raises:
        InvalidInputError: an address that is not http(s), no model, a key that no header can hold, or a timeout out
            of range.
    """

    url: str
    model: str
    api_key: str | None = field(default=None, repr=False)
    timeout_s: float = 30.0

    def __post_init__(self) -> None:
        if not _is_address(self.url):
            raise InvalidInputError(
                f"the endpoint must be an http(s) address, such as http://host/v1, not {self.url!r}"
            )
        if not isinstance(self.model, str) or not self.model:
            raise InvalidInputError("the endpoint needs the name of a model")
        if self.api_key is not None and not _is_plain(self.api_key):
            raise InvalidInputError("the API key must be ASCII without spaces or line ends; is all of it the key?")
        if not isinstance(self.timeout_s, Real) or not 0 < self.timeout_s <= _LONGEST_S:
            raise InvalidInputError(f"timeout_s must be positive and at most {_LONGEST_S:g}, not {self.timeout_s!r}")

    def __call__(self, prompt: str) -> str:
        """The model's answer to one message.

        Raises:
            LabellingError: no connection, no answer in time, a refusal, or an answer of another shape.
        """
        return self._content(self._post(prompt))

    @property
    def address(self) -> str:
        """The address that is called."""
        base = self.url.rstrip("/")
        return base if base.endswith("/chat/completions") else base + "/chat/completions"

    def _post(self, prompt: str) -> bytes:
        body = {"model": self.model, "messages": [{"role": "user", "content": prompt}], "temperature": 0}
        headers = {"Content-Type": "application/json"}
        if self.api_key:
            headers["Authorization"] = f"Bearer {self.api_key}"
        request = Request(self.address, json.dumps(body).encode("utf-8"), headers, method="POST")
        until = time.monotonic() + self.timeout_s
        try:
            with urlopen(request, timeout=self.timeout_s) as reply:
                return _read(reply, until)
        except HTTPError as error:
            raise LabellingError(f"{self.address} answered {error.code} {error.reason}: {_said(error)}") from error
        except (OSError, HTTPException, ValueError) as error:  # refused, unknown host, timed out, cut off
            raise LabellingError(
                f"{self.address} gave no answer within {self.timeout_s:g} s: {error}; does it run there?"
            ) from error

    def _content(self, reply: bytes) -> str:
        try:
            answer: Any = json.loads(reply)
            content = answer["choices"][0]["message"]["content"]
        except (ValueError, LookupError, TypeError, RecursionError) as error:
            raise LabellingError(f"{self.address} did not answer as a chat completion: {reply[:_SHOWN]!r}") from error
        if not isinstance(content, str):
            raise LabellingError(f"{self.address} answered without text: {reply[:_SHOWN]!r}")
        return content


def _is_address(url: object) -> bool:
    try:
        parts = urlsplit(url if isinstance(url, str) else "")
        known = parts.scheme in ("http", "https") and bool(parts.hostname) and parts.port != 0
    except ValueError:  # brackets or a port that are none
        return False
    return known and _is_plain(url)


def _is_plain(text: object) -> bool:
    """Whether a line of HTTP can hold it."""
    return isinstance(text, str) and text.isascii() and text.isprintable() and " " not in text


def _read(reply: HTTPResponse, until: float) -> bytes:
    """The body, which a server may send drop by drop, or without end."""
    found = b""
    while piece := reply.read1(1 << 16):
        found += piece
        if time.monotonic() > until:
            raise TimeoutError("the answer did not end in time")
        if len(found) > _MOST:
            raise HTTPException(f"the answer is longer than {_MOST} bytes")
    if reply.length:
        raise HTTPException(f"the answer was cut off, {reply.length} bytes are missing")
    return found


def _said(error: HTTPError) -> str:
    try:
        return error.read(_SHOWN).decode("utf-8", "replace").strip()
    except (OSError, HTTPException):
        return ""
