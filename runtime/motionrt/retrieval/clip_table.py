"""What a gallery remembers of its clips, as columns that may lie in a mapped file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from motionrt.errors import GalleryError
from motionrt.retrieval.head import LONGEST_S, SHA256, stays_below
from motionrt.retrieval.records import WINDOW_TYPE, Clip, WindowTable
from motionrt.retrieval.sequences import Lazy
from motionrt.retrieval.strings import Strings
from motionrt.untrusted import Fail
from motionrt.untrusted.safetensors import Columns, checked
from motionrt.untrusted.words import shown

Array = npt.NDArray[Any]
Numbers = npt.NDArray[np.integer[Any]]

_KINDS: dict[str, tuple[str, tuple[int | None, ...]]] = {
    "ids": ("U8", (None,)),
    "id_ends": ("I64", (None,)),
    "duration_s": ("F64", (None,)),
    "size": ("I64", (None,)),
    "mtime_ns": ("I64", (None,)),
    "sha256": ("U8", (None, 32)),
    "texts": ("U8", (None,)),
    "text_ends": ("I64", (None,)),
    "has_text": ("U8", (None,)),
    "animation": ("I32", (None,)),
    "windows": ("U8", (None, WINDOW_TYPE.itemsize)),
}
_FACTS = ("duration_s", "size", "mtime_ns", "sha256", "has_text", "animation")


class ClipTable(Lazy[Clip]):
    """Clips, one a row; their fields are those of :class:`~motionrt.retrieval.records.Clip`.

    Args:
        ids: of the clips.
        texts: of the clips, empty where ``has_text`` is 0.
        facts: ``duration_s``, ``size``, ``mtime_ns`` and ``has_text`` ``(N,)``, ``animation`` ``(N,)`` how many letters
            at the end of the id name the animation, -1 where the clip is all of its file, and ``sha256`` ``(N, 32)``
            uint8, zeros for a clip that is no file.
        ordered: whether the ids ascend.
        fail: makes the error for rows that cannot be.
    """

    def __init__(
        self, ids: Strings, texts: Strings, facts: Mapping[str, Array], *, ordered: bool, fail: Fail | None = None
    ) -> None:
        self.ids, self.texts, self.facts, self.ordered = ids, texts, facts, ordered
        self.duration_s, self.size, self.mtime_ns = (facts[name] for name in ("duration_s", "size", "mtime_ns"))
        self._fail = fail or (lambda reason, _: GalleryError(f"the gallery {reason}"))
        self._numbers: dict[str, int] | None = None

    @classmethod
    def of(cls, clips: Sequence[Clip]) -> ClipTable:
        """The clips as columns; GalleryError for a checksum that is none."""
        if isinstance(clips, ClipTable):
            return clips
        ids = [clip.id for clip in clips]
        odd = next((clip for clip in clips if clip.sha256 and not SHA256.fullmatch(clip.sha256)), None)
        if odd is not None:
            raise GalleryError(f"the checksum of the clip {shown(odd.id)} is no sha256: {shown(odd.sha256)}")
        sums = b"".join(bytes.fromhex(clip.sha256) if clip.sha256 else bytes(32) for clip in clips)
        facts: dict[str, Array] = {
            "duration_s": np.array([clip.duration_s for clip in clips], np.float64),
            "size": np.array([clip.size for clip in clips], np.int64),
            "mtime_ns": np.array([clip.mtime_ns for clip in clips], np.int64),
            "sha256": np.frombuffer(sums, np.uint8).reshape(-1, 32),
            "has_text": np.array([clip.text is not None for clip in clips], np.uint8),
            "animation": np.array([_animation_letters(clip) for clip in clips], np.int32),
        }
        ordered = all(a < b for a, b in pairwise(ids))
        return cls(Strings.of(ids), Strings.of(clip.text or "" for clip in clips), facts, ordered=ordered)

    @classmethod
    def joined(cls, parts: Sequence[ClipTable]) -> ClipTable:
        """The clips of all parts, one behind the other, in no order."""
        if len(parts) == 1:
            return parts[0]
        ids, texts = (Strings.joined([getattr(part, name) for part in parts]) for name in ("ids", "texts"))
        facts = {name: np.concatenate([part.facts[name] for part in parts]) for name in _FACTS}
        return cls(ids, texts, facts, ordered=False)

    def take(self, numbers: Numbers, *, ordered: bool) -> ClipTable:
        """The clips of these numbers; ``ordered`` says whether their ids ascend then."""
        facts = {name: column[numbers] for name, column in self.facts.items()}
        return ClipTable(self.ids.take(numbers), self.texts.take(numbers), facts, ordered=ordered)

    def stamped(self, numbers: Numbers, size: Numbers, mtime_ns: Numbers) -> ClipTable:
        """The same, but for other sizes and times of some clips."""
        sizes, times = self.size.copy(), self.mtime_ns.copy()
        sizes[numbers], times[numbers] = size, mtime_ns
        return ClipTable(self.ids, self.texts, {**self.facts, "size": sizes, "mtime_ns": times}, ordered=self.ordered)

    def __len__(self) -> int:
        return len(self.duration_s)

    def _item(self, index: int) -> Clip:
        checksum = self.facts["sha256"][index].tobytes()
        clip_id, letters = self.ids[index], int(self.facts["animation"][index])
        clip = Clip(
            clip_id,
            float(self.duration_s[index]),
            int(self.size[index]),
            int(self.mtime_ns[index]),
            checksum.hex() if any(checksum) else "",
            self.texts[index] if self.facts["has_text"][index] else None,
            None if letters < 0 else clip_id[len(clip_id) - letters :],
        )
        if clip.is_file and not stays_below(clip.file):
            raise self._fail(f"is damaged (the clip {shown(clip.id)} names a file outside the indexed folder)", None)
        return clip

    def files(self) -> list[str]:
        """The path of every clip's file below the indexed folder."""
        ids, letters = self.ids.texts(), self.facts["animation"]
        for row in np.flatnonzero(letters >= 0).tolist():
            ids[row] = ids[row][: len(ids[row]) - int(letters[row]) - 1]
        return ids

    def number(self, clip_id: str) -> int | None:
        """The row of a clip."""
        if self.ordered:
            return self.ids.find(clip_id)
        if self._numbers is None:
            self._numbers = {name: number for number, name in enumerate(self.ids.texts())}
        return self._numbers.get(clip_id)

    def below(self, folder: str) -> npt.NDArray[np.bool_]:
        """``(N,)`` which ids lie below a folder, or are its name."""
        name = folder.strip("/")
        found = np.zeros(len(self), dtype=bool)
        if not self.ordered:
            found[:] = [f"{clip_id}/".startswith(f"{name}/") for clip_id in self.ids.texts()]
            return found
        first, last = self.ids.beginning_with(f"{name}/")
        found[first:last] = True
        if (own := self.ids.find(name)) is not None:
            found[own] = True
        return found

    def columns(self, windows: WindowTable) -> Columns:
        """What a file holds of the clips and their windows."""
        return {
            **{name: self.facts[name] for name in _FACTS},
            "ids": self.ids.content,
            "id_ends": self.ids.ends,
            "texts": self.texts.content,
            "text_ends": self.texts.ends,
            "windows": np.ascontiguousarray(windows).view(np.uint8).reshape(-1, WINDOW_TYPE.itemsize),
        }


def _animation_letters(clip: Clip) -> int:
    """How many letters at the end of its id name its animation, -1 without one."""
    if clip.animation is None:
        return -1
    if not clip.id.endswith(f"#{clip.animation}"):
        raise GalleryError(f"the id of the clip {shown(clip.id)} does not end with its animation")
    return len(clip.animation)


def clips_of_columns(columns: Columns, ordered: bool, fail: Fail) -> tuple[ClipTable, WindowTable]:
    """Clips and windows of a file's columns, with all numbers in their bounds."""
    column = checked(columns, _KINDS, fail)
    count = len(column("duration_s"))
    durations, sizes = column("duration_s"), column("size")
    if any(len(column(name)) != count for name in _FACTS):
        raise fail("is damaged (its columns are not of the same length)", None)
    with np.errstate(invalid="ignore"):
        possible = ((durations >= 0) & (durations < LONGEST_S)).all() and (sizes >= 0).all()
    if not possible:
        raise fail("is damaged (a clip has an impossible length or size)", None)
    ids = Strings(column("ids"), column("id_ends")).check(fail, count)
    texts = Strings(column("texts"), column("text_ends")).check(fail, count)
    table = ClipTable(ids, texts, {name: column(name) for name in _FACTS}, ordered=ordered, fail=fail)
    if (column("animation") >= np.diff(column("id_ends"), prepend=0)).any():
        raise fail("is damaged (the name of an animation is longer than its clip's)", None)
    return table, column("windows").reshape(-1).view(WINDOW_TYPE)
