"""What a window offers to the panels in it, and what it begins with."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol, TypeVar

from motionrt.formats import Character
from motionrt.motion import Motion
from motionrt.motion.skeleton import FloatArray
from motionrt.studio.clips import Clip
from motionrt.studio.clock import Clock
from motionrt.studio.draft import Draft
from motionrt.studio.jobs import Work
from motionrt.studio.markers import Markers
from motionrt.studio.scenery import Scenery
from motionrt.studio.stage import Stage
from motionrt.studio.state import State
from motionrt.studio.uploads import Uploads
from motionrt.studio.workshop import Workshop

T = TypeVar("T")


@dataclass
class Show:
    """What every window of a page begins with.

    Attributes:
        clips: on the stage.
        problems: one line about every file that could not be read.
        scenery: drawn around them.
        draft: keypoints and paths that are drawn.
        path: ``(N, 2)`` x and z of a path on the ground.
        character: who is seen instead of the figure.
    """

    clips: Sequence[Clip] = ()
    problems: Sequence[str] = ()
    scenery: Scenery | None = None
    draft: Draft | None = None
    path: FloatArray | None = None
    layout: str | None = None
    playing: bool = True
    character: Character | None = None
    extra: dict[str, Any] = field(default_factory=dict)


class Window(Protocol):
    """What the panels of playback and view need of the window that they are in."""

    client: Any
    clock: Clock
    stage: Stage
    follow: bool

    def guarded(self, act: Callable[[Any], None]) -> Callable[[Any], None]:
        """A callback of the page: one at a time, and whatever goes wrong is told there and ends nothing."""

    def chosen(self) -> None:
        """Another clip is selected."""

    def redraw(self) -> None:
        """Draw everything as the clock says, now."""

    def unsaved(self) -> Sequence[Clip]:
        """Clips on the stage that somebody made and has not saved."""

    def rearrange(self) -> None:
        """After the look of the stage changed."""

    def frame_all(self, *more: FloatArray) -> None:
        """Move the camera to where everything is in sight, boxes ``(2, 3)`` that are given as well."""


class StudioWindow(Window, Protocol):
    """What the panels of the studio need, too."""

    workshop: Workshop
    given: Show
    markers: Markers
    scenery: Scenery | None
    uploads: Uploads

    def state(self) -> State:
        """What the window holds now."""

    def remember(self) -> None:
        """Before a change: what there is now is what undo brings back."""

    def undo(self) -> None:
        """Take the last change back, whatever it was."""

    def saved(self, *clips: Clip) -> None:
        """These clips are in a file now."""

    def before_losing(self, kept: Sequence[Clip], go_on: Callable[[Sequence[Clip]], None]) -> None:
        """Ask, if unsaved work is not among the clips that stay; then go on with those that stay."""

    def clip(
        self,
        name: str,
        motion: Motion,
        beside: Sequence[Clip],
        *,
        note: str = "",
        made: bool = True,
        dear: bool = False,
    ) -> Clip:
        """A clip with a name and a colour that no other has."""

    def put_clips(self, clips: Sequence[Clip], layout: str) -> None:
        """Put these clips on the stage and play them from the start."""

    def set_character(self, character: Character | None) -> None:
        """See all clips on a character of the user's own, or on the figure."""

    def open_script(self, file: Path) -> None:
        """Take over a script or a scene that was uploaded."""

    def open_plan(self, file: Path) -> None:
        """Take over a plan that was uploaded."""

    def open_scene(self, name: str, content: bytes) -> None:
        """Take over a scene, a script or a plan, or keep a file that one of them names."""

    def complain(self, words: str, seconds: float | None = 15.0) -> None:
        """A red note on the page."""

    @property
    def selected(self) -> Clip:
        """The clip that buttons mean."""

    def work(self, title: str, work: Work[T], done: Callable[[T, float], None]) -> None:
        """Do something in the background, and tell the page how it goes."""

    def present(
        self,
        motions: Sequence[tuple[str, Motion, str]],
        *,
        keep: bool = False,
        world: bool = False,
        made: bool = True,
        dear: bool = False,
        saved: bool = False,
    ) -> None:
        """Play new motions (name, motion, note) from the start."""

    def set_scenery(self, scenery: Scenery | None) -> None:
        """Draw another scene."""

    def reveal_scene(self, *, shown: bool) -> None:
        """Show or hide the scene and what is drawn into it."""

    def say(self, title: str, words: str = "") -> None:
        """A note on the page."""

    def hand_over(self, name: str, content: bytes) -> None:
        """A file for the browser to save."""
