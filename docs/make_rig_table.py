"""Writes the table of rig kinds in docs/rigs.md: how each reads, and what its certificate says.

python docs/make_rig_table.py
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "tests" / "helpers")]

from limb_check import furthest, limbs, places_of  # noqa: E402
from rig_kinds import KINDS, PERSON, Kind  # noqa: E402

from motionrt.formats import load_motion, load_target  # noqa: E402
from motionrt.rigs.certify import certify  # noqa: E402

START, END = "<!-- rigs -->\n", "<!-- /rigs -->"
HEADER = (
    "| kind of rig | file | rest pose | read, limbs off | certified | hands | feet | limbs | twist | hips |\n"
    "|---|---|---|---|---|---|---|---|---|---|\n"
)
RESTS = {"t": "T", "a": "A", "spread": "legs apart", "bones_up": "none: all bones along Y"}


def row(name: str, kind: Kind, folder: Path) -> str:
    path = kind.write(folder)
    read = furthest(limbs(places_of(load_motion(path))), limbs(places_of(PERSON)))
    result = certify(load_target(path))
    worst = [max(getattr(probe, what) for probe in result.probes) for what in ("hands_cm", "feet_cm", "limbs", "twist")]
    hands, feet, off, twist = worst
    return (
        f"| {name} | `{kind.suffix}` | {RESTS[kind.rest]} | {read:.2f}° | {'yes' if result.passes else 'no'} |"
        f" {hands:.1f} cm | {feet:.1f} cm | {off:.1f}° | {twist:.1f}° | {result.hip_height:.2f} |\n"
    )


def main() -> None:
    page = ROOT / "docs" / "rigs.md"
    with tempfile.TemporaryDirectory() as folder:
        table = HEADER + "".join(row(name, kind, Path(folder)) for name, kind in KINDS.items())
    before, _, rest = page.read_text(encoding="utf-8").partition(START)
    page.write_text(before + START + table + END + rest.partition(END)[2], encoding="utf-8")
    print(table)


if __name__ == "__main__":
    main()
