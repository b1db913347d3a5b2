"""``motionrt walk``: a character walks to a place or along a path."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionrt.cli.console import Progress, print_json, say
from motionrt.cli.measures import print_measures, rounded
from motionrt.cli.options import add_json, add_models, add_output, command, runtime
from motionrt.cli.parsing import WrongUsageError

if TYPE_CHECKING:
    from motionrt.locomotion import Scene, Walk

HELP = """walk to a place, round what stands in the way, or along a path
Places are x and z in metres on the ground plane, --to 3 -2 or --to 3,-2. The character stands at both ends.
Measures go to stdout: how far it was off the path and off the goal, foot skate, drift."""


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "walk", run, HELP)
    where = parser.add_mutually_exclusive_group(required=True)
    where.add_argument("--to", type=float, nargs=2, metavar=("X", "Z"), help="the place to walk to")
    where.add_argument("--path", type=Path, metavar="CSV", help="a file of two columns, x and z, to walk along")
    add_output(parser)
    parser.add_argument("--scene", type=Path, metavar="FILE", help="mesh (.obj, .ply, .glb) or map (.yaml, .pgm, .png)")
    parser.add_argument("--resolution", type=float, metavar="M", help="metres per pixel of a map without YAML")
    parser.add_argument("--from", dest="start", type=float, nargs=2, metavar=("X", "Z"), help="start (default: 0 0)")
    parser.add_argument("--heading", type=float, metavar="DEG", help="degrees from +Z towards +X to face at the end")
    parser.add_argument("--speed", type=float, default=1.2, metavar="M/S", help="metres per second (default: 1.2)")
    parser.add_argument("--no-foot-lock", action="store_true", help="leave the feet as the model moves them")
    add_json(parser)
    add_models(parser)


def run(arguments: argparse.Namespace) -> int:
    """Walk, write the motion, print the measures."""
    heading = None if arguments.heading is None else math.radians(arguments.heading)
    walk = runtime(arguments).walk(
        arguments.to,
        arguments.path,
        scene=_scene(arguments),
        start=arguments.start,
        heading=heading,
        speed=arguments.speed,
        foot_lock=not arguments.no_foot_lock,
        progress=Progress(),
    )
    path = walk.save(arguments.output)
    for note in walk.path.notes:
        say(f"note: {note}")
    if arguments.json:
        print_json(as_json(walk, path))
    else:
        print_measures(walk.measures.as_dict())
    return 0


def as_json(walk: Walk, path: Path) -> dict[str, object]:
    """What ``--json`` says of a walk."""
    return {
        "path": str(path),
        "fps": walk.motion.fps,
        "path_length_m": round(walk.path.length, 3),
        "waypoints": len(walk.waypoints),
        **rounded(walk.measures.as_dict()),
        "notes": list(walk.path.notes),
    }


def _scene(arguments: argparse.Namespace) -> Scene | None:
    if arguments.scene is None:
        if arguments.resolution is not None:
            raise WrongUsageError("--resolution is for a --scene that is a map without YAML")
        return None
    from motionrt.locomotion import Scene

    return Scene.open(arguments.scene, resolution=arguments.resolution)
