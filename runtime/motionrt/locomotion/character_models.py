"""The models that move a character, and the poses that they share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

from motionrt.locomotion import starting_poses
from motionrt.locomotion.crowd import NextFrame
from motionrt.locomotion.goal_frame import Goal
from motionrt.locomotion.holding import hold
from motionrt.locomotion.transitions import transition
from motionrt.models.transnet import TransitionModel
from motionrt.models.walknet import WalkModel
from motionrt.motion import Motion

if TYPE_CHECKING:
    import numpy.typing as npt

    from motionrt.locomotion.posing import PoseSolution
    from motionrt.locomotion.posing.body import Prior
    from motionrt.models.sessions import Sessions


TOLERANCE_CM = 5.0  # of keypoints


class CharacterModels(Protocol):
    """What a performance needs of models."""

    @property
    def walk(self) -> NextFrame:
        """WalkNet."""

    @property
    def standing(self) -> Motion:
        """One frame: stands at the origin, facing +Z."""

    @property
    def stride(self) -> Motion:
        """Frames of a steady walk at 30 fps, at least a second; the last one above the origin, heading +Z."""

    def transition(self, seed: Motion, target: Motion, goal: Goal | None = None, *, held: bool = False) -> Motion:
        """60 frames from the end of ``seed`` to ``target``; see :func:`motionrt.locomotion.transitions.transition`."""

    def hold(self, pose: Motion, seconds: float, seed: int) -> Motion:
        """A pose held for some time."""

    def pose(
        self,
        keypoints: Mapping[str, Sequence[float]],
        heading: float | None = None,
        *,
        floor: float | None = 0.0,
        tolerance_cm: float = TOLERANCE_CM,
        surfaces: npt.ArrayLike | None = None,
    ) -> PoseSolution:
        """The pose that meets keypoints; see :func:`motionrt.locomotion.posing.solve_pose`."""


class OnnxCharacterModels:
    """The shipped models; each opens when it is first needed.

    Args:
        sessions: open models.
        variant: which files, as in ``fp32``; by default those that the manifest prefers.
    """

    def __init__(self, sessions: Sessions, variant: str | None = None) -> None:
        self.sessions, self.variant = sessions, variant

    @cached_property
    def walk(self) -> NextFrame:
        """WalkNet."""
        return WalkModel(self.sessions, self.variant)

    @cached_property
    def infill(self) -> TransitionModel:
        """TransNet."""
        return TransitionModel(self.sessions, self.variant)

    @cached_property
    def prior(self) -> Prior:
        """The pose prior."""
        from motionrt.models.pose_prior import PosePrior

        return PosePrior.open(self.sessions, variant=self.variant)

    @cached_property
    def standing(self) -> Motion:
        """One frame: stands at the origin, facing +Z; that of the asset, or else one that the pose prior gives."""
        return starting_poses.standing() or starting_poses.solved_standing(self.prior)

    @cached_property
    def stride(self) -> Motion:
        """Frames of a steady walk; the last one above the origin, heading +Z."""
        return starting_poses.stride()

    def transition(self, seed: Motion, target: Motion, goal: Goal | None = None, *, held: bool = False) -> Motion:
        """See :func:`motionrt.locomotion.transitions.transition`."""
        return transition(self.infill, seed, target, goal, held=held)

    def hold(self, pose: Motion, seconds: float, seed: int) -> Motion:
        """See :func:`motionrt.locomotion.holding.hold`."""
        return hold(pose, seconds, seed)

    def pose(
        self,
        keypoints: Mapping[str, Sequence[float]],
        heading: float | None = None,
        *,
        floor: float | None = 0.0,
        tolerance_cm: float = TOLERANCE_CM,
        surfaces: npt.ArrayLike | None = None,
    ) -> PoseSolution:
        """See :func:`motionrt.locomotion.posing.solve_pose`."""
        from motionrt.locomotion.posing import solve_pose

        return solve_pose(
            keypoints, self.prior, heading=heading, floor=floor, tolerance_cm=tolerance_cm, surfaces=surfaces
        )
