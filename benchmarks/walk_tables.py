"""Walks as Markdown tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields

import numpy as np
from walk_rows import Recorded, Row, Spell

_SCALES = ((100, 1), (1, 2), (100, 1))  # of the figures of a spell, and places behind the point


def table(rows: Sequence[Row]) -> str:
    """One line a walk, and one of all together: means weighted with time, the worst of what must not happen once."""
    head = (
        "| path | m | s | waypoints | off path, mean (cm) | most | off goal (cm) | skate (cm/frame) | unlocked | "
        "jerk (m/s³) | pelvis drift (cm) | × real time |"
    )
    lines = [head, "|" + "---|" * 12, *map(_line, rows)]
    return "\n".join([*lines, _line(together(rows))] if rows else lines)


def _line(row: Row) -> str:
    cells = (
        row.scene,
        f"{row.length_m:.0f}",
        f"{row.seconds:.0f}",
        f"{100 * row.waypoints:.1f} %",
        f"{100 * row.off_path_m:.1f}",
        f"{100 * row.off_path_max_m:.0f}",
        f"{100 * row.goal_m:.1f}",
        f"{row.skate_cm:.2f}",
        f"{row.skate_unlocked_cm:.2f}",
        f"{row.jerk:.0f}",
        f"{row.height_drift_cm:+.1f}",
        f"{row.times_real_time:.1f}",
    )
    return f"| {' | '.join(cells)} |"


def together(rows: Sequence[Row]) -> Row:
    """All walks as one row."""
    weights = [row.seconds for row in rows]

    def mean(name: str) -> float:
        return float(np.average([getattr(row, name) for row in rows], weights=weights))

    worst_drift = max((row.height_drift_cm for row in rows), key=abs)
    values = {each.name: mean(each.name) for each in fields(Row) if each.name not in {"scene", "first", "last"}}
    values |= {"length_m": sum(row.length_m for row in rows), "seconds": sum(weights), "height_drift_cm": worst_drift}
    values |= {name: max(getattr(row, name) for row in rows) for name in ("off_path_max_m", "goal_m")}
    first, last = (_mean_spell([getattr(row, end) for row in rows]) for end in ("first", "last"))
    return Row("all", first=first, last=last, **values)


def _mean_spell(spells_: Sequence[Spell]) -> Spell:
    return Spell(*(float(np.mean([getattr(spell, each.name) for spell in spells_])) for each in fields(Spell)))


def drift_table(rows: Sequence[Row]) -> str:
    """The first 30 s against the last 30 s."""
    head = "| path | off path (cm), first 30 s | last | skate (cm/frame), first | last | pelvis (cm), first | last |"
    lines = [head, "|" + "---|" * 7]
    for row in [*rows, together(rows)] if rows else []:
        pairs = [(getattr(row.first, each.name), getattr(row.last, each.name)) for each in fields(Spell)]
        cells = [
            f"{scale * value:.{places}f}"
            for pair, (scale, places) in zip(pairs, _SCALES, strict=True)
            for value in pair
        ]
        lines.append(f"| {row.scene} | {' | '.join(cells)} |")
    return "\n".join(lines)


def mocap_line(mocap: Recorded) -> str:
    """What recorded walks have."""
    return (
        f"Recorded plain walks ({mocap.trials} trials, {mocap.seconds:.0f} s, brought onto flat ground, 30 fps): foot "
        f"skate {mocap.skate_cm:.2f} cm/frame ({mocap.skate_locked_cm:.2f} with locked feet), jerk {mocap.jerk:.0f} "
        f"m/s³, pelvis at {mocap.height_m:.2f} m."
    )
