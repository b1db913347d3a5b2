"""A client of `motionrt serve`, with Python's own library alone.

motionrt serve --gallery my_library      # prints the token
MOTIONRT_TOKEN=... python client.py "a person walks and turns left"
"""

from __future__ import annotations

import json
import os
import sys
import urllib.request
from pathlib import Path
from typing import Any
from urllib.parse import urlencode


class Client:
    """Asks a service; urllib.error.HTTPError carries its words where it refuses."""

    def __init__(self, url: str, token: str) -> None:
        self._url, self._token = url.rstrip("/"), token

    def ask(self, path: str, body: object = None, **query: Any) -> bytes:
        """What the service answers, as bytes."""
        content = body if isinstance(body, bytes) or body is None else json.dumps(body).encode()
        target = f"{self._url}{path}" + (f"?{urlencode(query)}" if query else "")
        headers = {"Authorization": f"Bearer {self._token}", "Content-Type": "application/json"}
        with urllib.request.urlopen(urllib.request.Request(target, content, headers)) as answer:
            return bytes(answer.read())

    def retrieve(self, text: str, **options: Any) -> list[dict[str, Any]]:
        """Hits for a text: clip, start_s, end_s, score."""
        found: dict[str, Any] = json.loads(self.ask("/v1/retrieve", {"text": text, **options}))
        return list(found["hits"])

    def motion(self, hit: dict[str, Any], form: str = "glb") -> bytes:
        """The motion of a hit, as the bytes of a file."""
        return self.ask("/v1/motion", clip=hit["clip"], start_s=hit["start_s"], end_s=hit["end_s"], format=form)

    def generate(self, text: str, **options: Any) -> bytes:
        """A motion of a text, as the bytes of a file."""
        return self.ask("/v1/generate", {"text": text, **options})


def main() -> None:
    """Find, fetch and make."""
    text = sys.argv[1] if len(sys.argv) > 1 else "a person walks in a circle"
    client = Client(os.environ.get("MOTIONRT_URL", "http://127.0.0.1:8321"), os.environ["MOTIONRT_TOKEN"])
    hits = client.retrieve(text, k=3)
    for hit in hits:
        print(f"{hit['score']:.3f}  {hit['clip']}  {hit['start_s']:.1f} to {hit['end_s']:.1f} s")
    if hits:
        Path("found.glb").write_bytes(client.motion(hits[0]))
    Path("made.glb").write_bytes(client.generate(text, seconds=2.0, seed=1))
    print("found.glb and made.glb are written")


if __name__ == "__main__":
    main()
