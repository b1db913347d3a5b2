"""``motionrt generate``: a text becomes motion."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from motionrt.cli.console import print_json, print_table
from motionrt.cli.making import add_chance, as_json, chance, skate, tell_seed
from motionrt.cli.options import add_json, add_models, command, runtime

HELP = """make motion of a text
The character begins at the origin, facing +Z, 30 frames per second. With -n 3 and -o wave.bvh the files are
wave-1.bvh, wave-2.bvh and wave-3.bvh. Foot skate, how much standing feet slide, is in cm per frame."""


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "generate", run, HELP)
    parser.add_argument("text", metavar="TEXT", help="what somebody does, as in 'wave the right hand'")
    parser.add_argument(
        "-o", "--output", type=Path, required=True, metavar="OUT", help="file to write (.bvh, .glb, .npz)"
    )
    parser.add_argument("--seconds", type=float, metavar="S", help="0.5 to 8 (default: 4)")
    parser.add_argument("-n", type=int, default=1, metavar="N", help="how many motions (default: 1)")
    add_chance(parser)
    parser.add_argument("--guidance", type=float, metavar="G", help="how much the text counts, for diffusion")
    parser.add_argument("--steps", type=int, metavar="N", help="calls of the denoiser, for diffusion")
    parser.add_argument("--no-foot-lock", action="store_true", help="leave the feet as the model moves them")
    add_json(parser)
    add_models(parser)


def run(arguments: argparse.Namespace) -> int:
    """Generate, write the motions, say which files."""
    options: dict[str, Any] = chance(arguments)
    for name in ("seconds", "guidance", "steps"):  # what is not given has its default where it is used
        if getattr(arguments, name) is not None:
            options[name] = getattr(arguments, name)
    paths = names(arguments)
    motions = runtime(arguments).generate(
        arguments.text, n=arguments.n, foot_lock=not arguments.no_foot_lock, **options
    )
    written = [(motion, motion.save(path)) for motion, path in zip(motions, paths, strict=True)]
    tell_seed(arguments, options["seed"])
    if arguments.json:
        known = {"text": arguments.text, "seed": options["seed"], "sampler": options["sampler"]}
        made = [as_json(motion, path) for motion, path in written]
        print_json({**known, "temperature": options["temperature"], "motions": made})
    else:
        rows = [[f"{motion.duration:.2f}", f"{skate(motion):.2f}", str(path)] for motion, path in written]
        print_table(["seconds", "foot skate", "file"], rows, ">><")
    return 0


def names(arguments: argparse.Namespace) -> list[Path]:
    """The file, or numbered ones for more than one motion."""
    from motionrt.errors import InvalidInputError

    out: Path = arguments.output
    if arguments.n == 1:
        return [out]
    if not out.name:
        raise InvalidInputError(f"-o {out} has no name to number; give a file, as in -o motion.bvh")
    return [out.with_name(f"{out.stem}-{number}{out.suffix}") for number in range(1, arguments.n + 1)]
