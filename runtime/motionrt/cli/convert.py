"""``motionrt convert``: one motion file into another format."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from motionrt.cli.console import print_json
from motionrt.cli.options import add_json, add_mapping, command, read_mapping

HELP = """convert a motion file (.bvh, .amc, .npz, .glb) to the canonical skeleton (.bvh, .glb, .npz)
Whatever the rig, units and axes of the file, the result has 24 joints and Y up."""


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "convert", run, HELP)
    parser.add_argument("input", type=Path, metavar="IN", help="a motion file (.bvh, .amc, .npz, .glb)")
    parser.add_argument("output", type=Path, metavar="OUT", help="the file to write (.bvh, .glb, .npz)")
    parser.add_argument("--fps", type=float, metavar="N", help="resample to this frame rate")
    parser.add_argument("--units", choices=("cm", "m", "mm", "in"), help="of a .bvh (default: cm)")
    parser.add_argument("--t-pose", action="store_true", help="begin a .bvh with a frame of the T-pose")
    parser.add_argument("--animation", metavar="NAME", help="of a .glb that holds several")
    add_mapping(parser)
    add_json(parser)


def run(arguments: argparse.Namespace) -> int:
    """Convert, and say what was written."""
    from motionrt.formats import load_motion

    motion = load_motion(arguments.input, mapping=read_mapping(arguments.mapping), animation=arguments.animation)
    if arguments.fps is not None:
        motion = motion.resample(arguments.fps)
    path = motion.save(arguments.output, units=arguments.units, t_pose=arguments.t_pose)
    if arguments.json:
        print_json({"path": str(path), "frames": motion.frames, "fps": motion.fps, "seconds": motion.duration})
    else:
        print(f"{path}: {motion.frames} frames, {motion.duration:.2f} s at {motion.fps:g} fps")
    return 0
