"""A benchmark as rows of text, for the terminal and for Markdown."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

Row = list[str]


def header(threads: int, rivals: Sequence[str]) -> Row:
    """Column titles of :func:`rows`."""
    return [f"threads: {threads}", "p50", "p95", "rate", *(title for name in rivals for title in (name, "ratio"))]


def rows(run: Mapping[str, Any], rivals: Sequence[str]) -> list[Row]:
    """Rows of one thread count: what, p50, p95, rate, and for every rival its p50 and the ratio.

    Times of walks are those of one character, times of performances those of one frame, and so on.
    """
    table = [
        [case["case"], ms(case["p50_ms"]), ms(case["p95_ms"]), _rate(case["p50_ms"]), *_others(case, rivals)]
        for case in run["cases"]
    ]
    return (
        table
        + strict_rows(run, rivals)
        + _derived_rows(run, rivals)
        + _cold_rows(run, rivals)
        + _memory_rows(run, rivals)
    )


def strict_rows(run: Mapping[str, Any], rivals: Sequence[str]) -> list[Row]:
    """What was timed call by call in turn."""
    return [
        [f"{case['case']}, call by call", ms(again["p50_ms"]), ms(again["p95_ms"]), "", *_others(again, rivals)]
        for case in run["cases"]
        if (again := case.get("strict"))
    ]


def limit_rows(limits: Mapping[str, Any]) -> list[Row]:
    """Rows of the benchmarks against the machine's peaks; :data:`LIMITS` are their titles."""
    return [
        [
            row["case"],
            f"{row['macs_int8_m']:,.1f}",
            f"{row['macs_fp32_m']:,.1f}",
            f"{row['weights_mb']:.1f}",
            ms(row["sums_ms"]),
            ms(row["reads_ms"]),
            ms(row["p50_ms"]),
            f"{row['times_limit']:.1f} x",
        ]
        for row in limits["benchmarks"]
    ]


LIMITS = ["benchmark", "10^6 int8 MACs", "fp32", "weights, MB", "sums", "reads", "p50", "times the limit"]
PEAKS = ["peak", "10^9 a second"]


def peak_rows(peaks: Mapping[str, Mapping[str, float]]) -> list[Row]:
    """The machine's peaks; :data:`PEAKS` are their titles."""
    words = {"fp32_gmacs": "float32 MACs", "int8_gmacs": "int8 MACs", "read_gbs": "bytes read", "copy_gbs": "copied"}
    return [[f"{words[kind]}, {name}", f"{rate:,.1f}"] for kind, rates in peaks.items() for name, rate in rates.items()]


def install_rows(sizes: Mapping[str, float], least_mb: float = 3.0) -> list[Row]:
    """What the base install takes on the disk, small packages together."""
    large = {name: size for name, size in sizes.items() if size >= least_mb}
    small = [size for size in sizes.values() if size < least_mb]
    table = [[name, f"{size:.0f} MB"] for name, size in large.items()]
    table += [[f"{len(small)} others", f"{sum(small):.0f} MB"]] if small else []
    return [*table, ["base install", f"{sum(sizes.values()):.0f} MB"]]


def ms(value: float) -> str:
    """Milliseconds to three figures or so; seconds from ten of them on."""
    if value >= 10_000:
        return f"{value / 1000:.1f} s"
    return f"{value:.2f} ms" if value < 10 else f"{value:.1f} ms" if value < 100 else f"{value:,.0f} ms"


def _derived_rows(run: Mapping[str, Any], rivals: Sequence[str]) -> list[Row]:
    table = []
    if crowd := run.get("characters_at_30_fps"):
        against = {name: [str(other["count"]), _ratio(other)] for name, other in crowd["against"].items()}
        others = [cell for name in rivals for cell in against.get(name, ["", ""])]
        table.append([f"characters at 30 fps ({crowd['case']})", str(crowd["count"]), "", "", *others])
    if times := run.get("perform_times_real_time"):
        table.append(["perform, times real time", f"{times:.1f} x", "", "", *_blank(rivals)])
    return table


_PARTS = (("of which Python alone", "python_s"), ("of which import", "import_s"), ("motionrt retrieve", "retrieve_s"))


def _cold_rows(run: Mapping[str, Any], rivals: Sequence[str]) -> list[Row]:
    cold = run.get("cold_start")
    if not cold:
        return []
    others = _others(cold, rivals, "seconds", 1000)
    table = [["cold start to first text", ms(cold["seconds"] * 1000), "", "", *others]]
    for label, key in _PARTS:
        if cold[key] is not None:
            table.append([label, ms(cold[key] * 1000), "", "", *_blank(rivals)])
    if cold["peak_mb"] is not None:
        peaks = [_mb(cold["against"].get(name, {}).get("peak_mb")) for name in rivals]
        others = [cell for peak in peaks for cell in (peak, "")]
        table.append(["peak memory, first text", _mb(cold["peak_mb"]), "", "", *others])
    return table


def _memory_rows(run: Mapping[str, Any], rivals: Sequence[str]) -> list[Row]:
    peaks = run.get("peak_mb", {})
    return [[f"peak memory, {group}", _mb(peak), "", "", *_blank(rivals)] for group, peak in peaks.items()]


def _others(row: Mapping[str, Any], rivals: Sequence[str], key: str = "p50_ms", scale: float = 1.0) -> Row:
    cells: Row = []
    for name in rivals:
        other = row["against"].get(name)
        cells += [ms(other[key] * scale), _ratio(other)] if other else ["", ""]
    return cells


def _blank(rivals: Sequence[str]) -> Row:
    return [""] * (2 * len(rivals))


def _ratio(other: Mapping[str, Any]) -> str:
    return f"{other['ratio']:.1f} x"


def _rate(p50_ms: float) -> str:
    rate = 1000 / p50_ms
    return f"{rate:,.0f}/s" if rate >= 10 else f"{rate:.1f}/s"


def _mb(value: float | None) -> str:
    return "" if value is None else f"{value:.0f} MB"
