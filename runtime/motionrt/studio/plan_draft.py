"""A plan in the making: texts on a timeline, places and targets at times; docs/plans.md says what they mean."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from html import escape
from typing import Any

from motionrt.errors import InvalidInputError
from motionrt.motion.body_parts import ARMS, LEGS, PARTS
from motionrt.synthesis.constraints import GRID_S, Constraints, Target, Waypoint
from motionrt.synthesis.plan import Plan

WHOLE = "whole body"
MOVES: dict[str, tuple[str, ...] | None] = {
    WHOLE: None,
    **{part: (part,) for part in PARTS[:5]},
    "both arms": ARMS,
    "upper body": (*ARMS, "torso"),
    "legs and way": (*LEGS, "global"),
}
LINE_S = 2.0
SHORTEST_S, LONGEST_S = 0.5, 9.5
HEAD = "# Made in the motionrt studio. Make motion of it with: motionrt generate --plan FILE -o motion.glb\n"
_COLOURS = ("#0072b2", "#009e73", "#cc79a7", "#d55e00", "#56b4e9", "#8c6d1f")


@dataclass(frozen=True)
class PlanLine:
    """A text from one time to another, and which of :data:`MOVES` it moves."""

    text: str
    start: float
    end: float
    moves: str = WHOLE


@dataclass(frozen=True)
class PlanDraft:
    """What is planned.

    Attributes:
        lines: the texts.
        path: places at times.
        targets: hands and feet at places at times.
    """

    lines: tuple[PlanLine, ...] = ()
    path: tuple[Waypoint, ...] = ()
    targets: tuple[Target, ...] = ()

    @property
    def duration(self) -> float:
        """Seconds until the last text ends."""
        return max((line.end for line in self.lines), default=0.0)

    def with_text(self, text: str, moves: str = WHOLE) -> PlanDraft:
        """One more text: behind the others, or upon all of them where it moves a part only; the first moves all.

        Raises:
            InvalidInputError: an empty text.
        """
        if not text.strip():
            raise InvalidInputError("write what somebody does, as in: walk forward")
        moves = moves if self.lines else WHOLE
        upon = moves != WHOLE
        start = 0.0 if upon else self.duration
        end = min(self.duration, LONGEST_S) if upon else start + LINE_S
        return replace(self, lines=(*self.lines, PlanLine(text.strip(), start, end, moves)))

    def with_span(self, index: int, start: float, end: float) -> PlanDraft:
        """A text at other times, on the grid that times are met on; at least half a second and at most 9.5 of it.

        A text of the whole body pushes those behind it along, so that no moment is without one.
        """
        start, end = _on_grid(start), _on_grid(end)
        end = min(max(end, start + SHORTEST_S), start + LONGEST_S)
        lines = list(self.lines)
        lines[index] = replace(lines[index], start=start, end=end)
        return replace(self, lines=tuple(_without_gaps(lines)))

    def without(self, kind: str, index: int) -> PlanDraft:
        """Without one of ``lines``, ``path`` or ``targets``."""
        rows = getattr(self, kind)
        kept = [*rows[:index], *rows[index + 1 :]]
        found = replace(self, **{kind: tuple(_without_gaps(kept) if kind == "lines" else kept)})
        return found if any(line.moves == WHOLE for line in found.lines) or kind != "lines" else PlanDraft()

    def timeline(self) -> list[Mapping[str, Any]]:
        """As :meth:`motionrt.Runtime.generate` takes it: whole bodies first, then what lies upon them."""
        rows = sorted(self.lines, key=lambda line: (line.moves != WHOLE, line.start))
        return [_item(line) for line in rows]

    def constraints(self) -> Constraints:
        """What the motion must meet."""
        return Constraints(path=self.path, targets=self.targets)

    def text(self) -> str:
        """The plan as YAML, for ``motionrt generate --plan``."""
        import yaml

        plan: dict[str, Any] = {"timeline": [dict(item) for item in self.timeline()]}
        if self.path:
            plan["path"] = [
                {"time": w.time, "place": list(w.place), **({} if w.heading is None else {"heading": w.heading})}
                for w in self.path
            ]
        if self.targets:
            plan["targets"] = [{"time": t.time, "joint": t.joint, "place": list(t.place)} for t in self.targets]
        return HEAD + yaml.safe_dump(plan, sort_keys=False, allow_unicode=True, default_flow_style=None, width=110)

    @classmethod
    def of(cls, plan: Plan) -> PlanDraft:
        """A plan that was read.

        Raises:
            InvalidInputError: it keeps poses or clips, which this editor does not show.
        """
        if plan.constraints.keyframes or plan.constraints.kept:
            raise InvalidInputError("plans with keyframes or clips to keep are for motionrt generate --plan")
        lines: list[PlanLine] = []
        for item in plan.timeline:
            lines.append(_line(item, max((line.end for line in lines if line.moves == WHOLE), default=0.0)))
        return cls(tuple(lines), tuple(plan.constraints.path), tuple(plan.constraints.targets))

    def picture(self) -> str:
        """HTML of the timeline: a bar for every text, a diamond for every place and target."""
        if not self.lines:
            return '<div style="padding:0.3em 0.6em;opacity:0.7;font-size:0.85em">No texts yet: add one below.</div>'
        whole = max(self.duration, 0.1)
        rows = [_bar(line, number, whole) for number, line in enumerate(self.lines)]
        marks = [("place", w.time) for w in self.path] + [(t.joint.replace("_", " "), t.time) for t in self.targets]
        rows += [_mark(name, time, whole) for name, time in marks]
        scale = f'<div style="font-size:0.75em;opacity:0.7;text-align:right">{whole:g} s</div>'
        return f'<div style="padding:0.3em 0.6em">{"".join(rows)}{scale}</div>'


def _without_gaps(lines: list[PlanLine]) -> list[PlanLine]:
    """Texts of the whole body one behind the other from 0 on, each as long as it is; the others stay."""
    clock, found = 0.0, list(lines)
    order = sorted((i for i, line in enumerate(lines) if line.moves == WHOLE), key=lambda i: lines[i].start)
    for index in order:
        line = lines[index]
        found[index] = replace(line, start=clock, end=_on_grid(clock + line.end - line.start))
        clock = found[index].end
    return [replace(x, start=min(x.start, max(clock - SHORTEST_S, 0)), end=min(x.end, clock)) for x in found]


def _item(line: PlanLine) -> Mapping[str, Any]:
    parts = MOVES[line.moves]
    named = {} if parts is None else {"parts": list(parts)}
    return {"text": line.text, "from": round(line.start, 2), "to": round(line.end, 2), **named}


def _line(item: Any, clock: float) -> PlanLine:
    """A line of a checked plan: a text, a text and its seconds, or a mapping."""
    if isinstance(item, str):
        item = {"text": item}
    elif not isinstance(item, Mapping):
        item = {"text": item[0], "seconds": item[1]}
    start = float(item.get("from", clock))
    end = float(item["to"]) if "to" in item else start + float(item.get("seconds", LINE_S))
    given = item.get("parts")
    parts = {given} if isinstance(given, str) else set(given or ())
    moves = next((name for name, known in MOVES.items() if known and set(known) == parts), WHOLE)
    if parts and moves == WHOLE:
        raise InvalidInputError(f"the parts of '{item['text']}' are for motionrt generate --plan")
    return PlanLine(str(item["text"]), start, end, moves)


def _bar(line: PlanLine, number: int, whole: float) -> str:
    left, width = 100 * line.start / whole, 100 * (line.end - line.start) / whole
    style = (
        f"margin-left:{left:.1f}%;width:{width:.1f}%;background:{_COLOURS[number % len(_COLOURS)]};color:#fff;"
        "border-radius:3px;padding:0 0.3em;margin-bottom:2px;font-size:0.75em;white-space:nowrap;overflow:hidden"
    )
    return f'<div style="{style}">{number + 1}. {escape(line.text)}</div>'


def _mark(name: str, time: float, whole: float) -> str:
    left = min(100 * time / whole, 90.0)
    return f'<div style="margin-left:{left:.1f}%;font-size:0.75em;white-space:nowrap">◆ {escape(name)}</div>'


def _on_grid(seconds: float) -> float:
    return round(round(seconds / GRID_S) * GRID_S, 3)
