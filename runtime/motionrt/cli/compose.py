"""``motionrt compose``: several motions, files or texts, played at once by one body."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionrt.cli.console import print_json, print_table, working
from motionrt.cli.making import add_chance, as_json, chance, tell_seed
from motionrt.cli.options import add_json, add_models, add_output, command, runtime
from motionrt.cli.parsing import WrongUsageError
from motionrt.cli.reading import spare_inputs

if TYPE_CHECKING:
    from motionrt.motion import Motion
    from motionrt.runtime import Runtime
    from motionrt.synthesis.composing import Layer

Rows = list[dict[str, Any]]

LETTERS = "abcdef"  # for as many layers parts and masks can be given; no body has more parts
HELP = """play several motions at once: the arms of one on the legs of another
A, B and so on are motion files or texts, which are generated. Each moves the body parts that its text needs, or those
you name: left arm, right arm, left leg, right leg, torso, global. A file gives those of its arms and its torso that
move fast. A keeps its legs and its way, unless the text or the parts of another need them. The one with fewer parts
lies on top; a leg or global takes both legs, the way and the direction along."""


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "compose", run, HELP)
    parser.add_argument("given", nargs="+", metavar="MOTION|TEXT", help="two or more: A, B, C ...")
    add_output(parser)
    for letter in LETTERS:
        _add_layer(parser, letter)
    parser.add_argument("--joint", action="store_true", help="give the model all texts in one sentence instead")
    parser.add_argument("--seconds", type=float, metavar="S", help="length (default: the shortest, or 4 for texts)")
    parser.add_argument("--align", default="start", metavar="HOW", help="start, stretch or phase (default: start)")
    parser.add_argument("--seam", type=int, default=1, metavar="N", help="joints to blend over, 0 to 3 (default: 1)")
    parser.add_argument("--keep", default="local", metavar="HOW", help="world keeps the lean (default: local)")
    parser.add_argument("--foot-lock", action="store_true", help="let standing feet of the result stand still")
    add_chance(parser)
    add_json(parser)
    add_models(parser)


def _add_layer(parser: argparse.ArgumentParser, letter: str) -> None:
    shown, name = letter in "ab", letter.upper()
    more = " (and so on to F)" if letter == "b" else ""
    parts, joints = f"what {name} needs, as in 'right arm, torso'{more}", f"exactly what {name} moves, joints too{more}"
    parser.add_argument(f"--parts-{letter}", metavar="PARTS", help=parts if shown else argparse.SUPPRESS)
    parser.add_argument(f"--mask-{letter}", metavar="NAMES", help=joints if shown else argparse.SUPPRESS)


def run(arguments: argparse.Namespace) -> int:
    """Compose, write the motion, say what moves what."""
    from motionrt.synthesis.layering import is_text

    texts = any(is_text(given) for given in arguments.given)
    options: dict[str, Any] = {"seconds": arguments.seconds, **chance(arguments)}
    if not texts and arguments.seed is None:  # there is no chance in files
        options["seed"] = None
    opened, made = runtime(arguments), _joint if arguments.joint else _layered
    with working("composing"):
        motion, rows = made(opened, arguments, options)
    spare_inputs(arguments.output, *(Path(given) for given in arguments.given if not is_text(given)))
    path = motion.save(arguments.output)
    seed = options.get("seed")
    tell_seed(arguments, seed)
    if arguments.json:
        print_json({**as_json(motion, path), "seed": seed, "joint": arguments.joint, "layers": rows})
    else:
        print_table(["layer", "moves", "given"], [_cells(i, row) for i, row in enumerate(rows)], "<<<")
    return 0


def _joint(opened: Runtime, arguments: argparse.Namespace, options: dict[str, Any]) -> tuple[Motion, Rows]:
    named = _named(arguments, "parts"), _named(arguments, "mask")
    motion = opened.compose(arguments.given, named[0], masks=named[1], joint=True, **options)
    return motion, [_row(given) for given in arguments.given]


def _layered(opened: Runtime, arguments: argparse.Namespace, options: dict[str, Any]) -> tuple[Motion, Rows]:
    named = _named(arguments, "parts"), _named(arguments, "mask")
    layers = opened.layers(arguments.given, named[0], masks=named[1], **options)
    how = {name: getattr(arguments, name) for name in ("seconds", "align", "seam", "keep", "foot_lock")}
    motion = opened.compose(layers, **how)
    return motion, [_row(given, layer) for given, layer in zip(arguments.given, layers, strict=True)]


def _named(arguments: argparse.Namespace, what: str) -> list[list[str] | None] | None:
    """What ``--parts-a``, ``--parts-b`` ... or ``--mask-a`` ... say, one entry for every layer; None for nothing."""
    given = [getattr(arguments, f"{what}_{letter}") for letter in LETTERS]
    count = len(arguments.given)
    if any(given[count:]):
        letter = next(letter for letter, names in zip(LETTERS[count:], given[count:], strict=True) if names)
        raise WrongUsageError(f"--{what}-{letter} is for a motion that is not there: only {count} are given")
    names = [None if one is None else [name.strip() for name in one.split(",")] for one in given[:count]]
    names += [None] * (count - len(names))
    return names if any(names) else None


def _row(given: str, layer: Layer | None = None) -> dict[str, Any]:
    """What ``--json`` says of a layer: parts that its action needs, or its mask; null where it has none."""
    from motionrt.motion.body_parts import PARTS
    from motionrt.synthesis.layering import is_text

    parts = None if layer is None or layer.parts is None else [part for part in PARTS if part in layer.parts]
    mask = None if layer is None or layer.mask is None else list(layer.mask)
    return {"given": given, "kind": "text" if is_text(given) else "file", "parts": parts, "mask": mask}


def _cells(number: int, row: dict[str, Any]) -> list[str]:
    from motionrt.motion.body_parts import PARTS

    names = row["parts"] if row["mask"] is None else row["mask"]
    whole = row["parts"] is not None and len(row["parts"]) == len(PARTS)
    moves = "the whole body" if names is None or whole else ", ".join(names) or "nothing on purpose"
    return [chr(ord("A") + number) if number < 26 else str(number + 1), moves, row["given"]]
