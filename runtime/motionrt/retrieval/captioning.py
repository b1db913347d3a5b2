"""The words of a library's sidecars, given to the segments whose clips they are about."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from motionrt.formats.folder import Stamp
from motionrt.retrieval.caption_table import CaptionTable
from motionrt.retrieval.contents import Contents
from motionrt.retrieval.records import Caption, Skipped
from motionrt.retrieval.segments import Segment, captions_of
from motionrt.retrieval.sidecars import read_sidecars


def captioned(
    segments: Sequence[Segment], source: Path, sidecars: Mapping[str, Stamp], old: Contents | None
) -> tuple[list[Segment], list[Skipped]]:
    """The segments with what the sidecars say now, and the sidecars that could not be understood.

    They are read again when one of them, or any clip, changed. A segment of which nothing else is said stays as it is.
    """
    if old is not None and dict(old.sidecars) == dict(sidecars) and _same_clips(old.segments, segments):
        return list(segments), [item for item in old.skipped if item.path in sidecars]
    ids = [part.clips.ids.texts() for part in segments]
    counted = [
        names if part.kept_clips is None else [names[number] for number in part.kept_clips.tolist()]
        for part, names in zip(segments, ids, strict=True)
    ]
    captions, skipped = read_sidecars(source, sorted(name for names in counted for name in names), sidecars)
    owner = {name: number for number, names in enumerate(counted) for name in names}
    parts: list[list[Caption]] = [[] for _ in segments]
    for caption in captions:
        parts[owner[caption.clip]].append(caption)
    return [_told(part, said) for part, said in zip(segments, parts, strict=True)], skipped


def _told(part: Segment, captions: Sequence[Caption]) -> Segment:
    if captions_of([part]) == tuple(captions):
        return part
    files = {role: name for role, name in part.files.items() if role not in ("captions", "words")}
    return replace(part, captions=CaptionTable.of(captions, part.clips.ids.texts()), postings=None, files=files)


def _same_clips(old: Sequence[Segment], new: Sequence[Segment]) -> bool:
    pairs = zip(old, new, strict=False)
    return len(old) == len(new) and all(a.clips is b.clips and a.deleted is b.deleted for a, b in pairs)
