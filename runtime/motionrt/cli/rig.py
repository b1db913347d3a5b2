"""``motionrt rig``: how a character's rig is understood, and ``motionrt certify``: how well motions arrive on it."""

from __future__ import annotations

import argparse
import json
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionrt.cli.console import print_json, print_table, working
from motionrt.cli.options import add_json, add_mapping, command, read_mapping

if TYPE_CHECKING:
    from motionrt.rigs.certify import Certificate, ProbeResult

FAILED = 1
MAP = """write a draft of the mapping of a rig (YAML), to be corrected, kept and shared
Give it back with --mapping (motions) or --rig-mapping (characters). With --json it also says how the joints
are turned against ours, and how well the rig is certified: what a page needs to put motions on it itself."""
CERTIFY = """put probe motions on a character and measure what arrives
Hands, feet and limbs, twist, flips, ground contact, hip height, sides; which joints are driven and which
stay. Gates: 95th percentiles within 2 cm (at human size) and 5 degrees, no flip; exit code 1 if one fails."""


def add(commands: Any) -> None:
    """Add the commands."""
    group = commands.add_parser("rig", help="look at a character's rig")
    parts = group.add_subparsers(title="commands", metavar="COMMAND", required=True)
    mapper = command(parts, "map", run_map, MAP)
    mapper.add_argument("-o", "--output", type=Path, metavar="FILE", help="file to write (default: print it)")
    certifier = command(commands, "certify", run_certify, CERTIFY)
    for parser in (mapper, certifier):
        parser.add_argument("rig", type=Path, metavar="RIG", help="the character (.glb, .gltf, .vrm, .fbx, .bvh)")
        parser.add_argument("--skin", metavar="NAME", help="of a .glb that holds several figures")
        add_mapping(parser)
    add_json(certifier)
    mapper.add_argument("--json", action="store_true", help="for programs, with alignments and what certify says")


def run_map(arguments: argparse.Namespace) -> int:
    """Draft the mapping."""
    from motionrt.formats import load_target
    from motionrt.formats.atomic import write_bytes
    from motionrt.rigs.certified import certified_mapping
    from motionrt.rigs.mapping import draft_mapping, mapping_text, save_mapping

    rig, given = load_target(arguments.rig, skin=arguments.skin), read_mapping(arguments.mapping)
    if arguments.json:
        with working("certifying"):
            found = certified_mapping(rig, mapping=given)
        if arguments.output is None:
            print_json(found)
        else:
            content = json.dumps(found, indent=2, ensure_ascii=False).encode()
            print(f"{write_bytes(arguments.output, content)}: {len(found['mapping'])} joints")
        return 0
    mapping = draft_mapping(rig.clip, given)
    if arguments.output is None:
        print(mapping_text(mapping), end="")
    else:
        print(f"{save_mapping(mapping, arguments.output)}: {len(mapping)} joints")
    return 0


def run_certify(arguments: argparse.Namespace) -> int:
    """Measure, print, and tell by the exit code."""
    from motionrt.formats import load_target
    from motionrt.rigs.certify import certify

    rig = load_target(arguments.rig, skin=arguments.skin)
    with working("certifying"):
        result = certify(rig, mapping=read_mapping(arguments.mapping))
    if arguments.json:
        print_json(facts(result))
    else:
        _print(result)
    return 0 if result.passes else FAILED


def facts(result: Certificate) -> dict[str, Any]:
    """What ``--json`` says."""
    probes = [{**asdict(probe), "passes": probe.passes} for probe in result.probes]
    return {**asdict(result), "mapping": dict(result.mapping), "probes": probes, "passes": result.passes}


def _print(result: Certificate) -> None:
    header = ["probe", "hands cm", "feet cm", "limbs", "twist", "ground cm", "flips", ""]
    rows = [_row(probe) for probe in result.probes]
    print_table(header, rows, "<>>>>>><")
    print(f"hips at {result.hip_height:.2f} of the probe's height; left is {'left' if result.sides else 'NOT LEFT'}")
    print(f"driven: {len(result.driven)} joints; at rest: {', '.join(result.still) or 'none'}")
    print("certified" if result.passes else "not certified")


def _row(probe: ProbeResult) -> list[str]:
    numbers = (probe.hands_cm, probe.feet_cm, probe.limbs, probe.twist, probe.ground_cm)
    return [probe.name, *(f"{number:.2f}" for number in numbers), str(probe.flips), "" if probe.passes else "FAILS"]
