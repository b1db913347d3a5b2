"""What motionrt is compared with: other packages offer it under an entry point, so the runtime knows none of
them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import entry_points

from motionrt.bench.timing import Call
from motionrt.bench.workload import Workload
from motionrt.errors import InvalidInputError, MissingDependencyError

GROUP = "motionrt.bench_rivals"


@dataclass(frozen=True)
class Rival:
    """Another way to do the same work.

    Attributes:
        cases: for the names of cases of :mod:`motionrt.bench.cases`, any of them, what the rival calls.
        cold_start: a command that prints a line as soon as it has embedded its first text; where that is a JSON
            object, its ``peak_mb`` is the most memory that the process has held.
    """

    cases: Mapping[str, Call]
    cold_start: Sequence[str] | None = None


OpenRival = Callable[[Workload, int, str | None], Rival]
"""Takes the inputs, the number of threads and where the models are (``None``: those that came with motionrt).
"""


def open_rival(name: str, work: Workload, threads: int, models: str | None) -> Rival:
    """The rival called ``name``, ready to run with that many threads.

    Raises:
        InvalidInputError: nothing of that name is installed.
        MissingDependencyError: it needs a package that is not; the message says what to install.
    """
    found = list(entry_points(group=GROUP, name=name))
    if not found:
        known = ", ".join(sorted({point.name for point in entry_points(group=GROUP)})) or "nothing"
        raise InvalidInputError(f"cannot compare with '{name}': installed is {known}; try: pip install motionrt-export")
    try:
        opener: OpenRival = found[0].load()
    except ImportError as error:
        raise MissingDependencyError(f"cannot compare with '{name}': {error}; try: {_remedy(name, error)}") from error
    return opener(work, threads, models)


def _remedy(name: str, error: ImportError) -> str:
    """What to install: the package that the rival is called after, where that is what is missing."""
    return f"pip install {name}" if error.name == name != "torch" else "pip install motionrt-export"
