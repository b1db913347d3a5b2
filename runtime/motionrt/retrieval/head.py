"""``gallery.json``: its checksum, and strict checks of all that it says, as anybody may have written it."""

from __future__ import annotations

import hashlib
import json
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from pathlib import PurePath, PurePosixPath
from typing import Any, TypeVar

from motionrt.retrieval.records import Caption, Clip, ModelStamp, Reading, Skipped
from motionrt.untrusted import Fail, json_text
from motionrt.untrusted.words import shown

T = TypeVar("T", Caption, Clip, ModelStamp, Reading, Skipped)
OLD_ROLES = {"embeddings": ".npy", "windows": ".npy", "attributes": ".npy", "words": ".npz", "motions": ".npz"}
ROLES = {
    **dict.fromkeys(("clips", "embeddings", "attributes", "captions", "words", "deleted"), ".safetensors"),
    "motions": ".npz",
}
_SEAL = re.compile(rb'\{\n "checksum": "([0-9a-f]{64})",\n')
LONGEST_S = 1e9  # seconds of a clip
SHA256 = re.compile(r"[0-9a-f]{64}", re.ASCII)


@dataclass(frozen=True)
class SegmentHead:
    """What the head says of a segment: how many clips and windows, and its files by role."""

    clips: int
    windows: int
    files: dict[str, str]


def sealed(head: Mapping[str, Any]) -> bytes:
    """The bytes of a head, which begin with the checksum of all that follows."""
    rest = (json.dumps(head, indent=1) + "\n").encode("ascii").removeprefix(b"{\n")
    return b'{\n "checksum": "' + hashlib.sha256(rest).hexdigest().encode("ascii") + b'",\n' + rest


def parsed(content: bytes, fail: Fail) -> Any:
    """What a head says, whatever it is."""
    return json_text.parse(content, fail, "file_bytes", halves=True)


def check_seal(content: bytes, head: Mapping[str, Any], fail: Fail) -> None:
    """Refuse a head whose checksum is wrong; older ones have none."""
    seal = _SEAL.match(content)
    right = seal is not None and hashlib.sha256(content[seal.end() :]).hexdigest().encode("ascii") == seal.group(1)
    if "checksum" in head and not right:
        raise fail("its checksum is wrong: it was changed or damaged", None)


def array_files(content: object, fail: Fail) -> dict[str, str]:
    """The names of the arrays of version 1 by role, each a plain name with a checksum in it."""
    return _files(content, {"embeddings", "windows"}, OLD_ROLES, fail)


def segments_of(content: object, fail: Fail) -> list[SegmentHead]:
    """What it says of its segments: the numbers of clips and windows, and the names of the files by role."""
    if not isinstance(content, list) or not content:
        raise fail(f"its segments are {shown(content)}", None)
    return [_segment(row, fail) for row in content]


def _segment(row: object, fail: Fail) -> SegmentHead:
    if not isinstance(row, dict) or set(row) != {"clips", "windows", "files"}:
        raise fail(f"{shown(row)} is no segment", None)
    if not all(type(row[name]) is int and 0 < row[name] < 2**31 for name in ("clips", "windows")):
        raise fail(f"{shown(row)} is no segment", None)
    return SegmentHead(row["clips"], row["windows"], _files(row["files"], {"clips", "embeddings"}, ROLES, fail))


def _files(content: object, needed: set[str], roles: Mapping[str, str], fail: Fail) -> dict[str, str]:
    if not isinstance(content, dict) or not needed <= content.keys() <= roles.keys():
        raise fail(f"its files are {shown(content)}", None)
    for role, name in content.items():
        pattern = rf"{role}-[0-9a-f]{{16}}\{roles[role]}"
        if not isinstance(name, str) or not re.fullmatch(pattern, name, re.ASCII):
            raise fail(f"{shown(name)} is no name of its file of {role}", None)
    return dict(content)


def sidecars_of(content: object, fail: Fail) -> dict[str, tuple[int, int]]:
    """Size and time of the sidecars that were read, by path."""
    if not isinstance(content, dict):
        raise fail(f"its sidecars are {shown(content)}", None)
    for stamp in content.values():
        if not isinstance(stamp, list) or len(stamp) != 2 or not all(type(number) is int for number in stamp):
            raise fail(f"the stamp of a sidecar is {shown(stamp)}", None)
    return {str(name): (stamp[0], stamp[1]) for name, stamp in content.items()}


def clips_of(content: object, fail: Fail) -> tuple[Clip, ...]:
    """The clips, every value of the kind that it should have, and no file outside the indexed folder."""
    clips = tuple(_rows(Clip, content, fail))
    if len({clip.id for clip in clips}) < len(clips):
        raise fail("two of its clips have the same id", None)
    for clip in clips:
        if not (0 <= clip.duration_s < LONGEST_S and clip.size >= 0):
            raise fail(f"the clip {shown(clip.id)} has an impossible length or size", None)
        if clip.is_file and not stays_below(clip.file):
            raise fail(f"the clip {shown(clip.id)} names a file outside the indexed folder", None)
    return clips


def captions_of(content: object, fail: Fail) -> tuple[Caption, ...]:
    """What the library says of its clips."""
    if not isinstance(content, list) or not all(isinstance(row, dict) for row in content):
        raise fail(f"its captions are {shown(content)}", None)
    for row in content:
        tags = row.get("tags", [])
        if not isinstance(tags, list) or not all(isinstance(tag, str) for tag in tags):
            raise fail(f"the tags of a caption are {shown(tags)}", None)
    return tuple(_rows(Caption, [{**row, "tags": tuple(row.get("tags", []))} for row in content], fail))


def skipped_of(content: object, fail: Fail) -> tuple[Skipped, ...]:
    """What could not be indexed."""
    return tuple(_rows(Skipped, content, fail))


def model_of(content: object, fail: Fail) -> ModelStamp:
    """Which model made it."""
    return next(iter(_rows(ModelStamp, [content], fail)))


def reading_of(mapping: object, options: object, fail: Fail) -> Reading:
    """How its files are read: the joint mapping, if there is one, and the other options, none of them required."""
    if mapping is not None and not (isinstance(mapping, dict) and all(isinstance(v, str) for v in mapping.values())):
        raise fail(f"its mapping is {shown(mapping)}", None)
    if not isinstance(options, dict) or "mapping" in options:
        raise fail(f"its options of reading are {shown(options)}", None)
    reading = next(iter(_rows(Reading, [{**options, "mapping": dict(mapping) if mapping else None}], fail)))
    if reading.asf is not None and not stays_below(reading.asf):
        raise fail(f"its skeleton {shown(reading.asf)} lies outside the indexed folder", None)
    return reading


def source_of(content: object, fail: Fail) -> str | None:
    """The indexed folder as it is noted."""
    if content is not None and (not isinstance(content, str) or not content or "\0" in content):
        raise fail(f"its source is {shown(content)}", None)
    return content


def stays_below(name: str, path: Callable[[str], PurePath] = PurePath) -> bool:
    """Whether a relative path with forward slashes leads to nothing outside its folder.

    Args:
        name: the path.
        path: the kind of path of the system that opens it.
    """
    if not name or "\0" in name or name.startswith("/"):
        return False
    here = path(name)
    return not (here.is_absolute() or here.drive or here.root or ".." in (*here.parts, *PurePosixPath(name).parts))


_KINDS: dict[str, Callable[[Any], bool]] = {
    "str": lambda value: isinstance(value, str),
    "int": lambda value: isinstance(value, int) and not isinstance(value, bool) and abs(value) < 2**63,
    "float": lambda value: isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value),
    "float | None": lambda value: value is None or _KINDS["float"](value),
    "str | None": lambda value: value is None or isinstance(value, str),
}


def _rows(kind: type[T], content: object, fail: Fail) -> list[T]:
    what = kind.__name__.lower()
    if not isinstance(content, list):
        raise fail(f"its list of {what}s is {shown(content)}", None)
    checks = [(field.name, _KINDS[str(field.type)]) for field in fields(kind) if str(field.type) in _KINDS]
    rows = []
    for values in content:
        if not isinstance(values, dict):
            raise fail(f"{shown(values)} is no {what}", None)
        try:
            row = kind(**values)
        except TypeError as error:  # a field too many or too few
            raise fail(f"{shown(values)} is no {what}", None) from error
        for name, right in checks:
            if not right(getattr(row, name)):
                raise fail(f"the {name} of a {what} is {shown(getattr(row, name))}", None)
        rows.append(row)
    return rows
