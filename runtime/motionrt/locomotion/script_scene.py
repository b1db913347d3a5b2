"""The ground of a script: a file with options, or polygons."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

from motionrt.locomotion.script_nodes import Node
from motionrt.untrusted.files import beside

if TYPE_CHECKING:
    from motionrt.locomotion.scene import Scene

_AGENT = ("radius", "step_height", "max_slope", "head_room", "comfort")
_FILE = ("resolution", "cell", "start", "up", "scale")
_KEYS = ("file", "floor", "obstacles", *_FILE, *_AGENT)

Polygon = tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class SceneSpec:
    """What a script says about its scene.

    Attributes:
        file: a mesh or an occupancy map, or None.
        floor: walkable polygons of (x, z) metres, without a file.
        obstacles: polygons to cut out of them.
        options: of :meth:`motionrt.locomotion.scene.Scene.open`, other than the agent.
        agent: fields of :class:`motionrt.locomotion.scene.Agent`.
    """

    file: FilePath | None = None
    floor: tuple[Polygon, ...] = ()
    obstacles: tuple[Polygon, ...] = ()
    options: Mapping[str, Any] = field(default_factory=dict)
    agent: Mapping[str, float] = field(default_factory=dict)

    def open(self) -> Scene:
        """Read or build the scene; see :class:`motionrt.locomotion.scene.Scene` for the errors."""
        from motionrt.locomotion.scene import Agent, Scene

        agent = Agent(**self.agent)
        if self.file is not None:
            return Scene.open(self.file, agent=agent, **self.options)
        cell = {"cell": self.options["cell"]} if "cell" in self.options else {}
        return Scene.from_polygons(self.floor, self.obstacles, agent=agent, **cell)


def read_scene(node: Node) -> SceneSpec:
    """``scene: FILE``, ``scene: {file: ..., ...}`` or ``scene: {floor: [...], obstacles: [...]}``."""
    if isinstance(node.value, str):
        return SceneSpec(file=_file(node))
    found = node.fields(_KEYS)
    agent = {key: found[key].number() for key in _AGENT if key in found}
    if ("file" in found) == ("floor" in found):
        raise node.error("say either file: (a mesh or a map) or floor: (polygons), one of them")
    if "file" in found:
        if "obstacles" in found:
            raise found["obstacles"].error("obstacles belong to a floor of polygons, not to a file")
        return SceneSpec(file=_file(found["file"]), options=_options(found), agent=agent)
    for key in _FILE:
        if key in found and key != "cell":
            raise found[key].error("belongs to a file, not to a floor of polygons")
    obstacles = _polygons(found["obstacles"]) if "obstacles" in found else ()
    return SceneSpec(floor=_polygons(found["floor"]), obstacles=obstacles, options=_options(found), agent=agent)


def file_beside(node: Node, example: str) -> FilePath:
    """A file, relative to the script, that must exist."""
    path = beside(node.file.parent, node.text(example), lambda reason, _: node.error(reason))
    if not path.is_file():
        raise node.error(f"there is no file {path} (names are relative to the script)")
    return path


def _file(node: Node) -> FilePath:
    return file_beside(node, "scene: warehouse.yaml")


def _options(found: Mapping[str, Node]) -> dict[str, Any]:
    options: dict[str, Any] = {}
    for key in ("resolution", "cell", "scale"):
        if key in found:
            options[key] = found[key].positive("metres")
    if "start" in found:
        node = found["start"]
        options["start"] = node.point("xyz" if isinstance(node.value, list) and len(node.value) == 3 else "xz")
    if "up" in found:
        options["up"] = found["up"].text("up: z")
        if options["up"] not in {"y", "z"}:
            raise found["up"].error(f"expected y or z, found '{options['up']}'")
    return options


def _polygons(node: Node) -> tuple[Polygon, ...]:
    example = "[[[0, 0], [8, 0], [8, 6], [0, 6]]]"
    return tuple(_polygon(item.named(f"{node.name} {i}")) for i, item in enumerate(node.items("polygons", example), 1))


def _polygon(node: Node) -> Polygon:
    corners = node.items("a polygon", "[[0, 0], [8, 0], [8, 6]]")
    if len(corners) < 3:
        raise node.error(f"expected at least 3 corners, as in [[0, 0], [8, 0], [8, 6]]; found {len(corners)}")
    return tuple(corner.named(node.name).place() for corner in corners)
