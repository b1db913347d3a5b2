"""Anchor poses: inverse kinematics over the pose prior."""

from __future__ import annotations

from motionrt.locomotion.posing.solution import PoseSolution
from motionrt.locomotion.posing.solving import solve_pose

__all__ = ["PoseSolution", "solve_pose"]
