"""A language model behind an OpenAI-compatible endpoint, by the standard library alone."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, field
from http.client import HTTPException
from typing import Any
from urllib.error import HTTPError
from urllib.parse import urlsplit
from urllib.request import Request, urlopen

from motionrt.errors import InvalidInputError
from motionrt.synthesis.parts.failures import LabellingError

Complete = Callable[[str], str]
_SHOWN = 200  # characters of a refusal that an error message quotes


@dataclass(frozen=True)
class Endpoint:
    """Where ``prompt -> answer`` goes: ``POST {url}/chat/completions``. Nothing is sent before it is called.

    Attributes:
        url: base address, such as ``http://localhost:8000/v1``; with or without ``/chat/completions``.
        model: name of the model there.
        api_key: sent as a bearer token where given.
        timeout_s: seconds to wait for an answer.

    Raises:
        InvalidInputError: an address that is not http(s), no model, or a timeout that is not positive.
    """

    url: str
    model: str
    api_key: str | None = field(default=None, repr=False)
    timeout_s: float = 30.0

    def __post_init__(self) -> None:
        if urlsplit(self.url).scheme not in ("http", "https") or not urlsplit(self.url).netloc:
            raise InvalidInputError(
                f"the endpoint must be an http(s) address, such as http://host/v1, not {self.url!r}"
            )
        if not self.model:
            raise InvalidInputError("the endpoint needs the name of a model")
        if not self.timeout_s > 0:
            raise InvalidInputError(f"timeout_s must be positive, not {self.timeout_s}")

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
        try:
            with urlopen(request, timeout=self.timeout_s) as reply:
                return bytes(reply.read())
        except HTTPError as error:
            said = error.read(_SHOWN).decode("utf-8", "replace").strip()
            raise LabellingError(f"{self.address} answered {error.code} {error.reason}: {said}") from error
        except (OSError, HTTPException) as error:  # refused, unknown host, timed out, cut off
            raise LabellingError(f"{self.address} gave no answer within {self.timeout_s:g} s: {error}") from error

    def _content(self, reply: bytes) -> str:
        try:
            answer: Any = json.loads(reply)
            content = answer["choices"][0]["message"]["content"]
        except (ValueError, LookupError, TypeError) as error:
            raise LabellingError(f"{self.address} did not answer as a chat completion: {reply[:_SHOWN]!r}") from error
        if not isinstance(content, str):
            raise LabellingError(f"{self.address} answered without text: {reply[:_SHOWN]!r}")
        return content
