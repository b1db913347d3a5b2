"""One question to the generator: what is wanted besides the text, checked once, and the answer to it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from motionrt.errors import InvalidInputError
from motionrt.models.text import checked_text
from motionrt.motion import Motion
from motionrt.synthesis.choosing import Likeness, best
from motionrt.synthesis.constraints import Constraints
from motionrt.synthesis.generating import Generator
from motionrt.synthesis.motion_generator import Wanted
from motionrt.synthesis.sampling import Sampling
from motionrt.synthesis.timeline import Item, Line, lines_of_text, read_timeline
from motionrt.untrusted.arguments import check_flags, checked_whole

MOST_CANDIDATES = 64


@dataclass(frozen=True, eq=False)
class Asked:
    """What is wanted besides the text.

    Attributes:
        sampling: length, chance and sampler.
        constraints: what is kept or met; None for nothing.
        loop, in_place: as of :meth:`motionrt.Runtime.generate`.
        candidates: how many are drawn for each that is answered.

    Raises:
        InvalidInputError: a number of candidates out of range, or constraints of another kind.
    """

    sampling: Sampling
    constraints: Constraints | None = None
    loop: bool = False
    in_place: bool = False
    candidates: int = 1

    def __post_init__(self) -> None:
        checked_whole(self.candidates, "candidates", 1, MOST_CANDIDATES)
        check_flags(loop=self.loop, in_place=self.in_place)
        if self.constraints is not None and not isinstance(self.constraints, Constraints):
            raise InvalidInputError(f"constraints must be Constraints, not {type(self.constraints).__name__}")

    def lines(self, given: str | Sequence[Item], label: Callable[[str], frozenset[str]]) -> tuple[Line, ...]:
        """A text, or a timeline, as lines."""
        if self.sampling.sampler != "motion" and (self.constraints or self.loop or not isinstance(given, str)):
            raise InvalidInputError("timelines, constraints and loops are drawn by the sampler 'motion' alone")
        if isinstance(given, str):
            text, seconds = checked_text(given), self.sampling.seconds
            one = self.sampling.sampler != "motion" or self.constraints is not None or self.loop
            return (Line(text, 0.0, seconds),) if one else lines_of_text(text, seconds)
        return read_timeline(given, label)

    def answer(self, lines: tuple[Line, ...], generator: Generator, likeness: Likeness) -> list[Motion]:
        """``sampling.n`` motions."""
        count = self.sampling.n * self.candidates
        drawn = self._drawn(lines, generator, replace(self.sampling, n=count))
        groups = [drawn[first : first + self.candidates] for first in range(0, count, self.candidates)]
        chosen = [group[best(group, lines, likeness) if len(group) > 1 else 0] for group in groups]
        return [motion.in_place() for motion in chosen] if self.in_place else chosen

    def _drawn(self, lines: tuple[Line, ...], generator: Generator, sampling: Sampling) -> list[Motion]:
        if sampling.sampler != "motion":
            return generator.generate(lines[0].text, sampling)
        wanted = Wanted(lines, self.constraints or Constraints(), self.loop)
        return generator.in_motion_space.generate(wanted, sampling)
