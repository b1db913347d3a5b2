"""Where the exported files go."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from motionrt_export.optimise import is_shipped


@dataclass(frozen=True)
class Layout:
    """Where the files go; `out` (shipped) and `build` (not shipped) lie beneath the manifest's folder."""

    manifest: Path
    out: Path
    build: Path

    @property
    def root(self) -> Path:
        """The folder that files in the manifest are relative to."""
        return self.manifest.parent

    @property
    def draft(self) -> Path:
        """The manifest while not everything is proven."""
        return self.manifest.with_name(f"{self.manifest.stem}.draft.yaml")

    def file(self, model: str, variant: str) -> Path:
        """The ONNX file of a variant."""
        return (self.out if is_shipped(model, variant) else self.build) / f"{model}.{variant}.onnx"

    def tidy(self, model: str, variant: str) -> None:
        """Remove the file of a variant from where it does not belong, such as one that shipped once."""
        for folder in {self.out, self.build}:
            path = folder / f"{model}.{variant}.onnx"
            if path != self.file(model, variant):
                path.unlink(missing_ok=True)
