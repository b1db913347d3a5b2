"""What a window may send: uploads up to a limit, as received, and no wish to share the page with the world."""

from __future__ import annotations

from typing import Any

from motionrt.limits import limits

REFUSED = frozenset({"ShareUrlRequest", "ShareUrlDisconnect"})
"""Messages that would let the server open a tunnel to strangers; they are dropped."""

MESSAGE_BYTES = 1 << 20
"""Bytes of a message that is no part of an upload."""

_PART_BYTES = 8 << 20
_PARTS = 100_000
_TOO_BIG, _MALFORMED = 1009, 1007


class Meter:
    """Counts what one window uploads."""

    def __init__(self) -> None:
        self.received = 0

    def complaint(self, raw: object) -> tuple[int, str] | None:
        """The code and the reason with which to close the connection, or None."""
        kind, message = _read(raw)
        if kind is None:
            return _MALFORMED, "a message that cannot be read"
        most = limits().upload_bytes
        if kind == "FileTransferPart":
            self.received += len(raw)  # type: ignore[arg-type]
            if self.received > most or len(raw) > _PART_BYTES:  # type: ignore[arg-type]
                return _TOO_BIG, f"a window may upload {most:,} bytes"
        elif len(raw) > MESSAGE_BYTES:  # type: ignore[arg-type]
            return _TOO_BIG, "a message is too long"
        if kind == "FileTransferStartUpload" and not _is_modest(message, most - self.received):
            return _TOO_BIG, f"a window may upload {most:,} bytes"
        return None


def metered(connection: Any) -> Any:
    """The same connection, whose messages are counted and, some of them, dropped before anybody sees them."""
    receive, meter = connection.recv, Meter()

    async def recv(*arguments: Any, **options: Any) -> Any:
        while True:
            raw = await receive(*arguments, **options)
            complaint = meter.complaint(raw)
            if complaint is not None:
                await connection.close(*complaint)
            elif _read(raw)[0] not in REFUSED:
                return raw

    connection.recv = recv
    return connection


def _read(raw: object) -> tuple[str | None, dict[str, Any]]:
    """The type of a message and the message; None for what is none."""
    import msgspec.msgpack  # comes with viser

    try:
        message: Any = msgspec.msgpack.decode(raw) if isinstance(raw, bytes) else None
    except (msgspec.DecodeError, RecursionError):
        return None, {}
    kind = message.get("type") if isinstance(message, dict) else None
    return (kind, dict(message)) if isinstance(kind, str) else (None, {})


def _is_modest(message: dict[str, Any], left: int) -> bool:
    size, parts, name = message.get("size_bytes"), message.get("part_count"), message.get("filename")
    counted = all(isinstance(value, int) and not isinstance(value, bool) and value >= 0 for value in (size, parts))
    return bool(counted and size <= left and parts <= _PARTS and isinstance(name, str) and len(name) < 1000)  # type: ignore[operator]
