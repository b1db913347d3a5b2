"""A timeline of texts out of the scene's markers, and a path out of a curve."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy
import numpy as np

from .installing import InstallError

if TYPE_CHECKING:
    from motionrt import Goal, Motion
    from motionrt.synthesis.constraints import Constraints

_LAST_S = 3.0  # that the last text holds where no marker ends it
_AHEAD = 0.3  # metres along the path that tell which way it begins
_APART_S = 0.5  # between two places of the path


def of_markers(scene: bpy.types.Scene, rate: float) -> tuple[int, list[dict[str, Any]]]:
    """The frame of the first marker, and the texts of all with their seconds from there.

    A marker called ``end`` ends the text before it.

    Raises:
        InstallError: there is none with a name of its own.
    """
    marks = sorted((marker.frame, marker.name.strip()) for marker in scene.timeline_markers)
    texts = [mark for mark in marks if mark[1] and mark[1].lower() != "end"]
    if not texts:
        raise InstallError("set markers on the timeline (M) and name them what happens: walk forward, sit down, end")
    first, rows = texts[0][0], []
    for frame, name in texts:
        after = min((other for other, _ in marks if other > frame), default=frame + round(_LAST_S * rate))
        rows.append({"text": name, "from": (frame - first) / rate, "to": (after - first) / rate})
    return first, rows


def along(points: list[tuple[float, float]], seconds: float) -> tuple[Constraints | None, Goal]:
    """What keeps a motion to points ``(x, z)``, evenly in time, and where it is to be put afterwards.

    Generated motion begins at the origin and faces +Z, so the path is seen from its start; no points keep nothing.
    """
    from motionrt import Goal
    from motionrt.synthesis.constraints import Constraints, Waypoint

    if not points:
        return None, Goal(0.0, 0.0)
    line = np.array(points)
    way = np.append(0, np.cumsum(np.hypot(*np.diff(line, axis=0).T)))
    ahead = [np.interp(min(_AHEAD, way[-1]), way, line[:, axis]) for axis in (0, 1)] - line[0]
    start = Goal(*map(float, line[0]), float(np.arctan2(*ahead)))
    cosine, sine = np.cos(start.heading), np.sin(start.heading)
    line = (line - line[0]) @ np.array([[cosine, sine], [-sine, cosine]])
    times = np.linspace(0, seconds - 0.05, max(2, round(seconds / _APART_S) + 1))
    places = [np.interp(times / times[-1] * way[-1], way, line[:, axis]) for axis in (0, 1)]
    marks = [Waypoint(float(t), (float(x), float(z))) for t, x, z in zip(times, *places, strict=True)]
    return Constraints(path=marks), start


def placed(motion: Motion, start: Goal) -> Motion:
    """A motion that begins at the origin, put where it is to begin."""
    from motionrt.locomotion.goal_frame import uncanonicalise

    return uncanonicalise(motion, start)
