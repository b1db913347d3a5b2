"""Lists of captions, and their embeddings on disk."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np

from motionrt.errors import FormatError, InvalidInputError
from motionrt.formats.atomic import write_atomically
from motionrt.motion.skeleton import FloatArray
from motionrt.untrusted.arguments import listed
from motionrt.untrusted.files import as_path, read_utf8
from motionrt.untrusted.npz import read_arrays

_ARRAYS = ("texts", "embeddings", "fingerprint")


@dataclass(frozen=True, eq=False)
class EmbeddedCaptions:
    """Texts with their embeddings.

    Attributes:
        texts: ``N`` captions.
        embeddings: ``(N, 256)`` float32 unit vectors.
        fingerprint: of the model that embedded them.
    """

    texts: tuple[str, ...]
    embeddings: FloatArray
    fingerprint: str

    def save(self, path: str | Path) -> Path:
        """Write an ``.npz`` (half precision), so that the captions need not be embedded again."""

        def write(file: BinaryIO) -> None:
            np.savez_compressed(
                file,
                texts=np.array("\n".join(self.texts)),
                embeddings=self.embeddings.astype(np.float16),
                fingerprint=np.array(self.fingerprint),
            )

        return write_atomically(path, write)

    @classmethod
    def read(cls, path: Path, fingerprint: str) -> EmbeddedCaptions | None:
        """What :meth:`save` wrote; ``None`` if it is not there, cannot be read, or another model made it."""
        try:
            data, _ = read_arrays(path, lambda reason, line: FormatError(path, reason, line), _ARRAYS)
        except (OSError, FormatError):
            return None
        if set(data) != set(_ARRAYS) or data["embeddings"].ndim != 2 or data["embeddings"].dtype.kind != "f":
            return None
        texts, made_by = str(data["texts"]).split("\n"), str(data["fingerprint"])
        embeddings = data["embeddings"].astype(np.float32)
        if made_by != fingerprint or len(texts) != len(embeddings):
            return None
        return cls(tuple(texts), embeddings, made_by)


def read_captions(path: str | Path) -> list[str]:
    """Captions from a UTF-8 text file, one a line; empty lines and lines starting with ``#`` do not count.

    Raises:
        InvalidInputError: the file is missing, not UTF-8, or holds no caption.
    """
    path = as_path(path)
    try:
        lines = read_utf8(
            path, lambda reason, _: InvalidInputError(f"cannot read captions: {path} {reason}")
        ).splitlines()
    except FileNotFoundError as error:
        raise InvalidInputError(f"cannot read captions from {path}: {error.strerror}") from error
    captions = [line.strip() for line in lines if line.strip() and not line.lstrip().startswith("#")]
    if not captions:
        raise InvalidInputError(f"{path} holds no captions; write one a line")
    return list(dict.fromkeys(captions))


def checked_captions(captions: Sequence[str]) -> tuple[str, ...]:
    """A caption list as a tuple; InvalidInputError when it is empty or holds anything but texts."""
    texts = listed(captions, "captions", "texts")
    if not texts or not all(isinstance(text, str) for text in texts):
        raise InvalidInputError("captions must be a list with at least one text")
    return tuple(texts)
