"""Which clips of a folder were indexed before, and what of that still holds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from motionrt.retrieval.growth import without
from motionrt.retrieval.scan import Stamp
from motionrt.retrieval.segments import Segment

Place = tuple[int, int]
"""Where a clip is: the number of its segment, and its own in there."""


@dataclass
class Known:
    """The clips of some segments by id, and which of them are kept.

    Attributes:
        segments: what was indexed before.
        places: id -> where it is.
        kept: the places of what still holds.
        stamps: new sizes and times of files that were only touched.
    """

    segments: Sequence[Segment]
    places: dict[str, Place] = field(default_factory=dict)
    kept: set[Place] = field(default_factory=set)
    stamps: dict[Place, Stamp] = field(default_factory=dict)

    @classmethod
    def of(cls, segments: Sequence[Segment]) -> Known:
        """All clips of the segments that count; of two with the same id the last."""
        known = cls(segments)
        for number, part in enumerate(segments):
            ids = part.clips.ids.texts()
            rows = range(len(ids)) if part.kept_clips is None else part.kept_clips.tolist()
            known.places |= {ids[row]: (number, row) for row in rows}
        return known

    def keep(self, clip_id: str, stamp: Stamp) -> bool:
        """Whether the file is what was indexed, by its size and time; it is kept then."""
        place = self._complete(clip_id)
        if place is None or self._stamps[place[0]][place[1]] != stamp:
            return False
        self.kept.add(place)
        return True

    def touched(self, clip_id: str, stamp: Stamp) -> None:
        """Keep a clip whose file has another size or time, but the same content."""
        place = self.places[clip_id]
        self.kept.add(place)
        self.stamps[place] = stamp

    def checksum(self, clip_id: str) -> str | None:
        """What the file's checksum was; None where it has to be read in any case."""
        place = self._complete(clip_id)
        return None if place is None else self.segments[place[0]].clips[place[1]].sha256

    def remaining(self) -> tuple[list[Segment], list[Segment]]:
        """The segments that changed, without what is no longer kept; and those that did not."""
        changed, unchanged = [], []
        for number, part in enumerate(self.segments):
            rows = range(len(part.clips)) if part.kept_clips is None else part.kept_clips.tolist()
            gone = [row for row in rows if (number, row) not in self.kept]
            stamps = {row: stamp for (owner, row), stamp in self.stamps.items() if owner == number}
            if not gone and not stamps:
                unchanged.append(part)
                continue
            left = without(part, np.array(gone, np.int64)) if gone else part
            changed.append(_stamped(left, stamps) if stamps else left)
        return changed, unchanged

    def _complete(self, clip_id: str) -> Place | None:
        """Where a clip is; None of those without attributes, whose files are read again."""
        place = self.places.get(clip_id)
        return None if place is None or self.segments[place[0]].attributes is None else place

    @cached_property
    def _stamps(self) -> list[list[Stamp]]:
        """Size and time of every clip of every segment."""
        tables = [part.clips for part in self.segments]
        return [list(zip(table.size.tolist(), table.mtime_ns.tolist(), strict=True)) for table in tables]


def _stamped(part: Segment, stamps: dict[int, Stamp]) -> Segment:
    part.check(None, "clips")
    rows = np.array(list(stamps), np.int64)
    sizes, times = (np.array([stamp[k] for stamp in stamps.values()], np.int64) for k in (0, 1))
    files = {role: name for role, name in part.files.items() if role != "clips"}
    return replace(part, clips=part.clips.stamped(rows, sizes, times), files=files)
