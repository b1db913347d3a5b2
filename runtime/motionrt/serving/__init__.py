"""The verbs of the runtime over HTTP and for assistants: what ``motionrt serve`` and ``motionrt mcp`` serve."""

from __future__ import annotations

from typing import TYPE_CHECKING

from motionrt._lazy import lazily

if TYPE_CHECKING:
    from motionrt.serving.app import make_app
    from motionrt.serving.assistant import make_assistant
    from motionrt.serving.desk import Desk
    from motionrt.serving.hosting import serve

_HOMES = {
    "app": ("make_app",),
    "assistant": ("make_assistant",),
    "desk": ("Desk",),
    "hosting": ("serve",),
}

__all__ = ["Desk", "make_app", "make_assistant", "serve"]

__getattr__ = lazily(__name__, _HOMES)
