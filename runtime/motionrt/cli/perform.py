"""``motionrt perform``: a script of walks and actions."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionrt.cli.console import Progress, print_json, print_table
from motionrt.cli.measures import print_measures, rounded
from motionrt.cli.options import add_json, add_models, add_output, command, runtime

if TYPE_CHECKING:
    from motionrt.locomotion import Performance, Segment

HELP = """perform a script: walk, take poses at keypoints, hold them, walk on
Scripts are YAML files of a scene and steps; docs/scripts.md explains them. Angles in scripts are degrees."""


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "perform", run, HELP)
    parser.add_argument("script", type=Path, metavar="SCRIPT", help="the script (.yaml)")
    add_output(parser)
    add_json(parser)
    add_models(parser)


def run(arguments: argparse.Namespace) -> int:
    """Perform, write the motion, print timeline and measures."""
    performance = runtime(arguments).play(arguments.script, progress=Progress())
    path = performance.save(arguments.output)
    if arguments.json:
        print_json(as_json(performance, path))
    else:
        _print(performance)
    return 0


def as_json(performance: Performance, path: Path) -> dict[str, object]:
    """What ``--json`` says of a performance; times are seconds."""
    fps = performance.motion.fps
    return {
        "path": str(path),
        "fps": fps,
        **rounded(performance.measures.as_dict()),
        "segments": [_segment_json(segment, fps) for segment in performance.segments],
        "notes": [note for way in performance.paths for note in way.notes],
    }


def _segment_json(segment: Segment, fps: float) -> dict[str, object]:
    measures = {"transition_end_cm": segment.end_cm, "off_path_m": segment.off_path_m}
    return {
        "kind": segment.kind,
        "name": segment.name,
        "start": round(segment.start / fps, 3),
        "end": round(segment.end / fps, 3),
        "keypoints_cm": rounded(segment.miss_cm),
        **rounded({name: value for name, value in measures.items() if value is not None}),
    }


def _print(performance: Performance) -> None:
    fps = performance.motion.fps
    rows = [[f"{s.start / fps:.1f}", f"{s.end / fps:.1f}", s.kind, s.name, _figure(s)] for s in performance.segments]
    print_table(["start", "end", "part", "step", "measure"], rows, ">><<<")
    print()
    print_measures(performance.measures.as_dict())


def _figure(segment: Segment) -> str:
    """The one figure that tells how well a part was done."""
    if segment.off_path_m is not None:
        return f"{100 * segment.off_path_m:.0f} cm off the path"
    if segment.miss_cm:
        return f"{max(segment.miss_cm.values()):.1f} cm off a keypoint at most"
    return ""
