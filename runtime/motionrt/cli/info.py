"""``motionrt info``: what a motion file holds, and how it is understood."""

from __future__ import annotations

import argparse
from dataclasses import asdict
from pathlib import Path
from typing import Any

from motionrt.cli.console import print_json
from motionrt.cli.options import add_json, command
from motionrt.cli.reading import INPUTS, add_reading, in_options, reading

NOT_A_PERSON = 1
HELP = """show what a motion file holds and how it is understood
Rig, joints, axes, unit, rate, duration, height, the joints that play the parts of the body, and the angle
between the limbs of the file and of what is read from it. Exit code 1 if it is not the motion of a person."""


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "info", run, HELP)
    parser.add_argument("input", type=Path, metavar="FILE", help=f"a motion file ({INPUTS})")
    add_reading(parser)
    add_json(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print the facts."""
    from motionrt.formats import animations_of, motion_file_info

    options = reading(arguments)
    several = animations_of(arguments.input) if options["animation"] is None else []
    if several:
        options["animation"] = several[0]
    info = motion_file_info(arguments.input, **options)
    facts = {**asdict(info), "path": str(info.path), "mapping": dict(info.mapping), "animations": several}
    if arguments.json:
        print_json(facts)
    else:
        _print(facts)
    return 0 if info.reason is None else NOT_A_PERSON


def _print(facts: dict[str, Any]) -> None:
    unit = "unknown" if facts["metres_per_unit"] is None else f"{facts['metres_per_unit']:.6g} m"
    lines = [
        ("file", facts["path"]),
        ("rig", f"{facts['kind']}, {facts['joints']} joints"),
        ("axes", f"{facts['up']} up, unit {unit}"),
        ("motion", f"{facts['frames']} frames, {facts['seconds']:.2f} s at {facts['fps']:g} fps"),
    ]
    if facts["leading_pose"]:
        lines.append(("", f"after {facts['leading_pose']} frames of a calibration pose"))
    if facts["animations"]:
        lines.append(("", f"the first of {len(facts['animations'])} animations: {', '.join(facts['animations'])}"))
    if facts["reason"] is None:
        lines += [("height", f"{facts['height']:.2f} m"), ("limbs", f"{facts['limb_error_degrees']:.2f} degrees off")]
        lines += [
            ("mapping" if not i else "", f"{role}: {name}") for i, (role, name) in enumerate(facts["mapping"].items())
        ]
    else:
        lines.append(("not read", in_options(facts["reason"])))
    lines += [("warning", note) for note in facts["warnings"]]
    for name, text in lines:
        print(f"{name:9}{text}")
