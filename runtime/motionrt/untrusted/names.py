"""Names of files made of foreign words: such that every system takes them, Windows among them."""

from __future__ import annotations

import re

_DEVICES = {"con", "prn", "aux", "nul", "conin$", "conout$"} | {
    f"{port}{number}" for port in ("com", "lpt") for number in "0123456789¹²³"
}
"""What Windows takes for a device, with any suffix, in any case."""


def plain_stem(text: str, most: int = 80) -> str:
    """``text`` as the stem of a file's name: letters, digits, ``_``, ``-`` and inner dots, at most ``most`` bytes.

    It is empty where nothing of the text is left, begins with no dot, ends with none, and is the name of no device.
    """
    plain = re.sub(r"[^\w.-]+", "_", text).strip("._")
    plain = plain.encode()[:most].decode(errors="ignore").rstrip("._")
    return f"_{plain}" if plain.split(".")[0].lower() in _DEVICES else plain
