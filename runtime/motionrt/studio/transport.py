"""The playback panel: play, pause, step, scrub, speed, loop."""

from __future__ import annotations

import time
from functools import partial
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from motionrt.studio.windows import Window

STEPS = ("|◀", "◀ 1", "1 ▶", "▶|")
SPEEDS = {"¼×": 0.25, "½×": 0.5, "1×": 1.0, "2×": 2.0, "4×": 4.0}
KEYS = (
    ("Play or pause", "space", 0),
    ("Play or pause (P)", "P", 0),
    ("Frame back", "arrowleft", -1),
    ("Frame back (J)", "J", -1),
    ("Frame on", "arrowright", 1),
    ("Frame on (K)", "K", 1),
)
_REFRESH_S = 0.1  # the slider follows the clock ten times a second, figures thirty times


class Transport:
    """The controls of a session's clock.

    Args:
        session: whose.
    """

    def __init__(self, session: Window) -> None:
        self._session, self._shown_at = session, 0.0
        gui, guarded = session.client.gui, session.guarded
        with gui.add_folder("Playback"):
            self._play: Any = gui.add_button("Pause", icon="player-pause", hint="Space or P")
            self._steps: Any = gui.add_button_group("Step", STEPS)
            self._time: Any = gui.add_slider("Time (s)", 0.0, 1.0, 0.01, 0.0)
            self._speed: Any = gui.add_button_group("Speed", tuple(SPEEDS))
            self._loop: Any = gui.add_checkbox("Loop", initial_value=session.clock.looping)
            self._words: Any = gui.add_markdown("")
        self._play.on_click(guarded(lambda _: self.toggle()))
        self._steps.on_click(guarded(lambda _: self._step(self._steps.value)))
        self._time.on_update(guarded(lambda _: self._scrub()))
        self._speed.on_click(guarded(lambda _: self._set_speed(self._speed.value)))
        self._loop.on_update(guarded(lambda _: self._set_loop()))
        for label, key, move in KEYS:
            command = gui.add_command(label, hotkey=key)
            command.on_trigger(guarded(partial(self._command, move)))
        for tenth in range(10):
            command = gui.add_command(f"Go to {10 * tenth} %", hotkey=str(tenth))
            command.on_trigger(guarded(partial(self._go, tenth / 10)))
        self.refit()

    def refit(self) -> None:
        """After other clips came: their length."""
        duration = max(self._session.clock.duration, 0.01)
        self._time.value = min(self._time.value, duration)
        self._time.max = round(duration, 3)
        self.refresh(force=True)

    def refresh(self, *, force: bool = False) -> None:
        """Show the clock."""
        now = time.monotonic()
        if not force and now - self._shown_at < _REFRESH_S:
            return
        self._shown_at = now
        clock, fps = self._session.clock, self._session.stage.fps
        self._time.value = round(min(clock.time, self._time.max), 3)
        self._play.label = "Pause" if clock.playing else "Play"
        self._play.icon = "player-pause" if clock.playing else "player-play"
        frames = max(round(clock.duration * fps), 1)
        frame = min(int(clock.time * fps + 1e-6) + 1, frames)
        speed = "" if clock.speed == 1 else f" · {clock.speed:g}× speed"
        self._words.content = f"frame **{frame}** of {frames} · {fps:g} fps{speed}"

    def toggle(self) -> None:
        """Play or pause."""
        self._session.clock.toggle()
        self._session.redraw()

    def _step(self, which: str) -> None:
        clock = self._session.clock
        if which == STEPS[0]:
            clock.seek(0.0)
        elif which == STEPS[-1]:
            clock.playing = False
            clock.seek(clock.duration)
        else:
            clock.step(-1 if which == STEPS[1] else 1, self._session.stage.fps)
        self._session.redraw()

    def _jump(self, frames: int) -> None:
        self._session.clock.step(frames, self._session.stage.fps)
        self._session.redraw()

    def _command(self, frames: int, _: object) -> None:
        """A key: so many frames on, or play and pause."""
        if frames:
            self._jump(frames)
        else:
            self.toggle()

    def _go(self, share: float, _: object) -> None:
        """A number key: to so many tenths of the clip."""
        self._session.clock.seek(share * self._session.clock.duration)
        self._session.redraw()

    def _scrub(self) -> None:
        self._session.clock.playing = False
        self._session.clock.seek(float(self._time.value))
        self._session.redraw()

    def _set_speed(self, name: str) -> None:
        self._session.clock.speed = SPEEDS[name]
        self.refresh(force=True)

    def _set_loop(self) -> None:
        self._session.clock.looping = bool(self._loop.value)
