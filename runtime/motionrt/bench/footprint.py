"""What is installed for the base install, package by package, and how much of the disk it takes."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from importlib import metadata
from pathlib import Path

_NAME = re.compile(r"[A-Za-z0-9._-]+")


def install_sizes(package: str = "motionrt") -> dict[str, float]:
    """MB on disk of a package and of all that it requires without extras, largest first, compiled bytecode apart.
    Packages that are not installed are left out.
    """
    sizes = {name: _mb(distribution) for name, distribution in _closure(package).items()}
    if package == "motionrt" and package in sizes:
        sizes[package] = max(sizes[package], _own_mb())
    return dict(sorted(sizes.items(), key=lambda item: -item[1]))


def _closure(package: str) -> dict[str, metadata.Distribution]:
    found: dict[str, metadata.Distribution] = {}
    waiting = [package]
    while waiting:
        name = _normal(waiting.pop())
        if name in found:
            continue
        try:
            found[name] = metadata.distribution(name)
        except metadata.PackageNotFoundError:  # a requirement of another system or Python
            continue
        waiting += _requirements(found[name])
    return found


def _requirements(distribution: metadata.Distribution) -> Iterator[str]:
    for line in distribution.requires or ():
        required, _, marker = line.partition(";")
        match = _NAME.match(required)
        if match and "extra" not in marker:
            yield match.group()


def _normal(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def _mb(distribution: metadata.Distribution) -> float:
    paths = {Path(str(distribution.locate_file(file))) for file in distribution.files or ()}
    return _sum_mb(paths)


def _own_mb() -> float:
    """Of motionrt in a checkout, where the installed files only point there: its code, and its models."""
    from motionrt.models import find_manifest, load_manifest

    package = Path(__file__).resolve().parent.parent
    manifest = load_manifest(find_manifest(None))
    shipped = {v.file for model in manifest.models.values() for v in model.variants.values() if v.shipped}
    files = set(package.rglob("*"))
    models = {manifest.locate(file) for file in shipped}
    return _sum_mb(files | models)


def _sum_mb(paths: Iterable[Path]) -> float:
    files = (path for path in paths if path.is_file() and "__pycache__" not in path.parts)
    return sum(path.stat().st_size for path in files) / 1e6
