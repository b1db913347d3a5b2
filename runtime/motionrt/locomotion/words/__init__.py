"""Keypoints from words: an instruction and a semantic point cloud give where hands, feet and pelvis go."""

from __future__ import annotations

from motionrt.locomotion.words.actions import ActionKeypoints, action_keypoints
from motionrt.locomotion.words.cloud import SemanticCloud
from motionrt.locomotion.words.instruction import Instruction, parse_instruction
from motionrt.locomotion.words.reading import load_cloud

__all__ = ["ActionKeypoints", "Instruction", "SemanticCloud", "action_keypoints", "load_cloud", "parse_instruction"]
