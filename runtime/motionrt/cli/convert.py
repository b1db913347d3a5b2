"""``motionrt convert``: one motion file into another format."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from motionrt.cli.console import print_json
from motionrt.cli.options import add_json, add_mapping, command, read_mapping

HELP = """convert a motion file (.bvh, .amc, .npz) to the canonical skeleton (.bvh, .npz)
Whatever the rig, units and axes of the file, the result has 24 joints and Y up."""


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "convert", run, HELP)
    parser.add_argument("input", type=Path, metavar="IN", help="a motion file (.bvh, .amc, .npz)")
    parser.add_argument("output", type=Path, metavar="OUT", help="the file to write (.bvh, .npz)")
    parser.add_argument("--fps", type=float, metavar="N", help="resample to this frame rate")
    add_mapping(parser)
    add_json(parser)


def run(arguments: argparse.Namespace) -> int:
    """Convert, and say what was written."""
    from motionrt.formats import load_motion

    motion = load_motion(arguments.input, mapping=read_mapping(arguments.mapping))
    if arguments.fps is not None:
        motion = motion.resample(arguments.fps)
    path = motion.save(arguments.output)
    if arguments.json:
        print_json({"path": str(path), "frames": motion.frames, "fps": motion.fps, "seconds": motion.duration})
    else:
        print(f"{path}: {motion.frames} frames, {motion.duration:.2f} s at {motion.fps:g} fps")
    return 0
