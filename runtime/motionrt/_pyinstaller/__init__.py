"""Tells PyInstaller what belongs to motionrt: models, galleries, and the modules that are imported when first used."""

from __future__ import annotations

from pathlib import Path


def get_hook_dirs() -> list[str]:
    """Folders with PyInstaller hooks; called through the entry point ``pyinstaller40``."""
    return [str(Path(__file__).parent)]
