"""Colours of a picture."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.motion.skeleton import FloatArray
from motionrt.untrusted.arguments import checked_mapping
from motionrt.untrusted.words import shown


@dataclass(frozen=True)
class Colours:
    """Colours as ``#rrggbb``: the left limbs are blue and the right ones red unless said otherwise.

    Raises:
        InvalidInputError: a colour of another form.
    """

    body: str = "#b9c4d2"
    left: str = "#4593e0"
    right: str = "#ec6a58"
    head: str = "#ced7e2"
    face: str = "#4a5667"
    background: str = "#ffffff"
    floor: str = "#f1f4f8"
    grid: str = "#dde3ea"
    shadow: str = "#39465a"
    text: str = "#1f2733"
    faint: str = "#78859a"
    path: str = "#8fa3bd"
    mark: str = "#f0a92e"
    thing: str = "#c2a878"

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not isinstance(value, str) or not re.fullmatch(r"#[0-9a-fA-F]{6}", value):
                raise InvalidInputError(f"the colour {field.name} must be like #3d8bd4, not {value!r}")

    def rgb(self, name: str) -> tuple[int, int, int]:
        """A colour as numbers from 0 to 255."""
        value = getattr(self, name)
        return int(value[1:3], 16), int(value[3:5], 16), int(value[5:7], 16)

    def tones(self, names: tuple[str, ...], fade: float = 0.0) -> FloatArray:
        """``(N, 3)``, 0 to 1, of colours by name, faded into the background by ``fade``."""
        clear = np.array([self.rgb(name) for name in names], np.float32).reshape(-1, 3) / 255
        ground = np.array(self.rgb("floor"), np.float32) / 255
        return np.asarray(clear + fade * (ground - clear), np.float32)


THEMES = {
    "light": Colours(),
    "dark": Colours(
        body="#8b97a8", left="#4c9bea", right="#f0705c", head="#aab5c4", face="#2a3342", background="#161b22",
        floor="#1f2630", grid="#2f3946", shadow="#05070a", text="#e8edf4", faint="#8c99ab", path="#5b7391",
    ),
}  # fmt: skip
"""Colours by the name of a theme."""


def chosen(theme: str, changes: Mapping[str, str] | None) -> Colours:
    """The colours of a theme, some of them changed.

    Raises:
        InvalidInputError: no such theme, or no such colour; the message lists those there are.
    """
    if not isinstance(theme, str) or theme not in THEMES:
        raise InvalidInputError(f"no theme {shown(theme)}: {', '.join(THEMES)}")
    changes = checked_mapping(changes, "colours", "{'left': '#00aa55'}")
    known = [field.name for field in fields(Colours)]
    for name in changes or {}:
        if name not in known:
            raise InvalidInputError(f"no colour '{name}': {', '.join(known)}")
    return replace(THEMES[theme], **dict(changes or {}))
