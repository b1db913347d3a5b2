"""The vocabulary of motionrt: skeleton, motion, rotations, kinematics, feature vectors, feet."""

from motionrt._lazy import moved
from motionrt.motion.motion import Motion
from motionrt.motion.skeleton import SMPL24, Skeleton

__all__ = ["SMPL24", "Motion", "Skeleton"]

__getattr__ = moved(__name__, {"RigClip": "motionrt.rigs"})
