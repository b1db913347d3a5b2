"""Which clips of a folder were indexed before, and what of that still holds."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from motionrt.formats.folder import Stamp
from motionrt.retrieval.growth import without
from motionrt.retrieval.records import Skipped
from motionrt.retrieval.segments import Segment

Place = tuple[int, int]
"""Where a clip is: the number of its segment, and its own in there."""


@dataclass
class Known:
    """The clips of some segments by file, and which of them are kept.

    Attributes:
        segments: what was indexed before; of a file in several of them the last counts that is as the file is now.
        again: files that are read in any case.
        kept: the places of what still holds.
        stamps: new sizes and times of files that were only touched.
    """

    segments: Sequence[Segment]
    again: frozenset[str] = frozenset()
    kept: set[Place] = field(default_factory=set)
    stamps: dict[Place, Stamp] = field(default_factory=dict)

    @classmethod
    def of(cls, segments: Sequence[Segment], skipped: Iterable[Skipped]) -> Known:
        """All clips of the segments that count, but for those of files of which an animation was skipped."""
        paths = [one.path for one in skipped]
        marks = [(path, place) for path in paths for place, letter in enumerate(path) if letter == "#"]
        return cls(segments, frozenset(path[:place] for path, place in marks))

    def keep(self, file: str, stamp: Stamp) -> bool:
        """Whether the file is what was indexed, by its size and time; its clips are kept then."""
        for number in reversed(range(len(self.segments))):
            rows = self._rows[number].get(file)
            if rows and all(self._stamps[number][row] == stamp for row in rows):
                self.kept.update((number, row) for row in rows)
                return True
        return False

    def touched(self, file: str, stamp: Stamp) -> None:
        """Keep the clips of a file that has another size or time, but the same content."""
        for place in self._places(file):
            self.kept.add(place)
            self.stamps[place] = stamp

    def checksum(self, file: str) -> str | None:
        """What the file's checksum was; None where it has to be read in any case."""
        places = self._places(file)
        return self.segments[places[0][0]].clips[places[0][1]].sha256 if places else None

    def remaining(self) -> tuple[list[Segment], list[Segment]]:
        """The segments that changed, without what is no longer kept; and those that did not."""
        changed, unchanged = [], []
        for number, part in enumerate(self.segments):
            gone = [row for row in _counted(part) if (number, row) not in self.kept]
            stamps = {row: stamp for (owner, row), stamp in self.stamps.items() if owner == number}
            if not gone and not stamps:
                unchanged.append(part)
                continue
            left = without(part, np.array(gone, np.int64)) if gone else part
            changed.append(_stamped(left, stamps) if stamps else left)
        return changed, unchanged

    def _places(self, file: str) -> list[Place]:
        """Where the clips of a file are in the last segment that has them."""
        for number in reversed(range(len(self.segments))):
            if rows := self._rows[number].get(file):
                return [(number, row) for row in rows]
        return []

    @cached_property
    def _rows(self) -> list[dict[str, list[int]]]:
        """The clips of every file, by segment; none of a segment without attributes, whose files are read again."""
        return [{} if part.attributes is None else self._files(part) for part in self.segments]

    def _files(self, part: Segment) -> dict[str, list[int]]:
        files = part.clips.files()
        found: dict[str, list[int]] = {}
        for row in _counted(part):
            found.setdefault(files[row], []).append(row)
        for file in self.again & found.keys():
            del found[file]
        return found

    @cached_property
    def _stamps(self) -> list[list[Stamp]]:
        """Size and time of every clip of every segment."""
        tables = [part.clips for part in self.segments]
        return [list(zip(table.size.tolist(), table.mtime_ns.tolist(), strict=True)) for table in tables]


def _counted(part: Segment) -> Sequence[int]:
    """The numbers of the clips that count."""
    if part.kept_clips is None:
        return range(len(part.clips))
    numbers: list[int] = part.kept_clips.tolist()
    return numbers


def _stamped(part: Segment, stamps: dict[int, Stamp]) -> Segment:
    part.check(None, "clips")
    rows = np.array(list(stamps), np.int64)
    sizes, times = (np.array([stamp[k] for stamp in stamps.values()], np.int64) for k in (0, 1))
    files = {role: name for role, name in part.files.items() if role != "clips"}
    return replace(part, clips=part.clips.stamped(rows, sizes, times), files=files)
