"""What a window holds at a moment, as an immutable value: undo is the value before, a reload takes the last one up."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field

from motionrt.formats import Character
from motionrt.limits import limits
from motionrt.studio.clips import Clip
from motionrt.studio.draft import Draft
from motionrt.studio.layout import AS_RECORDED
from motionrt.studio.plan_draft import PlanDraft
from motionrt.studio.scenery import Scenery

STEPS_BACK = 50
KEPT_S = 3600.0


@dataclass(frozen=True, eq=False)
class State:
    """A window's work.

    Attributes:
        clips: on the stage.
        layout: how they stand there.
        draft: the script in the making.
        plan: the plan in the making.
        scenery: the scene around them.
        character: who is seen instead of the figure.
    """

    clips: tuple[Clip, ...] = ()
    layout: str = AS_RECORDED
    draft: Draft = field(default_factory=Draft)
    plan: PlanDraft = field(default_factory=PlanDraft)
    scenery: Scenery | None = None
    character: Character | None = None

    @property
    def empty(self) -> bool:
        """Whether there is nothing to lose."""
        return (
            not self.clips
            and self.draft == Draft()
            and self.plan == PlanDraft()
            and (self.scenery is None and self.character is None)
        )


class Past:
    """The way back of one window, at most :data:`STEPS_BACK` steps of it."""

    def __init__(self) -> None:
        self._states: list[State] = []

    def push(self, state: State) -> None:
        """What was there before a change."""
        self._states = [*self._states[1 - STEPS_BACK :], state]

    def pop(self) -> State | None:
        """What was there before the last change; None where nothing was changed."""
        return self._states.pop() if self._states else None


class Kept:
    """The work of windows that were closed, for an hour, for the browser that had them: a reload loses nothing.

    Args:
        clock: seconds, as :func:`time.monotonic`.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock, self._lock = clock, threading.Lock()
        self._states: list[tuple[str, float, State]] = []

    def keep(self, browser: str | None, state: State) -> None:
        """A window of a browser has closed; not more are kept than may be open."""
        if browser is None or state.empty:
            return
        with self._lock:
            self._states = [*self._fresh(), (browser, self._clock(), state)][-limits().windows :]

    def take(self, browser: str | None) -> State | None:
        """The work of the window that this browser closed last; whoever takes it up has it alone."""
        with self._lock:
            self._states = self._fresh()
            for index in range(len(self._states) - 1, -1, -1):
                if self._states[index][0] == browser:
                    return self._states.pop(index)[2]
        return None

    def _fresh(self) -> list[tuple[str, float, State]]:
        return [row for row in self._states if self._clock() - row[1] < KEPT_S]
