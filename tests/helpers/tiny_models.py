"""The tiny models of the fixtures, and copies of them that a test may damage."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import yaml

TINY = Path(__file__).parents[1] / "fixtures" / "models"
TINY_GENERATORS = TINY.parent / "generators"  # those that make motion of text


def copy_tiny(folder: Path) -> Path:
    """A copy of the tiny models in `folder`."""
    return Path(shutil.copytree(TINY, folder / "models"))


def edited(folder: Path, change: Callable[[dict[str, Any]], object]) -> Path:
    """A copy of the tiny models whose manifest went through `change`; gives the manifest."""
    manifest = copy_tiny(folder) / "models_manifest.yaml"
    content = yaml.safe_load(manifest.read_text(encoding="utf-8"))
    change(content)
    manifest.write_text(yaml.safe_dump(content, sort_keys=False), encoding="utf-8")
    return manifest
