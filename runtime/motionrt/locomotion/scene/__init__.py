"""Scenes: walkable ground from meshes, occupancy maps or polygons, and paths through it."""

from motionrt.locomotion.scene.agent import Agent
from motionrt.locomotion.scene.grid import Grid
from motionrt.locomotion.scene.ros_map import from_map, to_map
from motionrt.locomotion.scene.scene import Scene

__all__ = ["Agent", "Grid", "Scene", "from_map", "to_map"]
