"""``models/figures.yaml``: what was measured once, and belongs into the manifest every time that it is written.

    made: on what machine, when, by which commands
    benchmark: {model: {variant: {p50_ms: ..., torch_p50_ms: ..., call: ...}}}
    quality: {model: {variant: {measure: number}}}

Times are never the same twice, and quality takes many minutes: both stand in a committed file that people can read, so
that the same checkpoints and the same file give the same manifest, byte for byte.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from motionrt_export.optimise import CHOICES, variants

NAME = "figures.yaml"
HEADING = """# Measured figures of the exported models; they go into models_manifest.yaml when the models are exported.
# benchmark: python -m motionrt_export time
# quality: python benchmarks/variants.py SCENES --figures models/figures.yaml
"""

Rows = Mapping[str, Mapping[str, Mapping[str, Any]]]  # model -> variant -> figures


@dataclass(frozen=True)
class Measured:
    """Figures of variants; `made` says how they came to be."""

    benchmark: Rows = field(default_factory=dict)
    quality: Rows = field(default_factory=dict)
    made: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def read(cls, path: Path) -> Measured:
        """The figures of a file; none where there is no file.

        Raises:
            ValueError: an unknown section, model or variant, or something else than figures.
        """
        if not path.is_file():
            return cls()
        content = yaml.safe_load(path.read_text(encoding="utf-8")) or {}
        if unknown := sorted({*content} - {"benchmark", "quality", "made"}):
            raise ValueError(f"{path}: unknown section {', '.join(unknown)}; there are made, benchmark and quality")
        for section in ("benchmark", "quality"):
            _check(path, section, content.get(section) or {})
        return cls(content.get("benchmark") or {}, content.get("quality") or {}, content.get("made") or {})

    def write(self, path: Path) -> None:
        """Write the figures, models and variants in the order of the manifest."""
        content = {"made": dict(self.made)} | {
            section: _sorted(rows) for section, rows in (("benchmark", self.benchmark), ("quality", self.quality))
        }
        text = yaml.safe_dump(content, sort_keys=False, allow_unicode=True, width=110, default_flow_style=None)
        path.write_bytes((HEADING + text).encode("utf-8"))

    def of(self, section: str, model: str, variant: str) -> Mapping[str, Any]:
        """The figures of one variant, which may be none."""
        rows: Rows = getattr(self, section)
        return rows.get(model, {}).get(variant, {})


def _check(path: Path, section: str, rows: Any) -> None:
    for model, found in rows.items():
        if model not in CHOICES:
            raise ValueError(f"{path}, {section}: there is no model '{model}'; there are {', '.join(CHOICES)}")
        for variant, figures in found.items():
            if variant not in variants(model):
                raise ValueError(f"{path}, {section}: {model} has no variant '{variant}'")
            if not all(isinstance(value, str | int | float) for value in figures.values()):
                raise ValueError(f"{path}, {section}: {model} {variant} holds something else than numbers and words")


def _sorted(rows: Rows) -> dict[str, dict[str, dict[str, Any]]]:
    return {
        model: {variant: dict(rows[model][variant]) for variant in variants(model) if variant in rows[model]}
        for model in CHOICES
        if model in rows
    }
