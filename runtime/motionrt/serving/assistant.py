"""An MCP server: assistants search, look at, make and convert motion, and get files in a folder of their own."""

from __future__ import annotations

import functools
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

from mcp.server import MCPServer
from mcp.server.mcpserver.exceptions import ToolError

import motionrt
from motionrt.errors import InvalidInputError, MotionRTError
from motionrt.motion import Motion
from motionrt.motion.attributes import measure
from motionrt.retrieval import Filter
from motionrt.serving.desk import FORMATS, Desk, read_motion, written
from motionrt.untrusted.words import shown

INSTRUCTIONS = """Finds and makes 3D human motion. Search first (retrieve); generate when nothing fits. Texts say what
somebody does, as in "a person walks in a circle and waves". Tools that give a motion write a file and say where it is.
"""
_MOST_BYTES = 64 * 2**20


def make_assistant(desk: Desk, folder: Path) -> MCPServer[Any]:
    """The server; ``run()`` speaks with the assistant over stdin and stdout.

    Args:
        desk: the runtime and the galleries.
        folder: where motions are written, and the only place where files are read.
    """
    server: MCPServer[Any] = MCPServer("motionrt", version=motionrt.__version__, instructions=INSTRUCTIONS)
    _add_finding(server, desk)
    _add_files(server, desk, folder)
    _add_making(server, desk, folder)
    return server


def _tool(server: MCPServer[Any]) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """A tool whose errors of motionrt are told to the assistant in their words."""

    def add(function: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(function)
        def tool(*arguments: Any, **options: Any) -> Any:
            try:
                return function(*arguments, **options)
            except MotionRTError as error:
                raise ToolError(str(error)) from error

        return server.tool()(tool)

    return add


def _add_finding(server: MCPServer[Any], desk: Desk) -> None:
    @_tool(server)
    def galleries() -> list[str]:
        """Names of the motion libraries that can be searched; the first is searched where none is named."""
        return list(desk.galleries)

    @_tool(server)
    def retrieve(
        text: str, k: int = 5, gallery: str | None = None, where: str | None = None, max_seconds: float | None = None,
        words: str | None = None,
    ) -> dict[str, Any]:  # fmt: skip
        """Motions of a library that fit a text, best first; `where` is like "turn > 60 and speed < 1.5".

        `words` are those that captions, tags or file names must have, all of them.
        """
        return desk.retrieve(text, k, gallery, filters=Filter(where=where, max_s=max_seconds, text=words))

    @_tool(server)
    def similar(clip: str, k: int = 5, gallery: str | None = None) -> dict[str, Any]:
        """Motions of a library like one of its clips."""
        return desk.similar(clip, k, gallery)


def _add_files(server: MCPServer[Any], desk: Desk, folder: Path) -> None:
    @_tool(server)
    def save_clip(
        clip: str,
        file: str,
        start_s: float | None = None,
        end_s: float | None = None,
        gallery: str | None = None,
    ) -> dict[str, Any]:
        """Write a clip of a library, or its part between two times, as a file (.glb, .bvh, .npz)."""
        return _saved(desk.motion(clip, start_s, end_s, gallery), folder, file)

    @_tool(server)
    def describe(file: str, k: int = 5) -> dict[str, Any]:
        """What a motion file of the folder shows: captions that fit, and how it moves, in numbers."""
        motion = _read(folder, file)
        numbers = measure(motion)
        facts = {"seconds": motion.duration, "turn_degrees": numbers.turn, "mean_speed_m_s": numbers.speed_mean}
        return {"captions": desk.describe(motion, k), **{name: round(float(n), 3) for name, n in facts.items()}}

    @_tool(server)
    def convert(file: str, to: str, fps: float | None = None) -> dict[str, Any]:
        """Write a motion file of the folder as another file there, whose suffix is the format."""
        motion = _read(folder, file)
        return _saved(motion if fps is None else motion.resample(fps), folder, to)


def _add_making(server: MCPServer[Any], desk: Desk, folder: Path) -> None:
    @_tool(server)
    def generate(text: str, file: str, seconds: float = 4.0, seed: int | None = None) -> dict[str, Any]:
        """Make a motion of a text, 0.5 to 10 seconds long, and write it as a file (.glb, .bvh, .npz)."""
        return _saved(desk.runtime.generate(text, seconds, seed=seed), folder, file)

    @_tool(server)
    def compose(texts: list[str], file: str, seconds: float | None = None, seed: int | None = None) -> dict[str, Any]:
        """Make one motion of several actions at once, as in ["walk", "wave the right hand"]."""
        return _saved(desk.compose([{"text": text} for text in texts], seconds, seed), folder, file)

    @_tool(server)
    def walk(x: float, z: float, file: str, speed: float = 1.2) -> dict[str, Any]:
        """Walk from the origin, facing +Z, to a place in metres (x to the left, z ahead), and stand there."""
        return _saved(desk.runtime.walk((x, z), speed=speed).motion, folder, file)


def _place(folder: Path, name: str) -> Path:
    """A file of the folder, by its plain name."""
    if not re.fullmatch(r"[\w. -]{1,120}", name) or name.startswith("."):
        raise InvalidInputError(f"a file is a plain name, as in 'walk.glb', not {shown(name)}")
    return folder / name


def _read(folder: Path, name: str) -> Motion:
    path = _place(folder, name)
    if not path.is_file() or path.stat().st_size > _MOST_BYTES:
        raise InvalidInputError(f"no file {shown(name)} in the folder, or one that is too large")
    return read_motion(name, path.read_bytes())


def _saved(motion: Motion, folder: Path, name: str) -> dict[str, Any]:
    path = _place(folder, name)
    if path.suffix.removeprefix(".") not in FORMATS:
        raise InvalidInputError(f"end the file's name with one of {', '.join(FORMATS)}")
    folder.mkdir(parents=True, exist_ok=True)
    path.write_bytes(written(motion, path.suffix.removeprefix(".")))
    return {"file": str(path), "frames": motion.frames, "fps": motion.fps, "seconds": round(motion.duration, 3)}
