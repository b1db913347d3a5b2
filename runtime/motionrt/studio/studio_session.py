"""A window of ``motionrt studio``: search, make, direct, export."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any, TypeVar
from weakref import WeakSet

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.formats import Character
from motionrt.motion import Motion
from motionrt.studio.clips import Clip, colour, unique
from motionrt.studio.direct_panel import DirectPanel
from motionrt.studio.export_panel import ExportPanel
from motionrt.studio.jobs import Cancelled, Jobs, Work
from motionrt.studio.layout import AS_RECORDED, SIDE_BY_SIDE
from motionrt.studio.make_panel import MakePanel
from motionrt.studio.open_panel import OpenPanel
from motionrt.studio.plan_panel import PlanPanel
from motionrt.studio.search_panel import SearchPanel
from motionrt.studio.session import Session
from motionrt.studio.state import Past, State
from motionrt.studio.uploads import Uploads
from motionrt.studio.windows import Show
from motionrt.studio.workshop import Workshop

T = TypeVar("T")
NOTHING = "nothing yet"
_PROGRESS_S = 0.1
FAR = 4.0  # metres from the start from which on the camera goes along


class StudioSession(Session):
    """A window of the studio.

    Args:
        client: of viser.
        show: what to begin with.
        workshop: what it shares with the others.
    """

    selecting = True

    def __init__(self, client: Any, show: Show, workshop: Workshop) -> None:
        self.workshop = workshop
        self.uploads, self._past = Uploads(), Past()
        self._saved: WeakSet[Clip] = WeakSet()
        self.jobs = Jobs(workshop.desk, self._progress)
        self._progress_at = 0.0
        super().__init__(client, show)

    def add_panels(self) -> None:
        """Tabs of what can be done, and how far it is."""
        gui = self.client.gui
        self._working = gui.add_folder("Working", visible=False)
        with self._working:
            self._task: Any = gui.add_markdown("")
            self._bar: Any = gui.add_progress_bar(0.0, animated=True)
            cancel: Any = gui.add_button("Cancel", color="red", icon="x")
        cancel.on_click(lambda _: self.jobs.cancel())  # not guarded: the lock may be held
        tabs = gui.add_tab_group()
        with tabs.add_tab("Search", "search"):
            self.search = SearchPanel(self)
        with tabs.add_tab("Make", "wand"):
            self.make = MakePanel(self)
        with tabs.add_tab("Plan", "timeline"):
            self.plan = PlanPanel(self)
        with tabs.add_tab("Direct", "route"):
            self.direct = DirectPanel(self)
        with tabs.add_tab("Open", "folder-open"):
            self.open = OpenPanel(self)
        with tabs.add_tab("Export", "download"):
            self.export = ExportPanel(self)
        gui.add_command("Undo", hotkey="Z").on_trigger(self.guarded(lambda _: self.undo()))

    def show(self, clips: Sequence[Clip], *, rewind: bool = False) -> None:
        """As for any window; what is selected follows."""
        super().show(clips, rewind=rewind)
        self.open.refresh(empty=not self.stage.clips)
        self.export.refresh()
        self.make.refresh()

    def chosen(self) -> None:
        """Another clip is selected."""
        self.export.refresh()
        self.make.refresh()

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
        """Play new motions (name, motion, note) from the start; asks, before unsaved work leaves the stage.

        Args:
            motions: what to play.
            keep: leave what is on the stage there.
            world: they stand where they stand; otherwise several are put side by side.
            made: they are somebody's work; hits, which are not, leave all work on the stage.
            dear: they took more than a text to make.
            saved: they came from a file.
        """

        def go_on(stay: Sequence[Clip]) -> None:
            self.remember()
            clips = list(stay)
            for name, motion, note in motions:
                clips.append(self.clip(name, motion, clips, note=note, made=made, dear=dear))
            if saved:
                self._saved.update(clips[len(stay) :])
            self.reveal_scene(shown=world)
            self.put_clips(clips, AS_RECORDED if world or len(clips) < 2 else SIDE_BY_SIDE)
            if not world or self.scenery is None:  # who directs has chosen where to look from
                self.frame_all()

        with self.lock:
            self.before_losing([clip for clip in self.stage.clips if keep or (clip.made and not made)], go_on)

    def unsaved(self) -> Sequence[Clip]:
        """Clips on the stage that somebody made and has not saved."""
        return [clip for clip in self.stage.clips if clip.made and clip not in self._saved]

    def saved(self, *clips: Clip) -> None:
        """These clips are in a file now."""
        self._saved.update(clips)
        self.view.tell_saved()

    def before_losing(self, kept: Sequence[Clip], go_on: Callable[[Sequence[Clip]], None]) -> None:
        """Ask, if unsaved work that took more than a text is not among the clips that stay; then go on with those."""
        lost = [clip for clip in self.unsaved() if clip.dear and clip not in kept]
        if not lost:
            go_on(kept)
            return
        gui = self.client.gui
        modal = gui.add_modal(f"{', '.join(clip.name for clip in lost)[:60]} has not been saved")
        with modal:
            gui.add_markdown("It would leave the stage. Undo (Z) brings it back for as long as this page is open.")
            for words, stay in (("Keep both", [*lost, *kept]), ("Replace it", list(kept))):
                button = gui.add_button(words, color=None if words == "Keep both" else "red")
                button.on_click(self.guarded(partial(_answered, modal, go_on, stay)))

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
        return Clip(unique(name, beside), motion, _other_colour(beside), note, made, dear)

    def put_clips(self, clips: Sequence[Clip], layout: str) -> None:
        """Put these clips on the stage and play them from the start; the camera goes along with long ways."""
        self.view.set_layout(layout)
        self.view.set_follow(on=any(_goes_far(clip) for clip in clips))
        self.clock.playing = True
        self.show(clips, rewind=True)

    def state(self) -> State:
        """What the window holds now."""
        stage = self.stage
        return State(
            tuple(stage.clips), stage.look.layout, self.direct.draft, self.plan.draft, self.scenery, stage.character
        )

    def remember(self) -> None:
        """Before a change: what there is now is what undo brings back."""
        self._past.push(self.state())

    def undo(self) -> None:
        """Take the last change back, whatever it was."""
        state = self._past.pop()
        if state is None:
            self.say("Nothing to undo")
        else:
            self.restore(state)

    def restore(self, state: State) -> None:
        """Show what was there at another time."""
        with self.lock:
            if state.scenery is not self.scenery:
                self.set_scenery(state.scenery)
            self.direct.put(state.draft)
            self.plan.put(state.plan)
            self.stage.wear(state.character, self.clock.time)
            if list(state.clips) != self.stage.clips:
                self.put_clips(state.clips, state.layout)
            self.figure_changed()

    def set_character(self, character: Character | None) -> None:
        """See all clips on a character of the user's own, or on the figure."""
        with self.lock:
            if character is not self.stage.character:
                self.remember()
                self.stage.wear(character, self.clock.time)
                self.figure_changed()

    def figure_changed(self) -> None:
        """Somebody else is seen: panels say so."""
        self.open.refresh(empty=not self.stage.clips)
        self.export.refresh()

    def take_up(self, state: State) -> None:
        """Go on where a window that was closed left off."""
        self.remember()
        self.restore(state)
        self.frame_all()
        self.say("Your work is here again", "as it was when the window was closed; Z takes it back")

    def open_scene(self, name: str, content: bytes) -> None:
        """Take over a scene, a script or a plan, or keep a file that one of them names."""
        self.direct.uploaded(name, content)

    def open_script(self, file: Path) -> None:
        """Take over a script, a plan or a scene that was uploaded."""
        self.direct.load(file)

    def open_plan(self, file: Path) -> None:
        """Take over a plan that was uploaded."""
        self.plan.open(file)

    @property
    def selected(self) -> Clip:
        """The clip that buttons mean.

        Raises:
            InvalidInputError: there is nothing on the stage.
        """
        shown = [actor.clip for actor in self.stage.actors if actor.visible]
        if not shown:
            raise InvalidInputError("there is nothing on the stage; search or generate something first")
        return self.view.chosen() or shown[0]

    def work(self, title: str, work: Work[T], done: Callable[[T, float], None]) -> None:
        """Do something in the background, and tell the page how it goes.

        Raises:
            InvalidInputError: something else is being done.
        """

        def finished(result: T, seconds: float) -> None:
            with self.lock:
                if not self.closed:
                    done(result, seconds)

        self._task.content = title
        self._bar.value = 0.0
        self._working.visible = True
        if not self.jobs.start(work, finished, self._failed, self._ended):
            raise InvalidInputError("something else is being done; wait for it, or cancel it")

    def hand_over(self, name: str, content: bytes) -> None:
        """A file for the browser to save."""
        self.client.send_file_download(name, content, save_immediately=True)
        self.say("Downloaded", name)

    def close(self) -> None:
        """The window is gone, and what it asked for is not wanted any more."""
        super().close()
        self.jobs.cancel()
        self.uploads.close()

    def _failed(self, error: BaseException) -> None:
        if isinstance(error, Cancelled):
            self.say("Cancelled")
        else:
            self.report(error)

    def _ended(self) -> None:
        if not self.closed:
            self._working.visible = False

    def _progress(self, share: float, words: str) -> None:
        now = time.monotonic()
        if self.closed or now - self._progress_at < _PROGRESS_S:
            return
        self._progress_at = now
        self._bar.value = 100 * share
        if words:
            self._task.content = words


def _answered(modal: Any, go_on: Callable[[Sequence[Clip]], None], stay: Sequence[Clip], _: object) -> None:
    modal.close()
    go_on(stay)


def _other_colour(clips: Sequence[Clip]) -> tuple[int, int, int]:
    """The first colour that no clip has."""
    taken = {clip.colour for clip in clips}
    return next((colour(i) for i in range(len(clips) + 1) if colour(i) not in taken), colour(len(clips)))


def _goes_far(clip: Clip) -> bool:
    """Whether a clip leaves what is in sight at its start."""
    way = clip.motion.root[:, [0, 2]] - clip.motion.root[0, [0, 2]]
    return bool(np.linalg.norm(way, axis=1).max() > FAR)
