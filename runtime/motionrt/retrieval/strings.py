"""Many texts in two arrays: their bytes, one behind the other, and where each ends."""

from __future__ import annotations

import bisect
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from motionrt.retrieval.sequences import Lazy
from motionrt.untrusted import Fail

Bytes = npt.NDArray[np.uint8]
Ends = npt.NDArray[np.int64]


class Strings(Lazy[str]):
    """Texts in UTF-8; bytes of file names that are no Unicode are lone surrogates, as everywhere in Python.

    Args:
        content: ``(B,)`` bytes.
        ends: ``(N,)`` where each text ends in them.
        fail: makes the error for bytes that are no text.
    """

    def __init__(self, content: Bytes, ends: Ends, fail: Fail | None = None) -> None:
        self.content, self.ends = content, ends
        self._fail = fail

    @classmethod
    def of(cls, texts: Iterable[str]) -> Strings:
        """The texts, packed."""
        return cls._packed([text.encode("utf-8", "surrogatepass") for text in texts])

    @classmethod
    def joined(cls, parts: Sequence[Strings]) -> Strings:
        """Those of all parts, one behind the other."""
        return cls._packed([text for part in parts for text in part.pieces()])

    @classmethod
    def _packed(cls, pieces: list[bytes]) -> Strings:
        ends = np.cumsum([len(piece) for piece in pieces], dtype=np.int64)
        return cls(np.frombuffer(b"".join(pieces), np.uint8), ends)

    def check(self, fail: Fail, count: int) -> Strings:
        """These, if they are ``count`` texts that lie in their bytes."""
        ends = self.ends
        whole = len(ends) == count and int(ends[-1] if count else 0) == len(self.content)
        if not whole or (count and (ends[0] < 0 or bool((np.diff(ends) < 0).any()))):
            raise fail("is damaged (its texts do not lie one behind the other)", None)
        return Strings(self.content, ends, fail)

    def __len__(self) -> int:
        return len(self.ends)

    def _item(self, index: int) -> str:
        try:
            return self.piece(index).decode("utf-8", "surrogatepass")
        except UnicodeDecodeError as error:
            if self._fail is None:
                raise
            raise self._fail(f"is damaged (one of its texts is not UTF-8: {error.reason})", None) from error

    def piece(self, index: int) -> bytes:
        """The bytes of a text."""
        start = int(self.ends[index - 1]) if index else 0
        return self.content[start : int(self.ends[index])].tobytes()

    def pieces(self) -> list[bytes]:
        """The bytes of all."""
        content, ends = self.content.tobytes(), self.ends.tolist()
        return [content[start:end] for start, end in zip([0, *ends], ends, strict=False)]

    def texts(self) -> list[str]:
        """All of them, which is faster than one by one."""
        try:
            return [piece.decode("utf-8", "surrogatepass") for piece in self.pieces()]
        except UnicodeDecodeError:
            return list(self)  # names the error

    def take(self, numbers: npt.NDArray[np.integer[Any]]) -> Strings:
        """Those of the given numbers."""
        pieces = self.pieces()
        return self._packed([pieces[number] for number in numbers.tolist()])

    def find(self, text: str) -> int | None:
        """The number of a text; the texts are in order."""
        wanted = text.encode("utf-8", "surrogatepass")
        place = self._place(wanted)
        return place if place < len(self) and self.piece(place) == wanted else None

    def beginning_with(self, text: str) -> tuple[int, int]:
        """First and last (exclusive) of those that begin with a text; the texts are in order."""
        wanted = text.encode("utf-8", "surrogatepass")
        return self._place(wanted), self._place(wanted + b"\xff")  # no byte of UTF-8 is as large

    def _place(self, wanted: bytes) -> int:
        return bisect.bisect_left(range(len(self)), wanted, key=self.piece)
