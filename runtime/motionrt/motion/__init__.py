"""The vocabulary of motionrt: skeleton, motion, rotations, kinematics, feature vectors, retargeting."""

from motionrt.motion.motion import Motion
from motionrt.motion.rig import RigClip
from motionrt.motion.skeleton import SMPL24, Skeleton

__all__ = ["SMPL24", "Motion", "RigClip", "Skeleton"]
