"""Handles that move the keypoints of a pose."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from motionrt.locomotion import Act
from motionrt.studio.postures import Point


class Gizmos:
    """Handles of one window.

    Args:
        client: of viser.
        dragged: a guarded callback; gets a :class:`Dragged`.
    """

    def __init__(self, client: Any, dragged: Callable[[Any], None]) -> None:
        self._client, self._dragged = client, dragged
        self._nodes: list[Any] = []
        self._shown: tuple[int, tuple[str, ...]] | None = None

    def show(self, index: int, step: Act | None) -> None:
        """Handles at the keypoints of a step, or none."""
        wanted = None if step is None else (index, tuple(step.keypoints))
        if step is None or wanted != self._shown:
            for node in self._nodes:
                node.remove()
            self._nodes = []
        if step is not None:
            if wanted != self._shown:
                self._nodes = [self._handle(index, joint) for joint in step.keypoints]
            for node, point in zip(self._nodes, step.keypoints.values(), strict=True):
                node.position = tuple(map(float, point))
        self._shown = wanted

    def _handle(self, index: int, joint: str) -> Any:
        node = self._client.scene.add_transform_controls(
            f"/gizmos/{joint}", scale=0.28, disable_rotations=True, line_width=3.0, depth_test=False
        )

        def ended(event: Any) -> None:
            x, y, z = (round(float(value), 3) for value in node.position)
            self._dragged(Dragged(event.client_id, index, joint, (x, y, z)))

        node.on_drag_end(ended)
        return node


class Dragged:
    """A keypoint was put somewhere else.

    Args:
        client_id: of the window.
        index: of the step.
        joint: which keypoint.
        point: where it is now, metres.
    """

    def __init__(self, client_id: int, index: int, joint: str, point: Point) -> None:
        self.client_id, self.index, self.joint, self.point = client_id, index, joint, point
