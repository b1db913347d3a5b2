"""``motionrt render``: motions as pictures and animations."""

from __future__ import annotations

import argparse
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionrt.cli.console import Progress, print_json, working
from motionrt.cli.options import add_json, add_models, add_output, command, runtime
from motionrt.cli.reading import add_reading, read_motion

if TYPE_CHECKING:
    from motionrt.rendering import Look, TakeLike

PICTURES = (".png", ".jpg", ".jpeg", ".webp", ".gif", ".mp4")
FLOOR = 0.05  # metres below which a point of a cloud is floor
HELP = """draw motions: a filmstrip (.png), an animation (.gif) or a video (.mp4)
Left limbs are blue, right limbs red. A script (.yaml) is performed and drawn with its paths, keypoints
and furniture.
Needs: pip install "motionrt[render]"; for .mp4 the program ffmpeg, too.

examples:
  motionrt render walk.bvh -o walk.png                       ten poses side by side
  motionrt render walk.bvh -o way.png --layout path          poses where they happen
  motionrt render walk.bvh -o hero.gif --character hero.glb  on your own character
  motionrt render a.bvh b.bvh -o ab.gif --captions before after --camera side"""


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "render", run, HELP)
    parser.add_argument("inputs", nargs="+", metavar="IN", help="motion files, or scripts (.yaml) to perform")
    add_output(parser, "file to write (.png, .jpg, .webp, .gif, .mp4)", PICTURES)
    parser.add_argument(
        "--character", type=Path, metavar="FILE", help="who is drawn: your own character with its mesh (.glb, .vrm)"
    )
    parser.add_argument("--captions", nargs="+", metavar="TEXT", help="a line for each (default: names of the files)")
    _add_camera(parser)
    _add_sheet(parser)
    _add_colours(parser)
    add_reading(parser)
    add_json(parser)
    add_models(parser)


def _add_camera(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("camera")
    group.add_argument(
        "--camera",
        metavar="NAME",
        help="front, three-quarter, side, back, left, top, or degrees from the character's front to its right "
        "(default: three-quarter)",
    )
    group.add_argument("--elevation", type=float, metavar="DEG", help="degrees that the eye is above the horizon")
    group.add_argument(
        "--follow",
        action=argparse.BooleanOptionalAction,
        help="animations: go along (default: where the character leaves its place); strips: turn with the character",
    )


def _add_sheet(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("picture")
    group.add_argument("--layout", default="strip", choices=("strip", "path"), help="of pictures (default: strip)")
    group.add_argument(
        "--poses", type=int, metavar="N", help="of pictures (default: 10, or what the path has room for)"
    )
    group.add_argument("--size", type=_size, metavar="WxH", help="pixels, as in 1200x400, or only the width")
    group.add_argument("--columns", type=int, metavar="N", help="clips side by side")
    group.add_argument("--fps", type=float, metavar="N", help="of animations (default: 20 for .gif, 30 for .mp4)")


def _add_colours(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("look")
    group.add_argument("--theme", default="light", choices=("light", "dark"), help="(default: light)")
    group.add_argument("--colour", action="append", default=[], metavar="NAME=#RRGGBB", help="left, right, body, ...")
    group.add_argument("--trails", action="store_true", help="draw the ways of wrists and ankles")
    for name, what in (("grid", "the floor"), ("shadow", "shadows"), ("times", "seconds")):
        group.add_argument(f"--no-{name}", dest=name, action="store_false", help=f"without {what}")


def run(arguments: argparse.Namespace) -> int:
    """Draw, and say what was written."""
    from motionrt.rendering import render_as

    look = _look(arguments)
    given, names = [_given(arguments, name) for name in arguments.inputs], arguments.captions
    if names is None:
        names = [Path(name).stem for name in arguments.inputs] if len(given) > 1 else None
    with working("drawing"):
        path = render_as(given, arguments.output, look, names, arguments.character)
    size = path.stat().st_size
    if arguments.json:
        print_json({"path": str(path), "bytes": size})
    else:
        print(f"{path}: {max(1, round(size / 1000))} kB")
    return 0


def _look(arguments: argparse.Namespace) -> Look:
    from motionrt.rendering import Look

    same = ("camera", "elevation", "follow", "layout", "poses", "size", "columns", "fps", "theme", "grid", "shadow")
    chosen = {name: getattr(arguments, name) for name in (*same, "times", "trails")}
    return Look(**chosen, colours=_colours(arguments.colour))


def _colours(given: list[str]) -> dict[str, str]:
    """Colours by name; InvalidInputError for what is not ``name=#rrggbb``."""
    from motionrt.errors import InvalidInputError

    for one in given:
        if "=" not in one:
            raise InvalidInputError(f"--colour must be like left=#3d8bd4, not '{one}'")
    return dict(one.split("=", 1) for one in given)


def _given(arguments: argparse.Namespace, name: str) -> TakeLike:
    """The motion of a file; a script is performed."""
    if Path(name).suffix.lower() in {".yaml", ".yml"}:
        return _played(arguments, name)
    return read_motion(arguments, name)


def _played(arguments: argparse.Namespace, name: str) -> TakeLike:
    """What a script plays, with its paths and keypoints, its furniture and the ground of its scene."""
    from dataclasses import replace

    import numpy as np

    from motionrt.locomotion import Script, load_cloud
    from motionrt.rendering.takes import take_of

    script = Script.read(name)
    take = take_of(runtime(arguments).play(script, progress=Progress()))
    if script.cloud is not None:
        points = load_cloud(script.cloud).points
        take = replace(take, things=points[points[:, 1] > FLOOR])
    if script.scene is not None and script.scene.floor:
        take = replace(take, areas=[np.array(outline, np.float32) for outline in script.scene.floor])
    return take


def _size(text: str) -> tuple[int, int]:
    found = re.fullmatch(r"(\d+)(?:x(\d+))?", text.lower())
    if not found:
        raise argparse.ArgumentTypeError(f"'{text}' is no size: give pixels as in 1200x400, or only the width")
    return int(found[1]), int(found[2] or 0)
