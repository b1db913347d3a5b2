"""``motionrt retarget``: a motion on a character of one's own."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from motionrt.cli.console import print_json, working
from motionrt.cli.options import add_json, add_output, command, read_mapping
from motionrt.cli.reading import INPUTS, add_reading, read_motion, spare_inputs

HELP = """put a motion on your own character (.glb, .bvh)
The result keeps the character's file as it is, hierarchy, names, units, rest pose and (.glb) mesh, skin
and materials, and adds the animation. Names of Mixamo, Unreal, Unity, CMU, Rokoko, Xsens and the like
are known; strides are scaled to the legs, and standing feet stand."""


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "retarget", run, HELP)
    parser.add_argument("clip", type=Path, metavar="CLIP", help=f"the motion ({INPUTS})")
    parser.add_argument("--to", type=Path, required=True, metavar="RIG", help="the character (.glb, .bvh)")
    add_output(parser, "file to write (.glb, .bvh; .fbx where Blender is installed)", (".glb", ".bvh", ".fbx"))
    parser.add_argument(
        "--root-motion",
        nargs="?",
        const=True,
        default=False,
        metavar="JOINT",
        help="travel and heading on the joint above the pelvis (or on JOINT), not on the pelvis",
    )
    parser.add_argument("--fps", type=float, metavar="N", help="resample to this frame rate")
    parser.add_argument("--units", choices=("cm", "m", "mm", "in"), help="of a .bvh made from a .glb (default: cm)")
    parser.add_argument("--t-pose", action="store_true", help="begin a .bvh with a frame of the rest pose")
    parser.add_argument("--skin", metavar="NAME", help="of a RIG .glb that holds several figures")
    add_reading(parser)
    parser.add_argument(
        "--rig-mapping", type=Path, metavar="FILE", help="the same for RIG, smpl24 joint name to joint name in it"
    )
    add_json(parser)


def run(arguments: argparse.Namespace) -> int:
    """Retarget, and say what was written."""
    from motionrt.errors import RigError
    from motionrt.formats import load_target

    rig_mapping = read_mapping(arguments.rig_mapping)
    rig = load_target(arguments.to, skin=arguments.skin)
    motion = read_motion(arguments, arguments.clip)
    if arguments.fps is not None:
        motion = motion.resample(arguments.fps)
    try:
        with working("retargeting"):
            moved = motion.retarget_to(rig, mapping=rig_mapping, root_motion=arguments.root_motion)
    except RigError as error:
        raise RigError(str(error).replace("mapping=", "rig_mapping=")) from error
    spare_inputs(arguments.output, arguments.clip, arguments.to)
    path = moved.save(arguments.output, units=arguments.units, t_pose=arguments.t_pose)
    joints = sum(not name.endswith("_end") for name in moved.names)  # end sites of a BVH are none
    if arguments.json:
        size = {"joints": joints, "units_per_metre": round(moved.units_per_metre, 4)}
        print_json({"path": str(path), "frames": moved.frames, "fps": moved.fps, "seconds": moved.duration, **size})
    else:
        print(f"{path}: {moved.frames} frames, {moved.duration:.2f} s at {moved.fps:g} fps, {joints} joints")
    return 0
