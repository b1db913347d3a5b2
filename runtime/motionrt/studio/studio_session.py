"""A window of ``motionrt studio``: search, make, direct, export."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from motionrt.errors import InvalidInputError
from motionrt.motion import Motion
from motionrt.studio.clips import Clip, colour, unique
from motionrt.studio.direct_panel import DirectPanel
from motionrt.studio.export_panel import ExportPanel
from motionrt.studio.jobs import Cancelled, Jobs, Work
from motionrt.studio.layout import AS_RECORDED, SIDE_BY_SIDE
from motionrt.studio.make_panel import MakePanel
from motionrt.studio.search_panel import SearchPanel
from motionrt.studio.session import Session
from motionrt.studio.windows import Show
from motionrt.studio.workshop import Workshop

T = TypeVar("T")
NOTHING = "nothing yet"
_PROGRESS_S = 0.1


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
        with tabs.add_tab("Direct", "route"):
            self.direct = DirectPanel(self)
        with tabs.add_tab("Export", "download"):
            self.export = ExportPanel(self)

    def show(self, clips: Sequence[Clip], *, rewind: bool = False) -> None:
        """As for any window; what is selected follows."""
        super().show(clips, rewind=rewind)
        self.export.refresh()
        self.make.refresh()

    def chosen(self) -> None:
        """Another clip is selected."""
        self.export.refresh()
        self.make.refresh()

    def present(self, motions: Sequence[tuple[str, Motion, str]], *, keep: bool = False, world: bool = False) -> None:
        """Play new motions (name, motion, note) from the start.

        Args:
            motions: what to play.
            keep: leave what is on the stage there.
            world: they stand where they stand; otherwise several are put side by side.
        """
        with self.lock:
            clips = list(self.stage.clips) if keep else []
            for name, motion, note in motions:
                clips.append(Clip(unique(name, clips), motion, _other_colour(clips), note))
            self.view.set_layout(AS_RECORDED if world or len(clips) < 2 else SIDE_BY_SIDE)
            self.clock.playing = True
            self.reveal_scene(shown=world)
            self.show(clips, rewind=True)
            if not world or self.scenery is None:  # who directs has chosen where to look from
                self.frame_all()

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
        self.direct.uploads.close()

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


def _other_colour(clips: Sequence[Clip]) -> tuple[int, int, int]:
    """The first colour that no clip has."""
    taken = {clip.colour for clip in clips}
    return next((colour(i) for i in range(len(clips) + 1) if colour(i) not in taken), colour(len(clips)))
