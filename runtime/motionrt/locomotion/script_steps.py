"""The steps of a script: one action each."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from motionrt.limits import how_to_raise, limits
from motionrt.locomotion.actions import HOLD_S, Act, Action, Do, Follow, Generate, Lie, Stand, Wait, WalkTo
from motionrt.locomotion.path import Path
from motionrt.locomotion.script_nodes import Node, unknown
from motionrt.locomotion.script_scene import file_beside
from motionrt.motion import SMPL24


def read_steps(node: Node) -> tuple[Action, ...]:
    """The list below ``steps``."""
    steps = node.items("a list of steps", "- walk: {to: [2, 5]}")
    if not steps:
        raise node.error("give at least one step, as in - walk: {to: [2, 5]}")
    if len(steps) > limits().steps:
        raise node.error(f"{len(steps)} steps are too many: {how_to_raise('steps')}")
    return tuple(_step(step.named(f"step {i}")) for i, step in enumerate(steps, 1))


def _step(node: Node) -> Action:
    known = tuple(_READERS)
    if isinstance(node.value, str):
        raise node.error(f"action {_bare(node.value, known)}")
    if not isinstance(node.value, dict) or len(node.value) != 1:
        raise node.error(f"expected one action, as in walk: {{to: [2, 5]}}; there are: {', '.join(known)}")
    ((name, value),) = node.value.items()
    if name not in _READERS:
        raise Node(None, node.file, value.line, node.name).error(f"unknown action {unknown(name, known)}")
    return node.made(lambda: _READERS[name](value.named(f"{node.name} ({name})")))


def _bare(name: str, known: tuple[str, ...]) -> str:
    if name in known:
        return f"'{name}' stands alone; write it with a colon and what it needs, as in walk: {{to: [2, 5]}}"
    return f"{unknown(name, known)} Write it with a colon and what it needs, as in walk: {{to: [2, 5]}}"


def _walk(node: Node) -> Action:
    found = node.fields(("to", "path", "heading"))
    if ("to" in found) == ("path" in found):
        raise node.error("say where to walk: either to: [x, z] or path:, one of them")
    heading = found["heading"].radians() if "heading" in found else None
    if "to" in found:
        return WalkTo(*found["to"].place(), heading)
    return Follow(_path(found["path"]), heading)


def _path(node: Node) -> Path:
    if isinstance(node.value, str):
        file = file_beside(node, "path: route.csv")
        return node.made(lambda: Path.from_csv(file))
    points = [point.named(node.name).place() for point in node.items("a CSV file or points", "[[0, 0], [2, 5]]")]
    return node.made(lambda: Path(np.array(points, dtype=np.float32).reshape(-1, 2)))


def _act(node: Node) -> Action:
    found = node.fields(("name", "keypoints", "heading", "hold", "approach"), required=("keypoints",))
    return Act(
        keypoints=_keypoints(found["keypoints"]),
        heading=found["heading"].radians() if "heading" in found else None,
        hold_s=_hold(found),
        approach=found["approach"].place() if "approach" in found else None,
        name=found["name"].text("name: sit") if "name" in found else "act",
    )


def _keypoints(node: Node) -> dict[str, tuple[float, ...]]:
    if not isinstance(node.value, dict) or not node.value:
        raise node.error("expected joints and places, as in {right_hand: [0.3, 1.2, 4.0]}")
    found = node.fields(SMPL24.names)
    return {joint: point.point("xyz") for joint, point in found.items()}


def _do(node: Node) -> Action:
    example = "do: sit on the sofa"
    if not isinstance(node.value, dict):
        return Do(node.text(example))
    if "generate" in node.value:
        made = node.fields(("generate", "seconds"), required=("generate",))
        seconds = made["seconds"].seconds() if "seconds" in made else 3.0
        return Generate(made["generate"].text("generate: wave with the right hand"), seconds)
    found = node.fields(("text", "hold"), required=("text",))
    return Do(found["text"].text(example), _hold(found))


def _lie(node: Node) -> Action:
    found = node.fields(("name", "at", "edge", "heading", "hold"), required=("at", "edge", "heading"))
    x, y, z = found["at"].point("xyz")
    name = found["name"].text("name: lie down") if "name" in found else "lie down"
    return Lie((x, y, z), found["edge"].place(), found["heading"].radians(), _hold(found), name)


def _wait(node: Node) -> Action:
    return Wait(node.seconds())


def _stand(node: Node) -> Action:
    return Stand(HOLD_S if node.value is None else node.seconds())


def _hold(found: Mapping[str, Node]) -> float:
    return found["hold"].seconds() if "hold" in found else HOLD_S


_READERS: dict[str, Callable[[Node], Action]] = {
    "walk": _walk,
    "act": _act,
    "lie": _lie,
    "do": _do,
    "stand": _stand,
    "wait": _wait,
    "hold": _wait,
}
