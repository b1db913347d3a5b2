"""Plans: a timeline and what it must keep to, as a YAML or JSON file; constraints of Kimodo where they say the same.

    timeline:
      - {text: walk forward, seconds: 3}
      - {text: wave with the right hand, from: 1, to: 3, parts: right arm}
      - {text: sit down, seconds: 2}
    path:                                   # places of the pelvis over the ground, metres, and headings, degrees
      - {time: 3, place: [0.5, 2.5], heading: 30}
    targets:
      - {time: 2, joint: right_wrist, place: [0.3, 1.4, 1.9]}
    keyframes:
      - {time: 5, pose: sitting.bvh}        # the first frame of a motion file; place and heading as of a path
    keep:
      - {motion: clip.bvh, parts: [left leg, right leg, global], spans: [[0, 2]]}

Files are looked for beside the plan.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

from motionrt.errors import MotionRTError, ScriptError
from motionrt.formats import load_motion
from motionrt.motion import Motion
from motionrt.motion.body_parts import checked_parts
from motionrt.synthesis.constraints import Constraints, Kept, Keyframe, Target, Waypoint
from motionrt.synthesis.timeline import Item
from motionrt.untrusted import yaml_text
from motionrt.untrusted.files import as_path, beside, read_utf8
from motionrt.untrusted.words import shown

KIMODO_FPS = 30.0
_KEYS = ("timeline", "path", "targets", "keyframes", "keep")
_KIMODO_KEYS = ("type", "frame_indices", "smooth_root_2d", "global_root_heading")

Row = Mapping[str, Any]
T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class Plan:
    """What a file asks for.

    Attributes:
        timeline: texts with their times, empty where the file has constraints alone.
        constraints: what is kept or met.
    """

    timeline: tuple[Item, ...] = ()
    constraints: Constraints = field(default_factory=Constraints)

    @classmethod
    def read(cls, file: str | Path) -> Plan:
        """Read and check a plan (.yaml, .yml, .json), or a list of constraints as Kimodo writes them.

        Raises:
            ScriptError: it cannot be read, or something in it is unknown, missing or of the wrong kind.
        """
        path = as_path(file)
        reader = _Reader(path)
        value = reader.parsed()
        if isinstance(value, list):
            return cls(constraints=reader.made(lambda: Constraints(path=reader.kimodo(value))))
        if not isinstance(value, dict):
            raise reader.fail(f"a plan has the keys {', '.join(_KEYS)}", None)
        reader.known(value, _KEYS, "the plan")
        return cls(tuple(reader.rows(value, "timeline")), reader.made(lambda: reader.constraints(value)))


@dataclass(frozen=True)
class _Reader:
    file: Path

    def fail(self, reason: str, line: int | None) -> ScriptError:
        return ScriptError(f"{self.file}{f':{line}' if line else ''}: {reason}")

    def parsed(self) -> Any:
        import yaml

        try:
            text = read_utf8(self.file, self.fail)
        except FileNotFoundError:
            raise self.fail("there is no such file", None) from None
        return yaml_text.parse(text, getattr(yaml, "CSafeLoader", yaml.SafeLoader), self.fail)  # JSON is YAML, too

    def made(self, make: Callable[[], T]) -> T:
        """What `make` makes, its complaints naming the file."""
        try:
            return make()
        except ScriptError:
            raise
        except MotionRTError as error:
            raise self.fail(str(error), None) from error

    def constraints(self, value: Row) -> Constraints:
        return Constraints(
            keyframes=[self._keyframe(row, name) for row, name in self._each(value, "keyframes")],
            path=[self._waypoint(row, name) for row, name in self._each(value, "path")],
            targets=[self._target(row, name) for row, name in self._each(value, "targets")],
            kept=[self._kept(row, name) for row, name in self._each(value, "keep")],
        )

    def kimodo(self, value: Sequence[Any]) -> list[Waypoint]:
        found: list[Waypoint] = []
        for number, row in enumerate(value, 1):
            name = f"constraint {number}"
            if not isinstance(row, dict) or row.get("type") != "root2d":
                kind = row.get("type") if isinstance(row, dict) else row
                raise self.fail(
                    f"{name} is of type {kind!r}; of Kimodo's constraints only root2d is read: poses of other "
                    "skeletons come as motion files, in keyframes",
                    None,
                )
            self.known(row, _KIMODO_KEYS, name)
            frames, places = row.get("frame_indices", []), row.get("smooth_root_2d", [])
            headings = row.get("global_root_heading") or [None] * len(frames)
            if not len(frames) == len(places) == len(headings):
                raise self.fail(f"{name} needs as many places and headings as frame_indices", None)
            for frame, place, heading in zip(frames, places, headings, strict=True):
                turned = None if heading is None else math.degrees(math.atan2(*reversed(self._place(heading, 2, name))))
                x, z = self._place(place, 2, name)
                found.append(Waypoint(self._number(frame, f"{name}: frame_indices") / KIMODO_FPS, (x, z), turned))
        return found

    def known(self, row: Row, keys: Sequence[str], name: str) -> None:
        if unknown := sorted(set(map(str, row)) - set(keys)):
            raise self.fail(f"{name}: unknown key {', '.join(unknown)}; there are: {', '.join(keys)}", None)

    def rows(self, value: Row, key: str) -> list[Any]:
        found = value.get(key) or []
        if not isinstance(found, list):
            raise self.fail(f"{key} is a list", None)
        return found

    def _each(self, value: Row, key: str) -> list[tuple[Row, str]]:
        rows = [(row, f"{key}: {number}") for number, row in enumerate(self.rows(value, key), 1)]
        for row, name in rows:
            if not isinstance(row, dict):
                raise self.fail(f"{name} is a mapping, as in {{time: 1.5, ...}}", None)
        return rows

    def _keyframe(self, row: Row, name: str) -> Keyframe:
        self.known(row, ("time", "pose", "place", "heading"), name)
        place = self._pair(row, name) if "place" in row else None
        return Keyframe(
            self._time(row, name), self._motion(row.get("pose"), f"{name}: pose"), place, self._heading(row)
        )

    def _waypoint(self, row: Row, name: str) -> Waypoint:
        self.known(row, ("time", "place", "heading"), name)
        return Waypoint(self._time(row, name), self._pair(row, name), self._heading(row))

    def _target(self, row: Row, name: str) -> Target:
        self.known(row, ("time", "joint", "place"), name)
        x, y, z = self._place(row.get("place"), 3, name)
        return Target(self._time(row, name), str(row.get("joint")), (x, y, z))

    def _kept(self, row: Row, name: str) -> Kept:
        self.known(row, ("motion", "parts", "spans"), name)
        parts = checked_parts(row["parts"]) if row.get("parts") is not None else None
        spans = None
        if row.get("spans") is not None:
            pairs = [self._place(span, 2, f"{name}: spans") for span in self.rows(row, "spans")]
            spans = tuple((first, last) for first, last in pairs)
        return Kept(self._motion(row.get("motion"), f"{name}: motion"), parts, spans)

    def _motion(self, named: Any, name: str) -> Motion:
        if not isinstance(named, str):
            raise self.fail(f"{name} is the name of a motion file", None)
        return load_motion(beside(self.file.parent, named, self.fail))

    def _time(self, row: Row, name: str) -> float:
        return self._number(row.get("time"), f"{name}: time")

    def _heading(self, row: Row) -> float | None:
        return None if row.get("heading") is None else self._number(row["heading"], "heading")

    def _pair(self, row: Row, name: str) -> tuple[float, float]:
        x, z = self._place(row.get("place"), 2, name)
        return x, z

    def _place(self, value: Any, count: int, name: str) -> list[float]:
        if not isinstance(value, list) or len(value) != count:
            raise self.fail(f"{name}: expected {count} numbers, found {value!r}", None)
        return [self._number(number, name) for number in value]

    def _number(self, value: Any, name: str) -> float:
        try:
            number = float("nan") if isinstance(value, bool) or not isinstance(value, int | float) else float(value)
        except OverflowError:  # a whole number of hundreds of digits
            number = float("inf")
        if not math.isfinite(number):
            raise self.fail(f"{name}: expected a number, found {shown(value)}", None)
        return number
