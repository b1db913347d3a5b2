"""Chaining actions: walk, transition in, hold, transition out, walk on  [Continual 3.7].

Between two places WalkNet walks; into a pose and out of it TransNet fills two seconds. A transition out ends in a
stride, so that WalkNet can go on from there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from motionrt.errors import InvalidInputError, MotionRTError
from motionrt.locomotion.actions import Act, Action, Do, Follow, Generate, Lie, Stand, Wait, WalkTo
from motionrt.locomotion.bearings import apart, facing_of, heading_along, place_of
from motionrt.locomotion.character import NEAR, Character, Planner
from motionrt.locomotion.character_models import CharacterModels
from motionrt.locomotion.crowd import FPS
from motionrt.locomotion.goal_frame import Goal
from motionrt.locomotion.lying import lying, seat_keypoints
from motionrt.locomotion.path import Path
from motionrt.locomotion.path_following import Pace, Progress
from motionrt.locomotion.performance import Performance
from motionrt.motion import SMPL24, Motion
from motionrt.motion.skeleton import FloatArray
from motionrt.motion.transforms import TOE_JOINTS
from motionrt.untrusted.arguments import check_flags, check_kind, listed

if TYPE_CHECKING:
    from motionrt.locomotion.words import SemanticCloud

PER_CENT = 100
RESTS = ("pelvis", "left_ankle", "right_ankle", "head")  # joints of somebody who lies that are told of as keypoints
BESIDE = 0.3  # metres from where a pose is taken that the transition into it covers without a step


class Performer:
    """A character on its way through a list of actions.

    Args:
        models: the models.
        start: where it stands at first, or what it did before.
        scene: finds ways round obstacles; without one it walks round the things of the cloud, or else straight.
        cloud: tells what words such as "sofa" mean.
        pace: how it walks.
        seed: of the small movements of held poses.
        progress: told how many per cent of the actions are done.
        generate: makes motions from texts: (text, seconds, seed) -> Motion.
    """

    def __init__(
        self,
        models: CharacterModels,
        start: Goal | Motion,
        scene: Planner | None = None,
        *,
        cloud: SemanticCloud | None = None,
        pace: Pace | None = None,
        seed: int = 0,
        progress: Progress | None = None,
        generate: Callable[[str, float, int], Motion] | None = None,
    ) -> None:
        level = 0.0 if cloud is None else cloud.floor
        if scene is None and cloud is not None:
            from motionrt.locomotion.words.ways import ways_through

            scene = ways_through(cloud)
        self.character = Character(models, start, scene, pace or Pace(), seed, level)
        self.cloud, self._progress, self._generate, self._seed = cloud, progress, generate, seed
        self._surfaces = None if cloud is None else cloud.obstacles()

    def perform(self, actions: Sequence[Action], *, stop: bool = True, foot_lock: bool = True) -> Performance:
        """Do everything, one after the other.

        Args:
            actions: what to do.
            stop: stand at the end of a last walk; otherwise it ends in stride.
            foot_lock: let standing feet stand still.

        Raises:
            PathError: there is no way.
            ReachError: no pose meets the keypoints.
            WalkError: the character got stuck.
            InvalidInputError: no actions, or an instruction that means nothing here.
        """
        check_flags(stop=stop, foot_lock=foot_lock)
        actions = listed(actions, "actions", "actions")
        for action in actions:
            check_kind(action, Action, "each of actions", "a WalkTo, Act, Do ...")
        if not actions:
            raise InvalidInputError("give at least one action")
        for index, action in enumerate(actions):
            following = actions[index + 1] if index + 1 < len(actions) else None
            on = isinstance(following, WalkTo | Follow) or (following is None and not stop)
            try:
                self._do(action, on, self._part(index, len(actions), action.name))
            except MotionRTError as error:
                if len(actions) > 1:
                    error.args = (f"step {index + 1} ('{action.name}'): {error}", *error.args[1:])
                raise
        return self.character.performance(foot_lock=foot_lock, surfaces=self._surfaces)

    def _do(self, action: Action, walks_on: bool, progress: Progress) -> None:
        if not isinstance(action, Wait):
            self.character.rise(action.name)
        if isinstance(action, WalkTo | Follow):
            self._walk(action, walks_on, progress)
        elif isinstance(action, Wait):
            if self.character.moving:
                self.character.stand_here(action.name)
            self.character.hold(action.seconds, action.name)
        elif isinstance(action, Generate):
            self.character.show(self._made(action), action.name)
        elif isinstance(action, Stand):
            self.character.stand_here(action.name)
            self.character.hold(action.hold_s, action.name)
        else:
            meant = self._meant(action) if isinstance(action, Do) else action
            if isinstance(meant, Lie):
                self._lie(meant, progress)
            else:
                self._take_pose(meant, progress)
        progress(1, 1, action.name)

    def _walk(self, action: WalkTo | Follow, walks_on: bool, progress: Progress) -> None:
        character, path = self.character, self._path(action)
        on = walks_on and action.heading is None
        character.go(path, action.name, 0.0 if on else character.braking, progress)
        if on and character.moving:
            return
        facing = action.heading
        if facing is None:
            facing = character.facing if path is None else heading_along(path, path.length)
        character.stop(_end_of(action), facing, action.name)

    def _path(self, action: WalkTo | Follow) -> Path | None:
        if isinstance(action, Follow):
            return self.character.way_along(action.path)
        return self.character.way((action.x, action.z))

    def _take_pose(self, action: Act, progress: Progress) -> None:
        character = self.character
        level = character.terrain.at(_foothold(action), 0.0)
        lowered = {joint: (x, y - level, z) for joint, (x, y, z) in action.keypoints.items()}
        pose = character.models.pose(lowered, action.heading, surfaces=self._surfaces_from(level)).motion
        root, facing = place_of(pose), facing_of(pose)
        gate = action.approach or root
        if apart(root, character.place) > NEAR:
            until = max(0.0, character.braking - apart(gate, root))
            character.go(character.way(gate), action.name, until, progress)
        if not character.moving and BESIDE < apart(gate, character.place) < NEAR:
            character.stop(gate, facing, action.name)
        character.turn(facing, action.name, gate if apart(gate, character.place) < NEAR else None)
        character.into(pose, action.name, level)
        character.hold(action.hold_s, action.name, action.keypoints)

    def _lie(self, action: Lie, progress: Progress) -> None:
        character = self.character
        level = character.terrain.at(action.edge, 0.0)
        at = (action.at[0], action.at[1] - level, action.at[2])
        keypoints, facing, gate = seat_keypoints(at, action.edge, 0.0)
        seat, pose = (
            character.models.pose(keypoints, facing, surfaces=self._surfaces_from(level)).motion,
            lying(character.models.standing, at, action.heading),
        )
        if apart(gate, character.place) > NEAR:
            character.go(character.way(gate), action.name, character.braking, progress)
        character.stop(gate, facing, action.name)
        character.lie(seat, pose, action.name, level)
        joints = pose.positions()[0]
        points = {name: joints[SMPL24.index(name)] + np.array([0.0, level, 0.0]) for name in RESTS}
        character.hold(action.hold_s, action.name, {name: tuple(map(float, point)) for name, point in points.items()})

    def _made(self, action: Generate) -> Motion:
        """The motion of a text, at 30 fps."""
        if self._generate is None:
            raise InvalidInputError(f"'{action.text}' needs a generator: perform it with motionrt.Runtime")
        return self._generate(action.text, action.seconds, self._seed).resample(FPS)

    def _meant(self, action: Do) -> Act | Lie:
        """What an instruction means here."""
        from motionrt.locomotion.words import action_keypoints

        if self.cloud is None:
            raise InvalidInputError(f"'{action.text}' needs a scene with names: give cloud=, a semantic point cloud")
        found = action_keypoints(action.text, self.cloud, self.character.place)
        keypoints = {joint: tuple(float(x) for x in point) for joint, point in found.keypoints.items()}
        if found.bed is not None:
            return Lie(found.bed.at, found.bed.edge, found.bed.heading, action.hold_s, found.name)
        approach = (float(found.approach[0]), float(found.approach[1]))
        return Act(keypoints, found.heading, action.hold_s, approach, found.name)

    def _surfaces_from(self, level: float) -> FloatArray | None:
        """What limbs shall keep out of, seen from ground that is ``level`` metres high."""
        return None if self._surfaces is None else self._surfaces - np.array([0.0, level, 0.0], np.float32)

    def _part(self, index: int, count: int, name: str) -> Progress:
        """Progress of one action of ``count``."""

        def tell(done: int, total: int, _: str) -> None:
            if self._progress is not None:
                self._progress(PER_CENT * (index * total + done) // (total * count), PER_CENT, name)

        return tell if self._progress is not None else _silent


def _foothold(action: Act) -> tuple[float, float]:
    """Where the ground is that a pose stands on: under its feet, else where it is approached from."""
    feet = [point for joint, point in action.keypoints.items() if joint in TOE_JOINTS]
    if action.approach is not None and not feet:
        return action.approach
    x, _, z = np.mean(feet or list(action.keypoints.values()), axis=0)
    return float(x), float(z)


def _end_of(action: WalkTo | Follow) -> tuple[float, float]:
    if isinstance(action, WalkTo):
        return action.x, action.z
    x, z = action.path.points[-1]
    return float(x), float(z)


def _silent(_done: int, _total: int, _name: str) -> None:
    """Nobody listens."""
