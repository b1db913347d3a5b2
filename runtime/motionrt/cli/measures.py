"""Measures of walking and acting, as the commands print them."""

from __future__ import annotations

from collections.abc import Mapping

from motionrt.cli.console import print_table


def print_measures(measures: Mapping[str, float | int | None]) -> None:
    """A short table of those that there are."""
    from motionrt.metrics.labelled import HEADER, labelled

    print_table(HEADER, labelled(measures), "<><")


def rounded(measures: Mapping[str, float | int | None]) -> dict[str, float | int | None]:
    """For ``--json``: six digits behind the point."""
    return {name: round(value, 6) if isinstance(value, float) else value for name, value in measures.items()}
