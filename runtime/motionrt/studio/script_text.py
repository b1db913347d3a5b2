"""Drafts as scripts: the YAML that ``motionrt perform`` plays (docs/scripts.md)."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path as FilePath
from typing import Any

from motionrt.locomotion import Act, Action, Do, Follow, Generate, Goal, Lie, Stand, WalkTo
from motionrt.locomotion.script_scene import SceneSpec

HEAD = "# Made in the motionrt studio. Play it with: motionrt perform FILE -o motion.bvh\n"


def script_text(
    actions: Iterable[Action],
    start: Goal,
    scene: SceneSpec | None = None,
    cloud: FilePath | None = None,
    *,
    speed: float = 1.2,
    seed: int = 0,
) -> str:
    """A script as YAML; files are named by their absolute paths, angles are degrees, lengths have millimetres."""
    import yaml

    script: dict[str, Any] = {}
    if scene is not None:
        script["scene"] = _scene(scene)
    if cloud is not None:
        script["cloud"] = str(cloud.resolve())
    script["start"] = {"at": _numbers((start.x, start.z)), "heading": _degrees(start.heading)}
    script["speed"], script["seed"] = round(float(speed), 3), seed
    script["steps"] = [_step(action) for action in actions]
    return HEAD + yaml.safe_dump(script, sort_keys=False, allow_unicode=True, default_flow_style=None, width=110)


def _scene(spec: SceneSpec) -> dict[str, Any]:
    out: dict[str, Any] = {}
    if spec.file is not None:
        out["file"] = str(spec.file.resolve())
    else:
        out["floor"] = [[_numbers(corner) for corner in polygon] for polygon in spec.floor]
        if spec.obstacles:
            out["obstacles"] = [[_numbers(corner) for corner in polygon] for polygon in spec.obstacles]
    options = {key: list(value) if isinstance(value, tuple) else value for key, value in spec.options.items()}
    return {**out, **options, **spec.agent}


def _step(action: Action) -> dict[str, Any]:
    if isinstance(action, WalkTo):
        return {"walk": {"to": _numbers((action.x, action.z)), **_heading(action.heading)}}
    if isinstance(action, Follow):
        return {"walk": {"path": [_numbers(point) for point in action.path.points], **_heading(action.heading)}}
    if isinstance(action, Act):
        return {"act": _act(action)}
    if isinstance(action, Lie):
        return {"lie": _lie(action)}
    if isinstance(action, Do | Generate):
        return {"do": _told(action)}
    return {"stand": float(action.hold_s)} if isinstance(action, Stand) else {"wait": float(action.seconds)}


def _told(action: Do | Generate) -> dict[str, Any]:
    if isinstance(action, Do):
        return {"text": action.text, "hold": float(action.hold_s)}
    return {"generate": action.text, "seconds": float(action.seconds)}


def _act(action: Act) -> dict[str, Any]:
    approach = {} if action.approach is None else {"approach": _numbers(action.approach)}
    keypoints = {joint: _numbers(point) for joint, point in action.keypoints.items()}
    named = {"name": action.name, **approach, **_heading(action.heading)}
    return {**named, "keypoints": keypoints, "hold": float(action.hold_s)}


def _lie(action: Lie) -> dict[str, Any]:
    places = {"name": action.name, "at": _numbers(action.at), "edge": _numbers(action.edge)}
    return {**places, **_heading(action.heading), "hold": float(action.hold_s)}


def _heading(radians: float | None) -> dict[str, float]:
    return {} if radians is None else {"heading": _degrees(radians)}


def _degrees(radians: float) -> float:
    return round(math.degrees(radians), 2)


def _numbers(values: Iterable[float]) -> list[float]:
    return [round(float(value), 3) for value in values]
