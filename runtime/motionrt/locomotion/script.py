"""Scripts: what ``motionrt perform`` plays, a YAML file of a scene, a start and steps (docs/scripts.md)."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path as FilePath

from motionrt.locomotion.actions import Action, Do
from motionrt.locomotion.crowd import SPEED
from motionrt.locomotion.goal_frame import Goal
from motionrt.locomotion.path_following import Pace
from motionrt.locomotion.script_nodes import Node, read_nodes
from motionrt.locomotion.script_scene import SceneSpec, file_beside, read_scene
from motionrt.locomotion.script_steps import read_steps
from motionrt.untrusted.files import as_path

_KEYS = ("scene", "cloud", "start", "speed", "seed", "foot_lock", "steps")


@dataclass(frozen=True)
class Script:
    """A checked script; angles are radians here, degrees in the file.

    Attributes:
        file: where it was read.
        steps: what to do.
        start: where the character stands at first.
        scene: the ground, or None for open ground.
        cloud: file of a semantic point cloud, or None.
        speed: metres per second of the walks.
        seed: of the small movements of held poses.
        foot_lock: whether standing feet are kept still.
    """

    file: FilePath
    steps: tuple[Action, ...]
    start: Goal
    scene: SceneSpec | None = None
    cloud: FilePath | None = None
    speed: float = SPEED
    seed: int = 0
    foot_lock: bool = True

    @classmethod
    def read(cls, file: str | FilePath) -> Script:
        """Read and check a script.

        Raises:
            ScriptError: it cannot be read, or anything in it is unknown, missing or of the wrong kind; the message
                names file, line, step and remedy.
        """
        root = read_nodes(as_path(file))
        found = root.fields(_KEYS, required=("steps",))
        steps = read_steps(found["steps"])
        if "cloud" not in found:
            _check_words(found["steps"], steps)
        return cls(
            file=FilePath(file),
            steps=steps,
            start=_start(found["start"]) if "start" in found else Goal(0.0, 0.0),
            scene=read_scene(found["scene"]) if "scene" in found else None,
            cloud=file_beside(found["cloud"], "cloud: room.ply") if "cloud" in found else None,
            speed=_speed(found["speed"]) if "speed" in found else SPEED,
            seed=found["seed"].whole() if "seed" in found else 0,
            foot_lock=found["foot_lock"].flag() if "foot_lock" in found else True,
        )


def _start(node: Node) -> Goal:
    if isinstance(node.value, list):
        return Goal(*node.place())
    found = node.fields(("at", "heading"), required=("at",))
    return Goal(*found["at"].place(), found["heading"].radians() if "heading" in found else 0.0)


def _speed(node: Node) -> float:
    return node.made(lambda: Pace(speed=node.number("m/s"))).speed


def _check_words(node: Node, steps: tuple[Action, ...]) -> None:
    """Words need things with names."""
    for index, (step, action) in enumerate(zip(node.value, steps, strict=True), 1):
        if isinstance(action, Do):
            raise step.named(f"step {index}").error("'do' needs cloud: FILE, a point cloud with labels")
