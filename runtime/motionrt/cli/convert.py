"""``motionrt convert``, ``trim`` and ``resample``: motion files into others, one or a folder of them."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionrt.cli.console import Progress, print_json, working
from motionrt.cli.options import add_json, command
from motionrt.cli.parsing import WrongUsageError
from motionrt.cli.reading import INPUTS, add_reading, in_options, read_motion, spare_inputs
from motionrt.cli.skipped import SOME_SKIPPED, say_skipped
from motionrt.untrusted.names import plain_stem

if TYPE_CHECKING:
    from motionrt.motion import Motion

OUTPUTS = ".bvh, .glb, .gltf, .vrma, .npz; .fbx with Blender"
HELP = f"""convert motion files ({INPUTS})
Whatever the rig, units and axes of the file, the result has the 24 joints of the canonical skeleton and Y up.
A folder is converted whole, into a folder: files that cannot be read are listed with the reason, and the
exit code is then 3."""
TRIM = """cut a motion file: the frames between two times
The result is on the canonical skeleton, as that of convert."""
RESAMPLE = """change the frame rate of a motion file
The result is on the canonical skeleton, as that of convert."""


def add(commands: Any) -> None:
    """Add the commands."""
    convert = _writer(
        commands, "convert", run, HELP, "a motion file, or a folder of them", "the file or folder to write"
    )
    convert.add_argument("--fps", type=float, metavar="N", help="resample to this frame rate")
    convert.add_argument("--to", metavar="SUFFIX", default=".bvh", help=f"of a folder: {OUTPUTS} (default: .bvh)")
    trim = _writer(commands, "trim", run_trim, TRIM, "a motion file", "the file to write")
    trim.add_argument("--start", type=float, default=0.0, metavar="S", help="seconds (default: 0)")
    trim.add_argument("--end", type=float, metavar="S", help="seconds (default: the end)")
    resample = _writer(commands, "resample", run_resample, RESAMPLE, "a motion file", "the file to write")
    resample.add_argument("--fps", type=float, required=True, metavar="N", help="frames per second of the result")


def _writer(commands: Any, name: str, run: Any, text: str, given: str, made: str) -> argparse.ArgumentParser:
    parser = command(commands, name, run, text)
    parser.add_argument("input", type=Path, metavar="IN", help=f"{given} ({INPUTS})")
    parser.add_argument("-o", "--output", type=Path, metavar="OUT", help=f"{made} ({OUTPUTS})")
    parser.add_argument("second", type=Path, nargs="?", metavar="OUT", help="the same, without -o")
    parser.add_argument("--units", choices=("cm", "m", "mm", "in"), help="of a .bvh (default: cm)")
    parser.add_argument("--t-pose", action="store_true", help="begin a .bvh with a frame of the T-pose")
    add_reading(parser)
    add_json(parser)
    return parser


def run(arguments: argparse.Namespace) -> int:
    """Convert a file or a folder, and say what was written."""
    _settle_output(arguments)
    if arguments.input.is_dir():
        return _run_folder(arguments)
    motion = read_motion(arguments, arguments.input)
    return _finish(arguments, motion if arguments.fps is None else motion.resample(arguments.fps))


def run_trim(arguments: argparse.Namespace) -> int:
    """Write a part of a motion."""
    from motionrt.errors import InvalidInputError

    _settle_output(arguments)
    motion = read_motion(arguments, arguments.input)
    end = motion.duration if arguments.end is None else arguments.end
    if not 0 <= arguments.start < end or arguments.start >= motion.duration:
        raise InvalidInputError(
            f"--start {arguments.start:g} and --end {end:g} leave nothing of a motion of {motion.duration:.2f} s"
        )
    return _finish(arguments, motion.between(arguments.start, end))


def run_resample(arguments: argparse.Namespace) -> int:
    """Write a motion at another frame rate."""
    _settle_output(arguments)
    return _finish(arguments, read_motion(arguments, arguments.input).resample(arguments.fps))


def _settle_output(arguments: argparse.Namespace) -> None:
    """The file to write is given by ``-o`` or behind the one that is read."""
    if (arguments.output is None) == (arguments.second is None):
        raise WrongUsageError("say where to write once, as in: -o OUT")
    arguments.output = arguments.output or arguments.second


def _finish(arguments: argparse.Namespace, motion: Motion) -> int:
    spare_inputs(arguments.output, arguments.input)
    with working("writing"):
        path = motion.save(arguments.output, units=arguments.units, t_pose=arguments.t_pose)
    if arguments.json:
        print_json({"path": str(path), "frames": motion.frames, "fps": motion.fps, "seconds": motion.duration})
    else:
        print(f"{path}: {motion.frames} frames, {motion.duration:.2f} s at {motion.fps:g} fps")
    return 0


def _run_folder(arguments: argparse.Namespace) -> int:
    """Convert all motion files below a folder; folders below it are made again below the output."""
    from motionrt.errors import InvalidInputError, MotionRTError
    from motionrt.formats import WRITABLE_SUFFIXES, animations_of, find_motions

    suffix = arguments.to if arguments.to.startswith(".") else f".{arguments.to}"
    if suffix not in WRITABLE_SUFFIXES:
        raise InvalidInputError(f"--to {arguments.to}: can be {', '.join(WRITABLE_SUFFIXES)}")
    if arguments.output.exists() and not arguments.output.is_dir():
        raise InvalidInputError(f"{arguments.output} is a file; a folder is converted into a folder")
    found = find_motions(arguments.input)
    names, progress = _sources(found.names, arguments.input, arguments.output), Progress()
    written: list[Path] = []
    skipped = list(found.closed)
    taken = {(arguments.input / name).resolve() for name in names}  # no input is written over
    for done, name in enumerate(names):
        progress(done, len(names), name)
        several = animations_of(arguments.input / name) if arguments.animation is None else []
        for animation in several or [arguments.animation]:
            try:
                target = _target(arguments.output / name, animation if several else None, suffix, taken)
                written.append(_convert_one(arguments, arguments.input / name, animation, target))
            except MotionRTError as error:
                skipped.append((name, in_options(" ".join(str(error).split()))))
    progress(len(names), len(names), "")
    return _report(arguments, written, skipped)


def _sources(names: list[str], source: Path, output: Path) -> list[str]:
    """What is to be converted: not what lies in an output folder inside the input folder, from the last time."""
    inside, above = output.resolve(), source.resolve()
    if inside == above or not inside.is_relative_to(above):
        return names
    return [name for name in names if not (above / name).is_relative_to(inside)]


def _convert_one(arguments: argparse.Namespace, source: Path, animation: str | None, target: Path) -> Path:
    motion = read_motion(argparse.Namespace(**{**vars(arguments), "animation": animation}), source)
    target.parent.mkdir(parents=True, exist_ok=True)
    motion = motion if arguments.fps is None else motion.resample(arguments.fps)
    return motion.save(target, units=arguments.units, t_pose=arguments.t_pose)


def _target(path: Path, animation: str | None, suffix: str, taken: set[Path]) -> Path:
    """Where a file goes: two sources of one stem do not write the same file, and no source is written over."""
    stem = path.stem if animation is None else f"{path.stem}__{plain_stem(animation) or 'animation'}"
    names = [stem, f"{stem}_{path.suffix[1:]}", *(f"{stem}_{path.suffix[1:]}_{k}" for k in range(2, 1000))]
    target = next(target for name in names if (target := path.with_name(name + suffix)).resolve() not in taken)
    taken.add(target.resolve())
    return target


def _report(arguments: argparse.Namespace, written: list[Path], skipped: list[tuple[str, str]]) -> int:
    if arguments.json:
        reasons = [{"path": name, "reason": reason} for name, reason in skipped]
        print_json({"written": [str(path) for path in written], "skipped": reasons})
    else:
        print(f"{arguments.output}: {len(written)} files written")
    say_skipped(skipped)
    return SOME_SKIPPED if skipped else 0
