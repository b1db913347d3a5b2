"""One segment out of the clips of several, in the order of their ids."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from motionrt.formats.motion_pack import MotionPack
from motionrt.retrieval.caption_table import CaptionTable
from motionrt.retrieval.clip_table import ClipTable
from motionrt.retrieval.records import WINDOW_TYPE
from motionrt.retrieval.segments import Segment
from motionrt.retrieval.vectors import Block, Blocks, Packed, Vectors

Numbers = npt.NDArray[np.int64]


def merged(segments: Sequence[Segment]) -> Segment:
    """The clips that count of all segments as one, in the order of their ids; captions are those of the segments.

    GalleryError where a file of a segment is damaged: what is kept must be what was written.
    """
    for part in segments:
        part.check(None, *part.files)
    table = ClipTable.joined([part.clips for part in segments])
    firsts = np.cumsum([0, *(len(part.clips) for part in segments)])
    counted = [first + _all(part.kept_clips, len(part.clips)) for first, part in zip(firsts, segments, strict=False)]
    live = np.concatenate(counted)
    ids = table.ids.texts()
    order: Numbers = np.array(sorted(live.tolist(), key=ids.__getitem__), np.int64)
    clips = table.take(order, ordered=True)
    rows, windows = _windows(segments, order)
    tables = [part.attributes for part in segments]
    whole = [table for table in tables if table is not None]
    attributes = Blocks([Block(table) for table in whole]).rows(rows) if len(whole) == len(tables) else None
    captions = [caption for part in segments for caption in part.captions]
    packs = [part.pack for part in segments]
    return Segment(
        clips,
        windows,
        _vectors([part.vectors for part in segments], rows),
        attributes,
        CaptionTable.of(captions, clips.ids.texts()),
        _motions([pack for pack in packs if pack is not None], order) if all(packs) else None,
    )


def _all(kept: npt.NDArray[np.integer] | None, count: int) -> Numbers:
    return np.arange(count) if kept is None else kept.astype(np.int64)


def _windows(segments: Sequence[Segment], order: Numbers) -> tuple[Numbers, npt.NDArray[np.void]]:
    """The numbers of the windows of clips in that order, among those of all segments, and their table."""
    owners, first = [], 0
    for part in segments:
        owners.append(part.windows["clip"].astype(np.int64) + first)
        first += len(part.clips)
    owner = np.concatenate(owners)
    starts = np.searchsorted(owner, order)
    counts = np.searchsorted(owner, order, side="right") - starts
    ends = np.cumsum(counts)
    rows = np.arange(int(ends[-1])) - np.repeat(ends - counts, counts) + np.repeat(starts, counts)
    windows = np.concatenate([np.asarray(part.windows) for part in segments])[rows].astype(WINDOW_TYPE)
    windows["clip"] = np.repeat(np.arange(len(order)), counts)
    return rows, windows


def _vectors(tables: Sequence[Vectors], rows: Numbers) -> Vectors:
    """Those vectors, of all tables one behind the other; what is packed alike stays as it is."""
    packed = [table for table in tables if isinstance(table, Packed)]
    if len(packed) < len(tables) or len({table.precision for table in packed}) > 1:
        return Blocks([Block(Blocks([Block(table) for table in tables]), rows)])
    scales = [table.scales for table in packed if table.scales is not None]
    numbers = np.concatenate([table.numbers for table in packed])[rows]
    return Packed(numbers, np.concatenate(scales)[rows] if scales else None)


def _motions(packs: Sequence[MotionPack], order: Numbers) -> MotionPack | None:
    return MotionPack.chosen(packs, order.tolist()) if packs else None
