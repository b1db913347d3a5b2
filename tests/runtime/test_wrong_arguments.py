"""Every public call with values of the wrong kind in the place of every argument: a typed error, or an answer."""

from __future__ import annotations

import inspect
import itertools
from collections.abc import Callable
from pathlib import Path as FilePath
from typing import Any

import numpy as np
import pytest
from fake_character_models import FakeCharacterModels
from fake_embedder import FakeEmbedder
from motions import walking
from tiny_models import TINY_GENERATORS

import motionrt
from motionrt import formats, library, locomotion
from motionrt.errors import MotionRTError
from motionrt.locomotion import Agent, Goal, Path, Scene, SemanticCloud
from motionrt.locomotion.posing.targets import targets_of
from motionrt.locomotion.transitions import transition
from motionrt.metrics.penetration import checked_surfaces
from motionrt.models.text import checked_texts
from motionrt.retrieval import Gallery
from motionrt.synthesis.composing import Layer
from motionrt.synthesis.constraints import Constraints, Kept, Keyframe, Target, Waypoint
from motionrt.synthesis.plan import Plan

WRONG = [
    None, True, 0, -1, 3, 2.5, float("nan"), float("inf"), -1e300, 10**400, 1j,
    "", "x", "\ud800", "\0", b"x", FilePath("nowhere"), object(), int, lambda: 0,
    [], [1], ["x"], [None], [[1, 2], [3]], (1, 2), {}, {"a": 1}, {1: 2}, {"x"},
    np.zeros(3), np.zeros((2, 2)), np.array(np.nan), np.zeros(0), np.array(["x"]), np.zeros((0, 2)),
]  # fmt: skip
GROUND = [[(-3, -3), (3, -3), (3, 3), (-3, 3)]]
CLIP = walking(12)
LONG = walking(40, fps=30.0)
RIGHT_HAND = {"right_wrist": (0.2, 1.2, 0.4)}

CALLED = {"labeller", "complete", "endpoint", "progress", "derive"}
"""Functions of the caller: what one of them raises is its own error."""

Call = tuple[Callable[..., Any], dict[str, Any]]


@pytest.fixture(scope="module")
def calls(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Call]:
    """Calls by name, each with arguments that are right."""
    folder = tmp_path_factory.mktemp("calls")
    makers = (_of_runtime, _of_generation, _of_motions, _of_galleries, _of_places)
    return {name: call for maker in makers for name, call in maker(folder).items()}


class _Embedder(FakeEmbedder):
    """Checks texts as the real model does."""

    def embed_text(self, texts: list[str]) -> np.ndarray:
        return super().embed_text(checked_texts(texts))


class _Models(FakeCharacterModels):
    """Checks keypoints and poses as the real models do."""

    def transition(self, seed: Any, target: Any, goal: Any = None, *, held: Any = False) -> Any:
        return transition(lambda frames, hidden: frames, seed, target, goal, held=held)

    def pose(
        self, keypoints: Any, heading: Any = None, *, floor: Any = 0.0, tolerance_cm: float = 5.0, surfaces: Any = None
    ) -> Any:
        if surfaces is not None:
            checked_surfaces(surfaces)
        return targets_of(keypoints, heading, floor)


def _of_runtime(folder: FilePath) -> dict[str, Call]:
    runtime = motionrt.Runtime(threads=1)
    runtime.model = _Embedder()  # type: ignore[assignment]  # fills the cached property
    runtime.character_models = _Models()  # type: ignore[misc]
    gallery = Gallery.from_motions([CLIP, LONG], ["a", "b"], FakeEmbedder())
    (folder / "library").mkdir()
    CLIP.save(folder / "library" / "clip.npz")
    runtime.build_gallery(folder / "library", folder / "built")
    layered = {"given": [LONG, LONG], "parts": [["left arm"], ["torso"]]}
    arguments: dict[str, dict[str, Any]] = {
        "retrieve": {"text": "walk", "k": 1, "gallery": gallery},
        "similar": {"motion": LONG, "gallery": gallery},
        "gallery": {"gallery": folder / "built"},
        "describe": {"motion": LONG, "captions": ["a walk"]},
        "captions": {"texts": ["a walk"]},
        "moments": {"text": "walk", "motion": LONG},
        "embed_text": {"text": "walk"},
        "embed_motion": {"motion": LONG},
        "build_gallery": {"folder": folder / "library", "out": folder / "again"},
        "update_gallery": {"gallery": folder / "built"},
        "index_into": {"folder": folder / "library", "address": "none"},
        "plan": {"scene": Scene.from_polygons(GROUND, cell=0.2), "start": (0, 0), "goal": (1, 1)},
        "walk": {"to": (0, 0.5)},
        "walk_together": {"paths": [[(0, 0), (0, 0.4)]]},
        "stream": {"goal": (0, 1)},
        "crowd": {"starts": 2},
        "pose": {"keypoints": RIGHT_HAND},
        "transition": {"before": LONG, "pose": LONG[-1:]},
        "perform": {"scene": None, "actions": [locomotion.Stand(0.1)]},
        "play": {"script": folder / "none.yaml"},
        "layers": layered,
        "compose": layered,
        "body_parts": {"text": "wave"},
    }
    return {
        "Runtime": (motionrt.Runtime, {}),
        **{name: (getattr(runtime, name), arguments[name]) for name in arguments},
    }


def _of_generation(folder: FilePath) -> dict[str, Call]:
    runtime = motionrt.Runtime(TINY_GENERATORS, threads=1)
    one = {"seconds": 0.5, "seed": 1, "steps": 1}
    waypoint, target = Waypoint(0.3, (0, 0)), Target(0.3, "left_wrist", (0, 1, 0))
    made = {"prompts": ["walk"], "folder": folder / "made", "runtime": runtime, "seconds": 0.5, "tries": 1}
    return {
        "generate": (runtime.generate, {"text": "walk", **one}),
        "generate a timeline": (runtime.generate, {"timeline": [("walk", 0.5)], **one}),
        "converse": (runtime.converse, {"text": "walk", "seed": 1, "steps": 1}),
        "Keyframe": (Keyframe, {"time": 0.3, "pose": CLIP}),
        "Waypoint": (Waypoint, {"time": 0.3, "place": (0, 0)}),
        "Target": (Target, {"time": 0.3, "joint": "left_wrist", "place": (0, 1, 0)}),
        "Kept": (Kept, {"motion": CLIP}),
        "Constraints": (Constraints, {"path": [waypoint], "targets": [target]}),
        "library.make": (library.make, made),
        "Plan.read": (Plan.read, {"file": folder / "none.yaml"}),
    }


def _of_motions(folder: FilePath) -> dict[str, Call]:
    bvh, npz, out = CLIP.save(folder / "c.bvh"), CLIP.save(folder / "c.npz"), folder / "out.bvh"
    rig = motionrt.load_target(bvh)
    readers = ("read_amc", "read_asf", "read_bvh", "read_fbx", "read_glb", "read_npy", "animations_of")
    return {
        "Motion": (motionrt.Motion, {"rotations": CLIP.rotations, "root": CLIP.root, "fps": 20.0}),
        "resample": (CLIP.resample, {"fps": 30}),
        "Motion.save": (CLIP.save, {"path": out}),
        "retarget_to": (CLIP.retarget_to, {"rig": rig}),
        "RigMotion.save": (CLIP.retarget_to(rig).save, {"path": out}),
        "load_motion": (motionrt.load_motion, {"path": bvh}),
        "load_rig": (motionrt.load_rig, {"path": bvh}),
        "load_target": (motionrt.load_target, {"path": bvh}),
        "save_motion": (motionrt.save_motion, {"motion": CLIP, "path": out}),
        "motion_file_info": (formats.motion_file_info, {"path": bvh}),
        "read_npz": (formats.read_npz, {"path": npz}),
        "find_motions": (formats.find_motions, {"folder": folder / "none"}),
        "drop_leading_tpose": (formats.drop_leading_tpose, {"clip": motionrt.load_rig(bvh)}),
        **{name: (getattr(formats, name), {"path": bvh}) for name in readers},
        **{f"write_{kind}": (getattr(formats, f"write_{kind}"), {"motion": CLIP, "path": folder / f"o.{kind}"})
           for kind in ("bvh", "glb", "npz")},
        "Layer": (Layer, {"motion": CLIP}),
        "canonicalise": (locomotion.canonicalise, {"motion": CLIP, "goal": Goal(0, 0)}),
        "uncanonicalise": (locomotion.uncanonicalise, {"motion": CLIP, "goal": Goal(0, 0)}),
    }  # fmt: skip


def _of_galleries(folder: FilePath) -> dict[str, Call]:
    gallery = Gallery.from_motions([CLIP, LONG], ["a", "b"], FakeEmbedder())
    saved, query = gallery.save(folder / "gallery"), gallery.embeddings[0].copy()
    return {
        "Gallery.open": (Gallery.open, {"path": folder / "gallery"}),
        "Gallery.from_motions": (Gallery.from_motions, {"motions": [CLIP], "ids": ["a"], "model": FakeEmbedder()}),
        "Gallery.save": (gallery.save, {"folder": folder / "second"}),
        "Gallery.check_model": (gallery.check_model, {"fingerprint": gallery.model.fingerprint, "name": "n"}),
        "Gallery.search": (gallery.search, {"query": query}),
        "Gallery.nearest": (gallery.nearest, {"query": query, "count": 1}),
        "Gallery.prepare": (gallery.prepare, {}),
        "Gallery.motion": (saved.motion, {"hit": "a"}),
        "Gallery.own": (saved.own, {"motion": "a"}),
        "Gallery.append": (saved.append, {"other": gallery}),
        "Gallery.delete": (saved.delete, {"ids": ["none"]}),
        "Gallery.compact": (saved.compact, {"precision": "float32"}),
    }


def _of_places(folder: FilePath) -> dict[str, Call]:
    scene, route = Scene.from_polygons(GROUND, cell=0.2), Path(np.array([[0, 0], [1, 2], [2, 2]], np.float32))
    cloud = SemanticCloud(np.zeros((2, 3), np.float32), np.zeros(2, int), ("sofa",))
    mesh = (np.array([[0, 0, 0], [0, 0, 1], [1, 0, 0]]), [[0, 1, 2]])
    return {
        "Scene.open": (Scene.open, {"path": folder / "none.obj"}),
        "Scene.from_mesh": (Scene.from_mesh, {"source": mesh}),
        "Scene.from_map": (Scene.from_map, {"path": folder / "none.png"}),
        "Scene.from_polygons": (Scene.from_polygons, {"outlines": GROUND, "cell": 0.2}),
        "Scene.from_cells": (Scene.from_cells, {"walkable": np.ones((9, 9), bool), "cell": 0.2}),
        "Scene.plan": (scene.plan, {"start": (0, 0), "goal": (1, 1)}),
        "Scene.random_path": (scene.random_path, {"length": 2.0}),
        **{f"Scene.{name}": (getattr(scene, name), {"xz": (0, 0)}) for name in ("free", "clearance", "height")},
        "Path": (Path, {"points": route.points}),
        "Path.from_csv": (Path.from_csv, {"file": folder / "none.csv"}),
        "Path.at": (route.at, {"s": 0.5}),
        "Path.tangent": (route.tangent, {"s": 0.5}),
        "Path.project": (route.project, {"xz": (0, 0)}),
        "Path.waypoints": (route.waypoints, {"spacing": 1.0}),
        "Path.part": (route.part, {"start": 0.0, "end": 1.0}),
        "Path.rounded": (route.rounded, {}),
        "Script.read": (locomotion.Script.read, {"file": folder / "none.yaml"}),
        "Goal": (Goal, {"x": 0.0, "z": 1.0}),
        "WalkTo": (locomotion.WalkTo, {"x": 0.0, "z": 1.0}),
        "Follow": (locomotion.Follow, {"path": route}),
        "Act": (locomotion.Act, {"keypoints": RIGHT_HAND}),
        "Do": (locomotion.Do, {"text": "wave"}),
        "Stand": (locomotion.Stand, {}),
        "Wait": (locomotion.Wait, {}),
        "Agent": (Agent, {}),
        "SemanticCloud": (SemanticCloud, {"points": cloud.points, "labels": np.zeros(2, int), "names": ("sofa",)}),
        "load_cloud": (locomotion.load_cloud, {"path": folder / "none.csv"}),
        "action_keypoints": (locomotion.action_keypoints, {"instruction": "sit on the sofa", "cloud": cloud}),
    }


def _arguments(call: Callable[..., Any]) -> list[str]:
    several = inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD
    return [name for name, each in inspect.signature(call).parameters.items() if each.kind not in several]


@pytest.mark.filterwarnings("ignore")
def test_a_value_of_the_wrong_kind_gives_a_typed_error_or_an_answer_at_every_door(
    calls: dict[str, Call], monkeypatch: pytest.MonkeyPatch, tmp_path: FilePath
) -> None:
    monkeypatch.chdir(tmp_path)  # "" is this folder, "x" a file in it
    untyped = []
    for name, (call, right) in calls.items():
        for argument, wrong in itertools.product(_arguments(call), WRONG):
            if callable(wrong) and argument in CALLED:
                continue
            try:
                call(**{**right, argument: wrong})
            except MotionRTError:
                pass
            except Exception as error:  # noqa: BLE001  # it is what is looked for
                untyped.append(f"{name}({argument}={wrong!r:.40}): {type(error).__name__}: {error!s:.80}")
    assert untyped == [], "\n".join(untyped)


def test_every_verb_of_the_runtime_is_among_the_calls(calls: dict[str, Call]) -> None:
    verbs = {
        name
        for name, member in inspect.getmembers(motionrt.Runtime)
        if not name.startswith("_") and inspect.isfunction(member)
    }
    assert verbs - set(calls) == set()


@pytest.mark.parametrize("wrong", WRONG, ids=lambda value: f"{value!r:.20}")
@pytest.mark.parametrize(
    "argument", ["seconds", "seed", "n", "temperature", "sampler", "guidance", "steps", "foot_lock"]
)
def test_generation_takes_no_value_of_the_wrong_kind(argument: str, wrong: Any) -> None:
    from motionrt.synthesis.sampling import Sampling

    try:
        Sampling(**{argument: wrong})
    except MotionRTError as error:
        assert argument in str(error)  # noqa: PT017  # an answer is right, too
