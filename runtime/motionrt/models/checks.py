"""Checksums: a file is opened only when its sha256 is the one that the manifest gives."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path

from motionrt.errors import ChecksumError, ModelFileError
from motionrt.models.external import names_other_files
from motionrt.models.manifest import Manifest, Tokenizer, Variant
from motionrt.untrusted.files import read_bytes


def verified(manifest: Manifest, entry: Variant | Tokenizer) -> bytes:
    """The content of a file that the manifest names: what is opened are these bytes, not the file again.

    Raises:
        ModelFileError: the file is missing or unreadable.
        ChecksumError: it is another file; gives its path, checksum and size, expected and found. Or it keeps weights in
            a second file, which no checksum covers.
    """
    path = manifest.locate(entry.file)
    content = _content_of(path, shipped=_is_shipped(entry))
    found, size = hashlib.sha256(content).hexdigest(), len(content)
    if (found, size) != (entry.sha256, entry.bytes):
        expected = f"sha256 expected {entry.sha256} ({entry.bytes} bytes), found {found} ({size} bytes)"
        raise ChecksumError(f"{path}: {expected}: {_guess(manifest, entry, found, size)}; {_remedy(entry)}")
    if isinstance(entry, Variant) and names_other_files(content):
        raise ChecksumError(f"{path} keeps weights in another file, which is not read; export the model as one file")
    return content


def _is_shipped(entry: Variant | Tokenizer) -> bool:
    return not isinstance(entry, Variant) or entry.shipped


def _guess(manifest: Manifest, entry: Variant | Tokenizer, found: str, size: int) -> str:
    """What happened to a file, in words."""
    for model in manifest.models.values():
        for variant in model.variants.values():
            if variant.sha256 == found and variant is not entry:
                return f"this is the {variant.name} file of {model.name}, under another name"
    if found == entry.sha256:
        return "the file is whole, but the manifest gives another size: the manifest was changed"
    return "the file is cut short" if size < entry.bytes else "the file is damaged or was exchanged"


def _remedy(entry: Variant | Tokenizer) -> str:
    build = "build it again, in a checkout: python -m motionrt_export all"
    return "install motionrt again, or export the models again" if _is_shipped(entry) else build


def _content_of(path: Path, *, shipped: bool) -> bytes:
    remedy = (
        "install motionrt again"
        if shipped
        else "this variant is not shipped; in a checkout build it with: python -m motionrt_export all"
    )
    try:
        return read_bytes(path, lambda reason, _: ModelFileError(f"cannot read {path}: it {reason}; {remedy}"))
    except FileNotFoundError as error:
        raise ModelFileError(f"cannot read {path}: {error.strerror or error}; {remedy}") from error


@dataclass(frozen=True)
class FileReport:
    """What ``verify`` found of one file.

    Attributes:
        model: whose file it is.
        variant: which one, or ``tokenizer``.
        path: where it is looked for.
        expected: the sha256 of the manifest.
        found: that of the file, ``None`` where there is none.
        expected_bytes: the size of the manifest.
        bytes: that of the file, ``None`` where there is none.
        state: ``ok``, ``missing``, ``damaged`` or ``not built``.
        problem: what is wrong and what to do, in words; empty where nothing is.
    """

    model: str
    variant: str
    path: Path
    expected: str
    found: str | None
    expected_bytes: int
    bytes: int | None
    state: str
    problem: str

    @property
    def ok(self) -> bool:
        """False for a file that ought to be there and is missing or damaged."""
        return self.state in ("ok", "not built")


def verify(manifest: Manifest) -> list[FileReport]:
    """Hash every file of the manifest; a variant that is not shipped may be absent (``not built``)."""
    return [
        _report(manifest, model.name, name, entry)
        for model in manifest.models.values()
        for name, entry in (*model.variants.items(), ("tokenizer", model.tokenizer))
        if entry is not None
    ]


def _report(manifest: Manifest, model: str, name: str, entry: Variant | Tokenizer) -> FileReport:
    path, shipped = manifest.locate(entry.file), _is_shipped(entry)
    found: tuple[str, int] | tuple[None, None] = (None, None)
    try:
        content = _content_of(path, shipped=shipped)
        found = hashlib.sha256(content).hexdigest(), len(content)
        verified(manifest, entry)
    except ModelFileError as error:
        state, problem = "missing" if shipped else "not built", str(error)
    except ChecksumError as error:
        state, problem = "damaged", str(error)
    else:
        state, problem = "ok", ""
    return FileReport(model, name, path, entry.sha256, found[0], entry.bytes, found[1], state, problem)
