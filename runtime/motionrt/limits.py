"""How much a file or a call may ask for: one table of limits; docs/reliability.md says why.

A limit is raised for a block of code, or for a whole process by the environment variable ``MOTIONRT_LIMITS``::

    with motionrt.limits.raised(joints=5000, pixels=200_000_000):
        motion = motionrt.load("crowd.bvh")

    MOTIONRT_LIMITS="joints=5000,pixels=200000000" motionrt convert crowd.bvh crowd.glb

Threads that are started inside the block have the limits of the process.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, fields, replace
from numbers import Real

from motionrt.errors import InvalidInputError

VARIABLE = "MOTIONRT_LIMITS"


@dataclass(frozen=True)
class Limits:
    """What is refused is more than this.

    Attributes:
        file_bytes: bytes of a file with motion, a mesh or points.
        unpacked_bytes: bytes that a compressed file (``.npz``) unpacks to, or fifty times its size where that is more.
        json_bytes: bytes of a JSON text, or of the JSON part of a ``.glb``.
        yaml_bytes: bytes of a YAML file: script, map, manifest.
        yaml_nodes: values in it, with aliases written out.
        nesting: how deep lists and mappings of YAML and JSON may be nested.
        joints: joints of a skeleton.
        frames: frames of a motion.
        stretched_frames: frames between the keys of an animation, or fifty times as many as it has keys.
        values: frames times joints of an animation, in a file or on a rig.
        stretched_values: the same of an animation that has fewer keys than half of its frames.
        fps: frames per second of a motion; the least rate is :data:`SLOWEST_FPS`.
        text_chars: characters of a text that is searched for, generated or understood.
        motions: motions that one call generates of a text, or results that it gives.
        seconds: seconds that one action holds.
        steps: steps of a script.
        metres: distance of a place, a goal or a root from the origin.
        radians: a heading, either way.
        path_points: points of a path, and corners of a polygon.
        pixels: pixels of a map.
        cells: cells of a scene's grid.
        samples: samples of a mesh's surface.
        stretched_samples: samples of a mesh's surface, or five hundred times as many as it has triangles.
        triangles: triangles of a mesh.
        cloud_points: points of a semantic cloud.
        upload_bytes: bytes that one window of the studio may upload, as received.
        windows: windows of a page at the same time.
    """

    file_bytes: int = 2**30
    unpacked_bytes: int = 256 * 2**20
    json_bytes: int = 64 * 2**20
    yaml_bytes: int = 4 * 2**20
    yaml_nodes: int = 200_000
    nesting: int = 64
    joints: int = 2048
    frames: int = 2_000_000
    stretched_frames: int = 100_000
    values: int = 30_000_000
    stretched_values: int = 8_000_000
    fps: float = 10_000.0
    text_chars: int = 10_000
    motions: int = 1000
    seconds: float = 3600.0
    steps: int = 1000
    metres: float = 100_000.0
    radians: float = 10_000.0
    path_points: int = 100_000
    pixels: int = 25_000_000
    cells: int = 25_000_000
    samples: int = 15_000_000
    stretched_samples: int = 12_000_000
    triangles: int = 5_000_000
    cloud_points: int = 20_000_000
    upload_bytes: int = 64 * 2**20
    windows: int = 8


SLOWEST_FPS = 0.01
"""Frames per second below which a motion is refused."""

DEFAULTS = Limits()
_raised: ContextVar[Limits | None] = ContextVar("motionrt_limits", default=None)


def limits() -> Limits:
    """The limits that hold here and now.

    Raises:
        InvalidInputError: ``MOTIONRT_LIMITS`` cannot be read.
    """
    return _raised.get() or _of_process()


@contextmanager
def raised(**values: float) -> Iterator[Limits]:
    """Other limits inside a ``with`` block, as in ``raised(joints=5000)``; lower ones, too.

    Raises:
        InvalidInputError: a name that is no limit, or a value that is not above 0.
    """
    token = _raised.set(_changed(limits(), values))
    try:
        yield limits()
    finally:
        _raised.reset(token)


def how_to_raise(name: str) -> str:
    """The end of a message: what to do where a limit stands in the way of good work."""
    return f"the limit {name} is {getattr(limits(), name):,}; raise it with {VARIABLE}={name}=NUMBER"


def check_place(what: str, metres: tuple[float, ...], heading: float | None = None) -> None:
    """InvalidInputError unless numbers are finite, and within the limits of places and headings."""
    places = [(number, "metres", limits().metres) for number in metres]
    for number, name, most in [*places, (heading, "radians", limits().radians)]:
        if number is not None and not (isinstance(number, Real) and -1e300 < number < 1e300):
            raise InvalidInputError(f"{what} needs three finite numbers, not {number!r:.60}")
        if number is not None and abs(number) > most:
            raise InvalidInputError(f"{what} is out of range ({number:g}): {how_to_raise(name)}")


def _of_process() -> Limits:
    text = os.environ.get(VARIABLE, "")
    if not text.strip():
        return DEFAULTS
    values = {}
    for part in text.split(","):
        name, _, number = part.partition("=")
        try:
            values[name.strip()] = float(number)
        except ValueError:
            raise InvalidInputError(f"{VARIABLE} must be like joints=5000,pixels=200000000, not {text!r}") from None
    return _changed(DEFAULTS, values)


def _changed(before: Limits, values: dict[str, float]) -> Limits:
    known = {field.name: type(getattr(DEFAULTS, field.name)) for field in fields(Limits)}
    for name, value in values.items():
        if name not in known:
            raise InvalidInputError(f"there is no limit '{name}'; there are: {', '.join(known)}")
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0 < value < float("inf"):
            raise InvalidInputError(f"the limit {name} must be a number above 0, not {value!r}")
    return replace(before, **{name: known[name](value) for name, value in values.items()})
