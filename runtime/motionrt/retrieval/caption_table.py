"""Words that a library carries about its clips, as columns that may lie in a mapped file."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from motionrt.retrieval.records import Caption
from motionrt.retrieval.sequences import Lazy
from motionrt.retrieval.strings import Strings
from motionrt.untrusted import Fail
from motionrt.untrusted.safetensors import Columns, checked

Array = npt.NDArray[Any]

_KINDS: dict[str, tuple[str, tuple[int | None, ...]]] = {
    "clip": ("U32", (None,)),
    "start_s": ("F64", (None,)),
    "end_s": ("F64", (None,)),
    "texts": ("U8", (None,)),
    "text_ends": ("I64", (None,)),
    "tags": ("U8", (None,)),
    "tag_ends": ("I64", (None,)),
    "tagged": ("U32", (None,)),
    "tagged_ends": ("I64", (None,)),
}


class CaptionTable(Lazy[Caption]):
    """Captions, one a row.

    Args:
        ids: of the clips that they are about.
        clip: ``(C,)`` number of the clip.
        start_s, end_s: ``(C,)`` the part that a caption is about; NaN is none.
        texts: of the captions.
        tags: all different tags.
        tagged: ``(T,)`` numbers of the tags of the captions, one caption's behind the other's.
        tagged_ends: ``(C,)`` where those of each caption end.
    """

    def __init__(
        self, ids: Sequence[str], clip: Array, start_s: Array, end_s: Array, texts: Strings, tags: Strings,
        tagged: Array, tagged_ends: Array,
    ) -> None:  # fmt: skip
        self._ids, self.clip, self.start_s, self.end_s = ids, clip, start_s, end_s
        self.texts, self.tags, self.tagged, self.tagged_ends = texts, tags, tagged, tagged_ends

    @classmethod
    def of(cls, captions: Iterable[Caption], ids: Sequence[str]) -> CaptionTable:
        """The captions of the clips of those ids; what is about others is left out."""
        told = list(captions)
        numbers = {name: number for number, name in enumerate(ids)} if told else {}
        known = [caption for caption in told if caption.clip in numbers]
        names = {tag: number for number, tag in enumerate(dict.fromkeys(tag for c in known for tag in c.tags))}
        nan = float("nan")
        return cls(
            ids,
            np.array([numbers[c.clip] for c in known], np.uint32),
            np.array([nan if c.start_s is None else c.start_s for c in known], np.float64),
            np.array([nan if c.end_s is None else c.end_s for c in known], np.float64),
            Strings.of(c.text for c in known),
            Strings.of(names),
            np.array([names[tag] for c in known for tag in c.tags], np.uint32),
            np.cumsum([len(c.tags) for c in known], dtype=np.int64),
        )

    @classmethod
    def of_columns(cls, columns: Columns, ids: Strings, fail: Fail) -> CaptionTable:
        """Those of a file, about the clips of those ids, with all numbers in their bounds."""
        column = checked(columns, _KINDS, fail)
        clip, tagged, ends = column("clip"), column("tagged"), column("tagged_ends")
        count = len(clip)
        texts = Strings(column("texts"), column("text_ends")).check(fail, count)
        tags = Strings(column("tags"), column("tag_ends")).check(fail, len(column("tag_ends")))
        whole = len(column("start_s")) == len(column("end_s")) == len(ends) == count
        whole = whole and int(ends[-1] if count else 0) == len(tagged) and bool((np.diff(ends, prepend=0) >= 0).all())
        if not whole or clip.max(initial=0) >= max(len(ids), 1) or tagged.max(initial=0) >= max(len(tags), 1):
            raise fail("is damaged (its captions are not of its clips)", None)
        if np.isinf(column("start_s")).any() or np.isinf(column("end_s")).any():
            raise fail("is damaged (a caption has no beginning or no end)", None)
        return cls(ids, clip, column("start_s"), column("end_s"), texts, tags, tagged, ends)

    def columns(self) -> Columns:
        """What a file holds of them."""
        return {
            "clip": self.clip,
            "start_s": self.start_s,
            "end_s": self.end_s,
            "texts": self.texts.content,
            "text_ends": self.texts.ends,
            "tags": self.tags.content,
            "tag_ends": self.tags.ends,
            "tagged": self.tagged,
            "tagged_ends": self.tagged_ends,
        }

    def __len__(self) -> int:
        return len(self.clip)

    def _item(self, index: int) -> Caption:
        first = int(self.tagged_ends[index - 1]) if index else 0
        tags = tuple(self.tags[int(tag)] for tag in self.tagged[first : int(self.tagged_ends[index])])
        start, end = (_seconds(column[index]) for column in (self.start_s, self.end_s))
        return Caption(self._ids[int(self.clip[index])], self.texts[index], start, end, tags)

    def tagged_with(self, tag: str, clips: int) -> npt.NDArray[np.bool_]:
        """``(clips,)`` which clips have a tag, whatever its case."""
        wanted = [number for number, name in enumerate(self.tags.texts()) if name.lower() == tag.lower()]
        places = np.flatnonzero(np.isin(self.tagged, np.array(wanted, np.uint32)))
        found = np.zeros(clips, dtype=bool)
        found[self.clip[np.searchsorted(self.tagged_ends, places, side="right")]] = True
        return found


def _seconds(value: float) -> float | None:
    return None if np.isnan(value) else float(value)
