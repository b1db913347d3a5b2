"""A benchmark as Markdown: the README's table, and all of it for docs/performance.md."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from motionrt.bench import tables
from motionrt.bench.files import GALLERY, LOAD
from motionrt.bench.generation import BODY_PARTS, COMPOSE, DECODE, generate_case
from motionrt.bench.locomotion import POSE, TRANSITION, walk_case
from motionrt.bench.report import rivals_of
from motionrt.bench.search import FULL_TEXT, TEXT, answer_case, motion_case, search_case
from motionrt.bench.tables import ms
from motionrt.errors import InvalidInputError

Found = Mapping[str, Any]
README = {
    answer_case(10_000): "text to the top 10 of 10,000 clips",
    TEXT: "embed a text",
    FULL_TEXT: "embed a text, full tower",
    motion_case(1): "embed a motion of 10 s",
    search_case(100_000): "search 100,000 vectors, exact",
    search_case(1_000_000): "search 1,000,000 vectors, exact",
    GALLERY: "index a BVH of 10 s",
    LOAD: "load a BVH of 10 s",
    generate_case("motion"): "text to 4 s of motion (one candidate, feet locked)",
    generate_case("diffusion"): "the same with the `diffusion` sampler",
    generate_case("vae"): "the same with the `vae` sampler",
    DECODE: "its decoder alone",
    COMPOSE: "compose two motions of 4 s",
    BODY_PARTS: "body parts of a text",
    walk_case(1): "walk, one character, per frame",
    walk_case(8): "walk, 8 characters, per character and frame",
    walk_case(64): "walk, 64 characters, per character and frame",
    TRANSITION: "a transition of 2 s",
    POSE: "a pose from a hand and two feet",
}
"""Cases of the README's table, and how they are called there."""


def readme_table(found: Found) -> str:
    """The README's speed table: medians of the first thread count, beside every rival."""
    run, rivals = found["runs"][0], rivals_of(found)
    cases = {case["case"]: case for case in run["cases"]}
    lines = [_line(label, cases[case], rivals) for case, label in README.items() if case in cases]
    lines += _perform_lines(run, rivals) + _cold_lines(run, rivals) + _installed_lines(found, rivals)
    head = ["", "motionrt", *(title for name in rivals for title in (_title(name), ""))]
    return f"{_caption(found, run)}\n\n{_table(head, lines)}"


def performance_tables(found: Found) -> str:
    """Every figure, as sections of a document."""
    rivals = rivals_of(found)
    versions = ", ".join(f"{name} {version}" for name, version in found["versions"].items())
    parts = [f"{_machine(found)}; {versions}."]
    for run in found["runs"]:
        parts.append(_table(tables.header(run["threads"], rivals), tables.rows(run, rivals)))
        parts += [f"Left out: {benchmark} ({why})." for benchmark, why in run["left_out"].items()]
    for run in found["runs"]:
        parts += _limit_parts(run)
    if found["models"]:
        parts += ["The models alone, one call of each graph:", models_table(found["models"])]
    parts += ["On the disk:", _table(["package", "size"], tables.install_rows(found["install_mb"]))]
    if "installed" in found:
        parts += ["Fresh installations:", installed_table(found["installed"])]
    return "\n\n".join(parts)


def models_table(models: Mapping[str, Mapping[str, Any]]) -> str:
    """The figures of the manifest."""
    head = ["model", "call", "p50", "p95", "torch", "ratio"]
    lines = []
    for name, figures in models.items():
        other = [ms(figures["torch_p50_ms"]), f"{figures['ratio']:.1f} x"] if "ratio" in figures else ["", ""]
        lines.append([name, figures["call"], ms(figures["p50_ms"]), ms(figures["p95_ms"]), *other])
    return _table(head, lines)


def installed_table(installed: Mapping[str, Mapping[str, Any]]) -> str:
    """Fresh installations beside each other, as ``benchmarks/install.py`` measures them."""
    each = list(installed.values())
    rows = [["on the disk", *(f"{one['megabytes']:.0f} MB" for one in each)]]
    rows.append(["to the first sentence", *(_seconds(one["seconds"]) for one in each)])
    rows.append(["the same in the first process of all", *(_seconds(one["first_s"]) for one in each)])
    rows.append(["`motionrt retrieve`, whole command", *(_seconds(one["retrieve_s"]) for one in each)])
    rows.append(["largest, MB", *(_listed(one["largest"]) for one in each)])
    return _table(["", *installed], rows)


def _seconds(value: float | None) -> str:
    return "" if value is None else f"{value:.2f} s"


def _listed(sizes: Mapping[str, float]) -> str:
    return ", ".join(f"{name} {mb:.0f}" for name, mb in sizes.items())


def between(text: str, name: str, body: str) -> str:
    """``text`` with ``body`` between ``<!-- name -->`` and ``<!-- /name -->``.

    Raises:
        InvalidInputError: the text has no such markers, or more than one pair.
    """
    opening, closing = f"<!-- {name} -->", f"<!-- /{name} -->"
    found = re.compile(f"{re.escape(opening)}.*?{re.escape(closing)}", re.DOTALL)
    if len(found.findall(text)) != 1:
        raise InvalidInputError(f"expected one pair of lines {opening} and {closing}, with the table between them")
    return found.sub(lambda _: f"{opening}\n{body.strip()}\n{closing}", text)


def _limit_parts(run: Found) -> list[str]:
    limits = run.get("limits")
    if not limits:
        return []
    title = f"Limits, {_threads(run)}:"
    peaks = _table(tables.PEAKS, tables.peak_rows(limits["peaks"]))
    return [title, peaks, _table(tables.LIMITS, tables.limit_rows(limits))]


def _line(label: str, case: Found, rivals: Sequence[str], key: str = "p50_ms", scale: float = 1.0) -> list[str]:
    cells = [label, ms(case[key] * scale)]
    for name in rivals:
        other = case["against"].get(name)
        cells += [ms(other[key] * scale), f"{other['ratio']:.1f} x"] if other else ["", ""]
    return cells


def _perform_lines(run: Found, rivals: Sequence[str]) -> list[list[str]]:
    times, blank = run.get("perform_times_real_time"), ["", ""] * len(rivals)
    return [["perform a script, against real time", f"{times:.0f} x", *blank]] if times else []


def _cold_lines(run: Found, rivals: Sequence[str]) -> list[list[str]]:
    cold = run.get("cold_start")
    if not cold:
        return []
    lines = [_line("cold start to the first text", cold, rivals, "seconds", 1000)]
    if cold["peak_mb"] is not None:
        others = [cold["against"].get(name, {}).get("peak_mb") for name in rivals]
        cells = [cell for mb in others for cell in (f"{mb:.0f} MB" if mb else "", "")]
        lines.append(["peak memory, first text", f"{cold['peak_mb']:.0f} MB", *cells])
    return lines


def _installed_lines(found: Found, rivals: Sequence[str]) -> list[list[str]]:
    installed = found.get("installed")
    if not installed:
        return []
    ours, others = installed["motionrt"]["megabytes"], [installed.get(_title(name)) for name in rivals]
    ratios = [[f"{one['megabytes']:.0f} MB", f"{one['megabytes'] / ours:.1f} x"] if one else ["", ""] for one in others]
    return [["fresh installation, on the disk", f"{ours:.0f} MB", *(cell for pair in ratios for cell in pair)]]


def _caption(found: Found, run: Found) -> str:
    return f"{_machine(found)}, {_threads(run)}, medians:"


def _machine(found: Found) -> str:
    cores = found["machine"]["cores"]
    return f"{found['machine']['processor']}, {cores} core{'s' if cores > 1 else ''}"


def _threads(run: Found) -> str:
    return "one thread" if run["threads"] == 1 else f"{run['threads']} threads"


def _title(rival: str) -> str:
    return "torch + transformers" if rival == "transformers" else rival


def _table(head: Sequence[str], lines: Sequence[Sequence[str]]) -> str:
    rule = "|".join(["---", *["---:"] * (len(head) - 1)])
    return "\n".join([f"| {' | '.join(head)} |", f"|{rule}|", *(f"| {' | '.join(line)} |" for line in lines)])
