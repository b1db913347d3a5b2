"""The service that moves characters: plan, walk, stream, crowd, pose, transition, perform, play."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

from motionrt.locomotion.crowd import SPEED
from motionrt.services.service import Service

if TYPE_CHECKING:
    import numpy.typing as npt

    from motionrt.locomotion.actions import Action
    from motionrt.locomotion.arguments import PathLikes, SceneLike, StartLike
    from motionrt.locomotion.character_models import CharacterModels
    from motionrt.locomotion.crowd import Crowd
    from motionrt.locomotion.goal_frame import Goal
    from motionrt.locomotion.path import Path
    from motionrt.locomotion.path_following import Progress
    from motionrt.locomotion.performance import Performance
    from motionrt.locomotion.posing import PoseSolution
    from motionrt.locomotion.script import Script
    from motionrt.locomotion.streaming import Stream
    from motionrt.locomotion.walk import Walk
    from motionrt.locomotion.words import SemanticCloud
    from motionrt.motion import Motion


class Locomotion(Service):
    """Walk anywhere, act there; its arguments are those of :class:`motionrt.Runtime`."""

    @cached_property
    def character_models(self) -> CharacterModels:
        """WalkNet, TransNet and the pose prior; each opens when it is first needed."""
        from motionrt.locomotion.character_models import OnnxCharacterModels

        return OnnxCharacterModels(self.sessions, self._variant)

    @property
    def players(self) -> CharacterModels:
        """The former name of :attr:`character_models`; deprecated."""
        warnings.warn("Runtime.players is now Runtime.character_models", DeprecationWarning, stacklevel=2)
        return self.character_models

    def plan(self, scene: SceneLike, start: Sequence[float], goal: Sequence[float]) -> Path:
        """A path through a scene, or its file, between two places (x, z) in metres.

        Raises:
            PathError: there is no way; the message says what blocks it.
        """
        from motionrt.locomotion.arguments import as_place, opened_scene

        return opened_scene(scene).plan(as_place(start, "a start"), as_place(goal, "a goal"))

    def walk(
        self,
        to: Sequence[float] | None = None,
        path: PathLikes | None = None,
        *,
        scene: SceneLike | None = None,
        start: StartLike | None = None,
        heading: float | None = None,
        speed: float = SPEED,
        stop: bool = True,
        foot_lock: bool = True,
        seed: int = 0,
        progress: Progress | None = None,
    ) -> Walk:
        """Walk to a place or along a path.

        Args:
            to: (x, z) metres to walk to: round the obstacles of ``scene``, or straight.
            path: instead of ``to``: a path, its CSV file or its points ``(N, 2)``.
            scene: a scene or its file.
            start: where to begin, standing: (x, z), (x, z, heading) or a Goal; or a motion at 30 fps to go on from, of
                which the walk is then the continuation. By default the start of the path, or the origin.
            heading: radians from +Z towards +X to face at the end; by default along the path.
            speed: metres per second.
            stop: stand at the end; otherwise the walk ends in stride.
            foot_lock: let standing feet stand still.
            seed: of the small movements while standing.
            progress: told every second of the walk (metres done, metres of all, words).

        Raises:
            PathError: there is no way.
            WalkError: the character got stuck.
            InvalidInputError: both or neither of ``to`` and ``path``, or anything of the wrong kind.
        """
        from motionrt.locomotion.arguments import as_scene
        from motionrt.locomotion.path_following import Pace
        from motionrt.locomotion.walk import run_walks, walk_request

        planner = as_scene(scene)
        asked = walk_request(start, to, path, heading, planner)
        pace = Pace(speed=speed)
        return run_walks(
            self.character_models,
            [asked],
            planner,
            pace=pace,
            stop=stop,
            foot_lock=foot_lock,
            seed=seed,
            progress=progress,
        )[0]

    def walk_together(
        self,
        paths: Sequence[PathLikes],
        *,
        starts: Sequence[StartLike | None] | None = None,
        speed: float = SPEED,
        stop: bool = True,
        foot_lock: bool = True,
        seed: int = 0,
        progress: Progress | None = None,
    ) -> list[Walk]:
        """Many characters, each along its path; one call of WalkNet moves all of them by one frame.

        Arguments and errors are those of :meth:`walk`; InvalidInputError, too, for no paths, or not one start for each.
        """
        from motionrt.errors import InvalidInputError
        from motionrt.locomotion.path_following import Pace
        from motionrt.locomotion.walk import run_walks, walk_request
        from motionrt.untrusted.arguments import listed

        paths = listed(paths, "paths", "paths")
        begins = listed(starts, "starts", "starts") if starts is not None else [None] * len(paths)
        if not paths or len(begins) != len(paths):
            raise InvalidInputError(f"give at least one path and a start for each: {len(begins)} for {len(paths)}")
        asked = [walk_request(start, path=path) for start, path in zip(begins, paths, strict=True)]
        pace = Pace(speed=speed)
        return run_walks(
            self.character_models, asked, pace=pace, stop=stop, foot_lock=foot_lock, seed=seed, progress=progress
        )

    def stream(
        self,
        goal: Goal | Sequence[float],
        *,
        start: StartLike | None = None,
        speed: float = SPEED,
        foot_lock: bool = True,
        seed: int = 0,
    ) -> Stream:
        """A character for a game's loop: one frame at 30 fps after the other, for ever.

        ``next`` gives the next frame, a :class:`Motion` of one; ``send(Goal(x, z, heading))`` gives it, too, on the way
        to a new goal; ``steer((vx, vz), facing)`` follows a stick. Goals may lie anywhere and change at any time. At
        its goal the character stands until it gets another.
        """
        from motionrt.locomotion.arguments import as_goal, as_start
        from motionrt.locomotion.streaming import stream

        return stream(
            self.character_models, as_start(start), as_goal(goal), speed=speed, foot_lock=foot_lock, seed=seed
        )

    def crowd(self, starts: int | Sequence[Goal | Sequence[float]]) -> Crowd:
        """Walking characters that :meth:`Crowd.step` moves by one frame, all in one call of WalkNet.

        Args:
            starts: where each is and which way it walks, (x, z, heading); or how many, who then walk abreast along +Z.
        """
        from motionrt.locomotion.crowd_start import crowd

        return crowd(self.character_models, starts)

    def pose(
        self,
        keypoints: Mapping[str, Sequence[float]],
        heading: float | None = None,
        *,
        floor: float | None = 0.0,
        tolerance_cm: float = 5.0,
        surfaces: npt.ArrayLike | None = None,
    ) -> PoseSolution:
        """The pose that meets keypoints; see :func:`motionrt.locomotion.posing.solve_pose`.

        Args:
            keypoints: ``{joint of smpl24: (x, y, z) metres}``.
            heading: radians from +Z towards +X that the body should face; by default what the keypoints suggest.
            floor: height of the ground, metres; None for none.
            tolerance_cm: how far any keypoint may be missed.
            surfaces: points ``(N, 3)`` on everything that limbs shall keep out of, metres, without the ground.

        Raises:
            ReachError: no pose does; the message says by how many centimetres each keypoint is missed.
        """
        return self.character_models.pose(keypoints, heading, floor=floor, tolerance_cm=tolerance_cm, surfaces=surfaces)

    def transition(self, before: Motion, pose: Motion, goal: Goal | None = None, *, held: bool = False) -> Motion:
        """The two seconds (60 frames, 30 fps) that lead from the end of a motion to a pose, which is their last frame.

        Args:
            before: what the character did; its last 60 frames count.
            pose: one frame, or up to 20 frames of a motion that is to go on from there.
            goal: where the pose shall stand instead.
            held: the pose will be held, so that the last frames rest in it.
        """
        return self.character_models.transition(before, pose, goal, held=held)

    def perform(
        self,
        scene: SceneLike | None,
        actions: Sequence[Action],
        *,
        cloud: SemanticCloud | str | FilePath | None = None,
        start: StartLike | None = None,
        speed: float = SPEED,
        stop: bool = True,
        foot_lock: bool = True,
        seed: int | None = None,
        progress: Progress | None = None,
    ) -> Performance:
        """Do one thing after the other: walk, take a pose, hold it, walk on.

        Args:
            scene: a scene or its file; None for open ground.
            actions: values of :mod:`motionrt.locomotion.actions`: WalkTo, Follow, Act, Lie, Do, Generate, Stand, Wait.
            cloud: a semantic point cloud or its file, for ``Do("sit on the sofa")``.
            start: where to begin, standing, or a motion to go on from; as for :meth:`walk`.
            speed: metres per second.
            stop: stand after a last walk; otherwise it ends in stride.
            foot_lock: let standing feet stand still.
            seed: of the small movements of held poses; None is 0, so the same call gives the same motion.
            progress: told how many per cent are done, and of what.

        Raises:
            PathError, ReachError, WalkError, InvalidInputError: an action that cannot be done; the message says which.
        """
        from motionrt.locomotion.arguments import as_cloud, as_scene, as_start
        from motionrt.locomotion.path_following import Pace
        from motionrt.locomotion.performing import Performer
        from motionrt.untrusted.arguments import check_functions, checked_whole

        check_functions(progress=progress)
        performer = Performer(
            self.character_models,
            as_start(start),
            as_scene(scene),
            cloud=as_cloud(cloud),
            pace=Pace(speed=speed),
            seed=0 if seed is None else checked_whole(seed, "seed", 0),
            progress=progress,
            generate=self._text_to_motion,
        )
        return performer.perform(actions, stop=stop, foot_lock=foot_lock)

    @property
    def _text_to_motion(self) -> Callable[[str, float, int], Motion] | None:
        """(text, seconds, seed) -> motion, where this object generates, too."""
        made = getattr(self, "generate", None)
        return None if made is None else lambda text, seconds, seed: made(text, seconds, seed=seed)

    def play(self, script: Script | str | FilePath, *, progress: Progress | None = None) -> Performance:
        """Perform a script, or its file (docs/scripts.md); errors as for :meth:`perform`, and ScriptError."""
        from motionrt.locomotion.script import Script

        read = script if isinstance(script, Script) else Script.read(script)
        return self.perform(
            read.scene.open() if read.scene else None,
            read.steps,
            cloud=read.cloud,
            start=read.start,
            speed=read.speed,
            foot_lock=read.foot_lock,
            seed=read.seed,
            progress=progress,
        )
