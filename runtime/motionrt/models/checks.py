"""Checksums: a file is opened only when its sha256 is the one that the manifest gives."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from motionrt.errors import ChecksumError, ModelFileError
from motionrt.models.manifest import Manifest, Variant

_CHUNK = 1 << 18


def verified(manifest: Manifest, file: str, sha256: str, *, shipped: bool = True) -> Path:
    """The path of a file that the manifest names; hashed once per process, again when it changes.

    Raises:
        ModelFileError: the file is missing or unreadable.
        ChecksumError: its sha256 is another; gives file, expected and found.
    """
    path = manifest.locate(file)
    found, size = _digest_of(path, shipped=shipped)
    if found != sha256:
        raise ChecksumError(
            f"{path}: sha256 expected {sha256}, found {found} ({size} bytes): the file is damaged or was "
            "exchanged; install motionrt again, or export the models again"
        )
    return path


def _digest_of(path: Path, *, shipped: bool) -> tuple[str, int]:
    try:
        state = path.stat()
        return _digest(path, state.st_mtime_ns, state.st_size), state.st_size
    except OSError as error:
        remedy = (
            "install motionrt again"
            if shipped
            else "this variant is not shipped; in a checkout build it with: python -m motionrt_export all"
        )
        raise ModelFileError(f"cannot read {path}: {error.strerror or error}; {remedy}") from error


@lru_cache(maxsize=64)
def _digest(path: Path, changed_ns: int, size: int) -> str:  # noqa: ARG001  # they make a changed file another key
    digest = hashlib.sha256()
    with path.open("rb") as file:
        while chunk := file.read(_CHUNK):
            digest.update(chunk)
    return digest.hexdigest()


@dataclass(frozen=True)
class FileReport:
    """What ``verify`` found of one file; ``state`` is ``ok``, ``missing``, ``damaged`` or ``not built``."""

    model: str
    variant: str
    path: Path
    expected: str
    found: str | None
    bytes: int | None
    state: str

    @property
    def ok(self) -> bool:
        """False for a file that ought to be there and is missing or damaged."""
        return self.state in ("ok", "not built")


def verify(manifest: Manifest) -> list[FileReport]:
    """Hash every file of the manifest; a variant that is not shipped may be absent (``not built``)."""
    _digest.cache_clear()
    reports = []
    for model in manifest.models.values():
        reports += [_report(manifest, model.name, variant) for variant in model.variants.values()]
        if model.tokenizer is not None:
            file, sha256 = model.tokenizer.file, model.tokenizer.sha256
            reports.append(_report_file(model.name, "tokenizer", manifest.locate(file), sha256, shipped=True))
    return reports


def _report(manifest: Manifest, model: str, variant: Variant) -> FileReport:
    path = manifest.locate(variant.file)
    return _report_file(model, variant.name, path, variant.sha256, shipped=variant.shipped)


def _report_file(model: str, variant: str, path: Path, expected: str, *, shipped: bool) -> FileReport:
    try:
        found, size = _digest_of(path, shipped=shipped)
    except ModelFileError:
        return FileReport(model, variant, path, expected, None, None, "missing" if shipped else "not built")
    return FileReport(model, variant, path, expected, found, size, "ok" if found == expected else "damaged")
