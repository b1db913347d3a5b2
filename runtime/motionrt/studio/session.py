"""One browser window: its clips, its clock, its panels. Windows share nothing but the models."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from motionrt.errors import MotionRTError
from motionrt.studio.clips import Clip
from motionrt.studio.clock import Clock
from motionrt.studio.layout import frame_all
from motionrt.studio.markers import Markers, draw_scenery
from motionrt.studio.scenery import Scenery
from motionrt.studio.stage import Stage
from motionrt.studio.state import State
from motionrt.studio.transport import Transport
from motionrt.studio.view_panel import ViewPanel
from motionrt.studio.windows import Show

if TYPE_CHECKING:
    from motionrt.motion.skeleton import FloatArray

FRAME_S = 1 / 30  # figures move so often
FIELD_OF_VIEW = 0.72  # radians; viser's own 75 degrees bend people at the edges
ASPECT, PANEL_PIXELS = 1.6, 340  # of a usual window; how wide the panel is
FOLLOW_SHARE, FOLLOW_LEAST = 0.15, 0.01  # how much of its lag the camera makes up in a frame; metres
log = logging.getLogger(__name__)


def scenery_boxes(scenery: Scenery | None) -> list[FloatArray]:
    """The box around a scene, if there is one."""
    if scenery is None:
        return []
    low, high = scenery.scene.bounds
    return [np.array([[low[0], 0, low[1]], [high[0], 1.2, high[1]]], dtype=np.float32)]


class Session:
    """A window of ``motionrt view``.

    Args:
        client: of viser.
        show: what to begin with.
    """

    selecting = False  # whether one of several clips can be selected

    def __init__(self, client: Any, show: Show) -> None:
        self.client, self.given = client, show
        self.lock = threading.RLock()
        self.clock, self.stage = Clock(playing=show.playing), Stage(client)
        self.follow = False
        self._closed = threading.Event()
        self._target: FloatArray | None = None
        self.stage.character = show.character
        if show.layout is not None:
            self.stage.look.layout = show.layout
        self.markers = Markers(client)
        self._scenery_nodes: list[Any] = []
        self._scene_shown = True
        self.scenery: Scenery | None = None
        with client.atomic():
            self._build()
        if client.camera.image_width > 0 and (self.stage.clips or self.scenery is not None):
            self.frame_all()
        for problem in show.problems:
            self.complain(problem, seconds=None)

    def _build(self) -> None:
        self.transport = Transport(self)
        self.add_panels()
        self.view = ViewPanel(self, selecting=self.selecting)
        self.set_scenery(self.given.scenery)
        if self.given.draft is not None:
            self.markers.draw(self.given.draft)
        if self.given.path is not None:
            self.markers.draw_path(self.given.path)
        self.show(self.given.clips, rewind=True)

    def add_panels(self) -> None:
        """Panels between playback and view; the studio has some."""

    def chosen(self) -> None:
        """Another clip is selected."""

    def unsaved(self) -> Sequence[Clip]:
        """Clips on the stage that somebody made and has not saved; in the studio there may be some."""
        return ()

    def show(self, clips: Sequence[Clip], *, rewind: bool = False) -> None:
        """Put these clips on the stage instead of those that are there."""
        with self.lock:
            self.stage.show(clips, 0.0 if rewind else self.clock.time)
            self.clock.fit(self.stage.duration, rewind=rewind)
            self.view.refresh()
            self.transport.refit()

    def redraw(self) -> None:
        """Draw everything as the clock says, now."""
        with self.lock:
            self.stage.draw(self.clock.time)
            self.transport.refresh(force=True)

    def rearrange(self) -> None:
        """After the look of the stage changed."""
        with self.lock:
            self.stage.arrange(self.clock.time)
            self.clock.fit(self.stage.duration)
            self.transport.refit()

    def set_scenery(self, scenery: Scenery | None) -> None:
        """Draw another scene."""
        for node in self._scenery_nodes:
            node.remove()
        self.scenery = scenery
        self._scenery_nodes = [] if scenery is None else draw_scenery(self.client, scenery)
        self._scene_shown = True

    def reveal_scene(self, *, shown: bool) -> None:
        """Show or hide the scene and what is drawn into it."""
        self._scene_shown = shown
        self.markers.show(shown=shown)
        for node in self._scenery_nodes:
            node.visible = shown

    def frame_all(self, *more: FloatArray) -> None:
        """Move the camera to where everything is in sight, boxes ``(2, 3)`` that are given as well."""
        camera = self.client.camera
        boxes = [*more, *self.stage.boxes, *(scenery_boxes(self.scenery) if self._scene_shown else [])]
        covered = PANEL_PIXELS / max(camera.image_width, 2 * PANEL_PIXELS)
        place, target = frame_all(boxes, camera.fov, camera.aspect or ASPECT, covered)
        camera.position, camera.look_at = place, target
        self._target = None

    def run(self) -> None:
        """Let the clock tick until the window is closed."""
        last = time.perf_counter()
        while not self._closed.wait(max(0.0, FRAME_S - (time.perf_counter() - last))):
            now = time.perf_counter()
            try:
                self.tick(now - last)
            except Exception:
                if self._closed.is_set():
                    return
                log.exception("a frame could not be drawn")
            last = now

    def tick(self, seconds: float) -> None:
        """Let time pass."""
        with self.lock:
            if self.clock.advance(min(seconds, 0.5)):
                self.stage.draw(self.clock.time)
                self.transport.refresh()
                if self.follow:
                    self._follow()

    def state(self) -> State:
        """What the window holds that is worth keeping; a viewer's files are on the machine."""
        return State()

    def take_up(self, state: State) -> None:
        """Go on where a window that was closed left off; the studio does."""

    def close(self) -> None:
        """The window is gone."""
        self._closed.set()

    @property
    def closed(self) -> bool:
        """Whether the window is gone."""
        return self._closed.is_set()

    def guarded(self, act: Callable[[Any], None]) -> Callable[[Any], None]:
        """A callback of the page: one at a time, and whatever goes wrong is told there and ends nothing."""

        def run(event: Any) -> None:
            if self.closed or getattr(event, "client_id", 0) is None:  # set by the program, not by a user
                return
            try:
                with self.lock:
                    act(event)
            except Exception as error:  # noqa: BLE001  the page is told, the server goes on
                self.report(error)

        return run

    def report(self, error: BaseException) -> None:
        """Tell the page what went wrong."""
        if not isinstance(error, MotionRTError):
            log.error("unexpected", exc_info=error)
        words = str(error) if isinstance(error, MotionRTError) else f"unexpected {type(error).__name__}; see the log"
        self.complain(words)

    def complain(self, words: str, seconds: float | None = 15.0) -> None:
        """A red note on the page, for some seconds or until it is closed."""
        if not self.closed:
            self.client.add_notification("That did not work", words, color="red", auto_close_seconds=seconds)

    def say(self, title: str, words: str = "") -> None:
        """A note on the page."""
        if not self.closed:
            self.client.add_notification(title, words, color="green", auto_close_seconds=5.0)

    def _follow(self) -> None:
        """The camera goes along with the figures, softly; its direction and distance stay the user's."""
        focus = self.stage.focus(self.clock.time) * np.array([1, 0, 1], dtype=np.float32)
        if self._target is None:
            self._target = focus
        lag = focus - self._target
        if np.linalg.norm(lag) > 3:  # the clip began again
            self._target, step = focus, lag
        else:
            step = FOLLOW_SHARE * lag
            self._target = self._target + step
        if np.linalg.norm(step) > FOLLOW_LEAST * FOLLOW_SHARE:
            self.client.camera.position = np.asarray(self.client.camera.position) + step
