"""One picture of a benchmark: what a batch costs, and what a gallery's size costs, ours and the rivals'."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionrt.bench.locomotion import CROWDS, walk_case
from motionrt.bench.report import rivals_of
from motionrt.bench.search import CLIPS, answer_case, motion_case, search_case
from motionrt.errors import InvalidInputError, MissingDependencyError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

OURS = "motionrt"
_COLOURS = ("#D55E00", "#0072B2", "#009E73", "#CC79A7")  # Okabe and Ito's, which everybody can tell apart
_GREY = "#444444"
_SIZES = tuple(10**power for power in range(2, 8))
Name = Callable[[int], str]


@dataclass(frozen=True)
class _Kind:
    """A kind of work: its sizes, the names of its cases, and how its lines look."""

    label: str
    sizes: Sequence[int]
    name: Name
    style: str
    marker: str


def save_plot(found: Mapping[str, Any], path: str | Path) -> Path:
    """Draw the first thread count of a benchmark; log axes, one colour a contender, one line style a kind of work.

    Raises:
        MissingDependencyError: matplotlib is not installed.
        InvalidInputError: nothing of what the picture shows was measured.
    """
    try:
        from matplotlib.figure import Figure
    except ImportError as error:
        raise MissingDependencyError('a plot needs matplotlib: pip install "motionrt[plot]"') from error
    run, names = found["runs"][0], [OURS, *rivals_of(found)]
    sizes = _measured_sizes(run)
    batch = (
        _Kind("walk, per character-frame", CROWDS, walk_case, "-", "o"),
        _Kind("embed a clip of 10 s", CLIPS, motion_case, "--", "s"),
    )
    query = (
        _Kind("text to top 10", sizes, answer_case, "-", "o"),
        _Kind("exact search alone", sizes, search_case, "--", "s"),
    )
    figure = Figure(figsize=(11.5, 5.2), layout="constrained", facecolor="white")
    left, right = figure.subplots(1, 2)
    drawn = [_panel(left, run, names, batch), _panel(right, run, names, query)]
    if not any(drawn):
        raise InvalidInputError("nothing to plot: measure walk, motion, search or retrieve")
    for axes, shown in zip((left, right), drawn, strict=True):
        axes.set_visible(shown)
    if drawn[0]:
        _finish(left, "Cost against batch", "characters or clips in one call", CROWDS)
    if drawn[1]:
        _finish(right, "Query against gallery", "clips in the gallery", sizes)
    _contenders(figure, names)
    threads = f"{run['threads']} thread{'s' if run['threads'] > 1 else ''}"
    figure.suptitle(f"{found['machine']['processor']}, {threads}, medians", fontsize=11, color=_GREY)
    figure.savefig(path, dpi=150)
    return Path(path)


def _measured_sizes(run: Mapping[str, Any]) -> Sequence[int]:
    measured = {case["case"] for case in run["cases"]}
    return [size for size in _SIZES if search_case(size) in measured or answer_case(size) in measured]


def _panel(axes: Axes, run: Mapping[str, Any], names: Sequence[str], kinds: Sequence[_Kind]) -> bool:
    """A line for every contender and kind of work that it did; whether there was any."""
    cases = {case["case"]: case for case in run["cases"]}
    for kind in kinds:
        measured = [(size, cases[kind.name(size)]) for size in kind.sizes if kind.name(size) in cases]
        for colour, contender in zip(_COLOURS, names, strict=False):
            points = [(size, p50) for size, case in measured if (p50 := _p50(case, contender)) is not None]
            if points:
                x, y = zip(*points, strict=True)
                axes.plot(x, y, kind.style, marker=kind.marker, color=colour, linewidth=1.8, markersize=5)
        axes.plot([], [], kind.style, marker=kind.marker, color=_GREY, label=kind.label, linewidth=1.8, markersize=5)
    return len(axes.lines) > len(kinds)


def _p50(case: Mapping[str, Any], contender: str) -> float | None:
    if contender == OURS:
        return float(case["p50_ms"])
    other = case["against"].get(contender)
    return float(other["p50_ms"]) if other else None


def _finish(axes: Axes, title: str, x: str, ticks: Sequence[int]) -> None:
    from matplotlib.ticker import LogLocator

    axes.set(xscale="log", yscale="log")
    axes.set_title(title, fontsize=13, loc="left", pad=28)
    axes.legend(
        fontsize=10,
        frameon=False,
        loc="lower left",
        bbox_to_anchor=(-0.02, 1.0),
        ncols=2,
        borderaxespad=0.2,
        columnspacing=1.2,
    )
    axes.set_xlabel(x, fontsize=11)
    axes.set_ylabel("milliseconds (p50)", fontsize=11)
    axes.set_xticks(list(ticks), [f"{tick:,}" for tick in ticks])
    low, high = axes.get_ylim()
    axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if high < 300 * low else (1.0,)))
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.minorticks_off()
    axes.tick_params(labelsize=10.5)
    axes.grid(visible=True, which="major", color="#dddddd", linewidth=0.8)
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def _contenders(figure: Figure, names: Sequence[str]) -> None:
    """The colours, beneath both panels."""
    from matplotlib.lines import Line2D

    lines = [Line2D([], [], color=colour, linewidth=4) for colour, _ in zip(_COLOURS, names, strict=False)]
    titles = ["torch + transformers" if name == "transformers" else name for name in names]
    figure.legend(lines, titles, loc="outside lower center", ncols=len(names), fontsize=11, frameon=False)
