"""Clicks in the picture, which are listened to only while they mean something."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


class Clicks:
    """The clicks that one panel waits for.

    Args:
        client: of viser.
        act: gets every click while it listens.
    """

    def __init__(self, client: Any, act: Callable[[Any], None]) -> None:
        self._client, self._act, self._listening = client, act, False

    def listen(self, *, on: bool) -> None:
        """Begin or end to listen."""
        scene = self._client.scene
        if on and not self._listening:
            scene.on_click()(self._clicked)
        elif not on and self._listening:
            scene.remove_click_callback(self._clicked)
        self._listening = on

    def _clicked(self, event: Any) -> None:
        self._act(event)
