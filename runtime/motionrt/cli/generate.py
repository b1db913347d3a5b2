"""``motionrt generate``: a text, or a plan of several, becomes motion."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionrt.cli.console import print_json, print_table, say, working
from motionrt.cli.making import add_chance, as_json, chance, skate, tell_seed
from motionrt.cli.options import add_json, add_models, add_output, command, runtime
from motionrt.cli.parsing import WrongUsageError

if TYPE_CHECKING:
    from motionrt.motion import Motion
    from motionrt.synthesis.misses import Miss
    from motionrt.synthesis.plan import Plan

CANDIDATES = 8
HELP = f"""make motion of a text, or of several along a plan
The character begins at the origin, facing +Z, 30 frames per second. With -n 3 and -o wave.bvh the files are
wave-1.bvh, wave-2.bvh and wave-3.bvh. Of every motion {CANDIDATES} candidates are drawn, and the one that does best
what the text says is kept; --candidates 1 is quicker. Foot skate, how much standing feet slide, is in cm per frame."""


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "generate", run, HELP)
    parser.add_argument("text", nargs="?", metavar="TEXT", help="what somebody does, as in 'wave the right hand'")
    parser.add_argument(
        "--plan", type=Path, metavar="FILE", help="texts with their times, poses, a path (docs/plans.md)"
    )
    add_output(parser)
    parser.add_argument("--seconds", type=float, metavar="S", help="0.5 to 10 (default: 4)")
    parser.add_argument("-n", type=int, default=1, metavar="N", help="how many motions (default: 1)")
    parser.add_argument(
        "--candidates", type=int, metavar="N", help=f"draw so many of each and keep the best (default: {CANDIDATES})"
    )
    parser.add_argument("--loop", action="store_true", help="end where it begins, to be played on and on")
    parser.add_argument("--in-place", action="store_true", help="without its way over the ground")
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
    paths, plan = names(arguments), _plan(arguments)
    asked: dict[str, Any]
    options["candidates"] = CANDIDATES if arguments.candidates is None else arguments.candidates
    asked = {"text": arguments.text} if plan is None or not plan.timeline else {"timeline": plan.timeline}
    asked |= {"constraints": plan.constraints} if plan is not None else {}
    asked |= {"loop": True} if arguments.loop else {}
    with working("generating"):
        motions = runtime(arguments).generate(
            **asked, n=arguments.n, foot_lock=not arguments.no_foot_lock, in_place=arguments.in_place, **options
        )
    written = [(motion, motion.save(path)) for motion, path in zip(motions, paths, strict=True)]
    tell_seed(arguments, options["seed"])
    _warn_of_foreign(asked.get("text"))
    if options["candidates"] > 1:
        say(f"the best of {options['candidates']} candidates each; --candidates 1 takes the first")
    _tell(arguments, options, written, plan)
    return 0


def _warn_of_foreign(text: str | None) -> None:
    from motionrt.retrieval.vocabulary import unknown_words

    if text and unknown_words(text):
        say(f"no word of '{text}' is known, so this is a guess: say in English what somebody does")


def _tell(
    arguments: argparse.Namespace, options: dict[str, Any], written: list[tuple[Motion, Path]], plan: Plan | None
) -> None:
    found = {path: _misses(motion, plan) for motion, path in written}
    if arguments.json:
        known = {"text": arguments.text, "seed": options["seed"], "sampler": options["sampler"]}
        known |= {"temperature": options["temperature"], "candidates": options["candidates"]}
        made = [{**as_json(motion, path), **_as_json(found[path])} for motion, path in written]
        print_json({**known, "motions": made})
        return
    rows = [[f"{motion.duration:.2f}", f"{skate(motion):.2f}", str(path)] for motion, path in written]
    print_table(["seconds", "foot skate", "file"], rows, ">><")
    for path, some in found.items():
        if some:
            rows = [[m.what, f"{m.time:.2f}", f"{m.cm:.1f}", _degrees(m)] for m in some]
            print_table([path.name, "seconds", "cm off", "degrees off"], rows, "<>>>")


def _plan(arguments: argparse.Namespace) -> Plan | None:
    from motionrt.synthesis.plan import Plan

    if arguments.plan is None:
        if arguments.text is None:
            raise WrongUsageError("give a TEXT, as in 'wave the right hand', or --plan FILE")
        return None
    plan = Plan.read(arguments.plan)
    if plan.timeline and arguments.text is not None:
        raise WrongUsageError(f"{arguments.plan} has its own texts; leave TEXT away")
    if not plan.timeline and arguments.text is None:
        raise WrongUsageError(f"{arguments.plan} has no timeline; give a TEXT beside it")
    return plan


def _misses(motion: Motion, plan: Plan | None) -> list[Miss]:
    from motionrt.synthesis.misses import misses

    return [] if plan is None else misses(motion, plan.constraints)


def _as_json(found: list[Miss]) -> dict[str, object]:
    rows = [{"what": m.what, "seconds": m.time, "cm": round(m.cm, 2), "degrees": m.degrees} for m in found]
    return {"misses": rows} if rows else {}


def _degrees(miss: Miss) -> str:
    return "" if miss.degrees is None else f"{miss.degrees:.1f}"


def names(arguments: argparse.Namespace) -> list[Path]:
    """The file, or numbered ones for more than one motion."""
    out: Path = arguments.output
    if arguments.n == 1:
        return [out]
    return [out.with_name(f"{out.stem}-{number}{out.suffix}") for number in range(1, arguments.n + 1)]
