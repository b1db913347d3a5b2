"""Zip the add-on: an extension for Blender 4.2 and newer, an add-on for older ones, the same file.

    python integrations/blender/make_extension.py -o motionrt_blender.zip [--wheel dist/motionrt-0.1.0-py3-none-any.whl]

With --wheel the zip carries motionrt itself; pressing "Install motionrt" then fetches only what it depends on.
"""

from __future__ import annotations

import argparse
import sys
import zipfile
from collections.abc import Sequence
from pathlib import Path

ADDON = Path(__file__).resolve().parent / "motionrt_blender"
WHEELS = "wheel"  # the folder that installing.py looks into


def main(given: Sequence[str] | None = None) -> int:
    """Write the zip; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="ZIP")
    parser.add_argument("--wheel", type=Path, metavar="FILE", help="carry this wheel of motionrt")
    arguments = parser.parse_args(given)
    wheel = arguments.wheel
    if wheel is not None and (not wheel.is_file() or not wheel.name.startswith("motionrt-") or wheel.suffix != ".whl"):
        print(f"{wheel} is no wheel of motionrt; build one: python -m build --wheel", file=sys.stderr)
        return 1
    with zipfile.ZipFile(arguments.output, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in sorted(ADDON.rglob("*")):
            if file.suffix in {".py", ".toml"}:
                archive.write(file, Path(ADDON.name) / file.relative_to(ADDON))
        if wheel is not None:
            archive.write(wheel, Path(ADDON.name) / WHEELS / wheel.name, zipfile.ZIP_STORED)
    print(f"{arguments.output}: {arguments.output.stat().st_size / 1e6:.1f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
