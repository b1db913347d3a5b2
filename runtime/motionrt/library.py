"""Libraries of generated clips: a folder filled from a list of prompts, each clip proven to do what its prompt says."""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from motionrt.errors import InvalidInputError
from motionrt.formats.atomic import write_bytes
from motionrt.models.text import checked_text
from motionrt.motion import Motion
from motionrt.motion.attributes import measure
from motionrt.motion.events import events
from motionrt.runtime import Runtime
from motionrt.synthesis.sampling import SECONDS
from motionrt.text import agreement, parse_query
from motionrt.untrusted.arguments import check_flags, check_functions, check_kind, checked_number, checked_whole, listed
from motionrt.untrusted.files import as_path
from motionrt.untrusted.names import plain_stem
from motionrt.untrusted.words import shown

ACCEPTED = 0.75
"""Agreement of a clip's measured attributes with its prompt from which on it is taken."""

TRIES = 16
SUFFIXES = (".bvh", ".glb", ".gltf", ".npz")


@dataclass(frozen=True)
class Made:
    """One prompt's clip.

    Attributes:
        prompt: its text.
        file: what was written; None where no try was good enough.
        agreement: of the best try, 0 to 1.
        seed: that drew it.
        reasons: why the best try was not taken: what was said and measured, worst first.
    """

    prompt: str
    file: Path | None
    agreement: float
    seed: int
    reasons: tuple[str, ...] = ()


def make(
    prompts: Iterable[str],
    folder: str | Path,
    *,
    runtime: Runtime | None = None,
    each: int = 1,
    seconds: float = SECONDS,
    seed: int = 0,
    suffix: str = ".glb",
    accept: float = ACCEPTED,
    tries: int = TRIES,
    loop: bool = False,
    in_place: bool = False,
    progress: Callable[[Made], None] | None = None,
) -> list[Made]:
    """Fill a folder with clips of prompts; beside each lies a ``.json`` of its events, and ``captions.csv`` of all.

    Files that are there already with the same prompt are kept, so that a run that was stopped goes on.

    Args:
        prompts: texts.
        folder: made where it is missing.
        runtime: whose models; a new one by default.
        each: how many clips of every prompt.
        seconds: of every clip.
        seed: of the first try; every try takes the next one.
        suffix: of the files.
        accept: agreement from which on a clip is taken, 0 to 1; prompts that say nothing that can be measured have 0.5
            and are always taken.
        tries: how often at most for each clip.
        loop: as for :meth:`motionrt.Runtime.generate`.
        in_place: as there.
        progress: is told of every clip.

    Raises:
        InvalidInputError: no prompts, an empty one, or a number out of range.
    """
    texts = [checked_text(prompt) for prompt in listed(prompts, "prompts", "texts")]
    if not texts:
        raise InvalidInputError("give at least one prompt")
    if not isinstance(suffix, str) or suffix not in SUFFIXES:
        raise InvalidInputError(f"suffix must be one of {', '.join(SUFFIXES)}, not {shown(suffix)}")
    check_functions(progress=progress)
    check_kind(runtime, Runtime | None, "runtime", "a Runtime")
    check_flags(loop=loop, in_place=in_place)
    checked_whole(seed, "seed", 0)
    checked_number(accept, "accept", 0.0, 1.0)
    checked_whole(each, "each", 1, 1000)
    checked_whole(tries, "tries", 1, 1000)
    target = as_path(folder)
    target.mkdir(parents=True, exist_ok=True)
    maker = _Maker(runtime if runtime is not None else Runtime(), seconds, accept, tries, loop, in_place)
    found = []
    for prompt in dict.fromkeys(texts):
        for number in range(each):
            path = target / f"{_slug(prompt)}{f'-{number + 1}' if each > 1 else ''}{suffix}"
            made = _kept(path, prompt) or maker.made(prompt, path, seed + number * tries)
            found.append(made)
            if progress is not None:
                progress(made)
    _write_captions(target / "captions.csv", found)
    return found


@dataclass(frozen=True)
class _Maker:
    runtime: Runtime
    seconds: float
    accept: float
    tries: int
    loop: bool
    in_place: bool

    def made(self, prompt: str, path: Path, seed: int) -> Made:
        """The first try that is good enough, written; or the best that was not."""
        said = parse_query(prompt)
        needed = self.accept if said.said else 0.0
        best: Made | None = None
        for number in range(self.tries):
            motion = self._drawn(prompt, seed + number)
            found = agreement(said, measure(motion))
            made = Made(prompt, None, float(found), seed + number, found.reasons[:3])
            if made.agreement >= needed:
                return _written(motion, path, made)
            best = made if best is None or made.agreement > best.agreement else best
        return best or Made(prompt, None, 0.0, seed)

    def _drawn(self, prompt: str, seed: int) -> Motion:
        return self.runtime.generate(prompt, self.seconds, seed=seed, loop=self.loop, in_place=self.in_place)


def _written(motion: Motion, path: Path, made: Made) -> Made:
    motion.save(path)
    facts = {"prompt": made.prompt, "seed": made.seed, "agreement": round(made.agreement, 4), **events(motion)}
    write_bytes(path.with_suffix(".json"), (json.dumps(facts, indent=1) + "\n").encode("utf-8"))
    return Made(made.prompt, path, made.agreement, made.seed)


def _kept(path: Path, prompt: str) -> Made | None:
    """What an earlier run made of the same prompt."""
    facts = path.with_suffix(".json")
    if not (path.is_file() and facts.is_file()):
        return None
    try:
        known = json.loads(facts.read_text(encoding="utf-8"))
        if known["prompt"] == prompt:
            return Made(prompt, path, float(known["agreement"]), int(known["seed"]))
    except (OSError, ValueError, KeyError, TypeError, RecursionError):  # it is made anew
        return None
    return None


def _slug(prompt: str) -> str:
    return plain_stem(re.sub(r"[^a-z0-9]+", "_", prompt.lower()), 60) or "clip"


def _write_captions(path: Path, made: Iterable[Made]) -> None:
    """``file,caption`` rows, which ``gallery build`` reads."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(["file", "caption"])
    rows.writerows([[one.file.name, one.prompt] for one in made if one.file is not None])
    write_bytes(path, text.getvalue().encode("utf-8"))
