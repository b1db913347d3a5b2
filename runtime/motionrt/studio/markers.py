"""What is drawn on the ground and in the air besides figures: scenes, paths, keypoints, where things begin."""

from __future__ import annotations

from typing import Any

import numpy as np

from motionrt.locomotion import Act, Follow, WalkTo
from motionrt.motion.skeleton import FloatArray
from motionrt.studio import shapes
from motionrt.studio.clips import Colour
from motionrt.studio.draft import Draft, end_of
from motionrt.studio.scenery import Scenery

FLOOR: Colour = (214, 222, 216)
OBSTACLE: Colour = (158, 150, 146)
MESH: Colour = (196, 192, 186)
ROUTE: Colour = (52, 92, 168)
START: Colour = (64, 150, 96)
THINGS: tuple[Colour, ...] = ((176, 126, 92), (120, 138, 168), (188, 160, 96), (110, 156, 120), (168, 116, 136))
_JOINTS: tuple[tuple[str, Colour], ...] = (
    ("hand", (224, 96, 64)),
    ("wrist", (224, 96, 64)),
    ("foot", (40, 140, 150)),
    ("ankle", (40, 140, 150)),
    ("pelvis", (146, 84, 188)),
)
SMALL = 0.75  # of labels
_LIFT = 0.012  # metres above the ground
_FLAT: dict[str, Any] = {"cast_shadow": False, "receive_shadow": False}


def joint_colour(joint: str) -> Colour:
    """The colour of a keypoint."""
    return next((colour for word, colour in _JOINTS if word in joint), (80, 84, 96))


class Markers:
    """The marks of one window.

    Args:
        client: of viser.
    """

    def __init__(self, client: Any) -> None:
        self._client = client
        self._nodes: list[Any] = []
        self._start_wanted = True

    def draw(self, draft: Draft, *, start: bool = True) -> None:
        """The start, if it is wanted, and all steps of a draft, instead of what was drawn before."""
        for node in self._nodes:
            node.remove()
        scene = self._client.scene
        with self._client.atomic():
            turn = (float(np.cos(draft.start.heading / 2)), 0.0, float(np.sin(draft.start.heading / 2)), 0.0)
            place = (draft.start.x, _LIFT, draft.start.z)
            self._nodes = [scene.add_mesh_simple("/draft/start", *shapes.arrow(), color=START, **_FLAT)]
            self._nodes[0].position, self._nodes[0].wxyz = place, turn
            self._start_wanted = self._nodes[0].visible = start
            before = (draft.start.x, draft.start.z)
            for index, action in enumerate(draft.actions):
                self._step(f"/draft/{index}", index + 1, action, before)
                before = end_of(action) or before
            if len(draft.path) == 1:
                self._dot("/draft/first", draft.path[0], "")

    def show(self, *, shown: bool) -> None:
        """Show or hide all marks."""
        for number, node in enumerate(self._nodes):
            node.visible = shown and (number > 0 or self._start_wanted)

    def draw_path(self, points: FloatArray, name: str = "/path") -> Any:
        """A path on the ground, ``(N, 2)`` x and z."""
        return self._client.scene.add_mesh_simple(
            name, *shapes.ribbon(np.asarray(points, np.float32), 0.05, _LIFT), color=ROUTE, opacity=0.8, **_FLAT
        )

    def _step(self, name: str, number: int, action: object, before: tuple[float, float]) -> None:
        if isinstance(action, WalkTo):
            self._link(f"{name}/way", before, (action.x, action.z))
            self._dot(name, (action.x, action.z), f"{number} walk")
        elif isinstance(action, Follow):
            points = action.path.points
            self._link(f"{name}/way", before, (float(points[0, 0]), float(points[0, 1])))
            self._nodes.append(self.draw_path(points, f"{name}/path"))
            self._dot(name, (float(points[-1, 0]), float(points[-1, 1])), f"{number} path")
        elif isinstance(action, Act):
            self._link(f"{name}/way", before, end_of(action) or before)
            self._pose(name, number, action)

    def _pose(self, name: str, number: int, action: Act) -> None:
        scene = self._client.scene
        for joint, point in action.keypoints.items():
            place = tuple(map(float, point))
            ball = scene.add_icosphere(f"{name}/{joint}", 0.045, color=joint_colour(joint), position=place)
            self._nodes.append(ball)
        top = max(action.keypoints.values(), key=lambda point: point[1])
        above = (float(top[0]), float(top[1]) + 0.12, float(top[2]))
        self._nodes.append(
            scene.add_label(
                f"{name}/label",
                f"{number} {action.name}",
                position=above,
                anchor="bottom-center",
                font_screen_scale=SMALL,
            )
        )

    def _dot(self, name: str, place: tuple[float, float], text: str) -> None:
        scene, where = self._client.scene, (place[0], _LIFT + 0.002, place[1])
        dot = scene.add_mesh_simple(f"{name}/dot", *shapes.disc(0.11), color=ROUTE, position=where, **_FLAT)
        self._nodes.append(dot)
        if text:
            label = scene.add_label(
                f"{name}/label",
                text,
                position=(place[0], 0.25, place[1]),
                anchor="bottom-center",
                font_screen_scale=SMALL,
            )
            self._nodes.append(label)

    def _link(self, name: str, a: tuple[float, float], b: tuple[float, float]) -> None:
        """A thin band between two places: the way is found when it is walked."""
        if np.hypot(a[0] - b[0], a[1] - b[1]) > 0.05:
            band = shapes.ribbon(np.array([a, b], dtype=np.float32), 0.018, _LIFT - 0.002)
            self._nodes.append(self._client.scene.add_mesh_simple(name, *band, color=ROUTE, opacity=0.35, **_FLAT))


def draw_scenery(client: Any, scenery: Scenery) -> list[Any]:
    """Floor, obstacles or mesh, and things with names; the nodes that show them."""
    scene, nodes = client.scene, []
    with client.atomic():
        floor = scenery.floor
        if scenery.triangles is not None:
            nodes.append(_mesh(scene, scenery.triangles))
            floor = (np.asarray(floor[0] + [0, 0.02, 0], dtype=np.float32), floor[1])
        nodes.append(
            scene.add_mesh_simple("/scene/floor", *floor, color=FLOOR, opacity=0.7, position=(0, 0.003, 0), **_FLAT)
        )
        if len(scenery.obstacles[0]):
            nodes.append(
                scene.add_mesh_simple("/scene/obstacles", *scenery.obstacles, color=OBSTACLE, flat_shading=True)
            )
        if scenery.cloud is not None and len(scenery.things):
            nodes += _things(scene, scenery)
    return nodes


def _mesh(scene: Any, triangles: FloatArray) -> Any:
    faces = np.arange(3 * len(triangles), dtype=np.uint32).reshape(-1, 3)
    vertices = triangles.reshape(-1, 3)
    return scene.add_mesh_simple("/scene/mesh", vertices, faces, color=MESH, flat_shading=True, side="double")


def _things(scene: Any, scenery: Scenery) -> list[Any]:
    """Small cubes at the points of the cloud, a colour and a name for each thing."""
    cloud, nodes = scenery.cloud, []
    if cloud is None:
        return []
    names = [name for name in cloud.names if name != cloud.floor_label]
    for number, name in enumerate(names):
        points = cloud.of(name)
        cubes = shapes.boxes(points - np.float32(0.045), points + np.float32(0.045))
        colour = THINGS[number % len(THINGS)]
        nodes.append(scene.add_mesh_simple(f"/scene/things/{number}", *cubes, color=colour, flat_shading=True))
        top = points.mean(axis=0) * (1, 0, 1) + (0, points[:, 1].max() + 0.2, 0)
        label = scene.add_label(
            f"/scene/names/{number}", name, position=tuple(map(float, top)), font_screen_scale=SMALL
        )
        nodes.append(label)
    return nodes
