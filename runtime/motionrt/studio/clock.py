"""The playback clock: where in time the clips are."""

from __future__ import annotations

import math
from dataclasses import dataclass

SPEEDS = (0.1, 0.25, 0.5, 1.0, 2.0, 4.0)


@dataclass
class Clock:
    """Plays from 0 to ``duration`` seconds.

    Attributes:
        duration: seconds of the longest clip.
        time: seconds, from 0 to ``duration``.
        speed: seconds of motion a second; negative plays backwards.
        playing: whether time goes on.
        looping: whether it begins again at the end, or stays there.
    """

    duration: float = 0.0
    time: float = 0.0
    speed: float = 1.0
    playing: bool = True
    looping: bool = True

    def advance(self, seconds: float) -> bool:
        """Let real time pass; whether anything has to be drawn again."""
        if not self.playing or self.duration <= 0 or not math.isfinite(seconds):
            return False
        before, wanted = self.time, self.time + seconds * self.speed
        if self.looping:
            self.time = wanted % self.duration
        else:
            self.time = min(max(wanted, 0.0), self.duration)
            self.playing = 0.0 < self.time < self.duration or self.time == wanted
        return self.time != before

    def toggle(self) -> None:
        """Play or pause; at an end, from the other end."""
        self.playing = not self.playing
        if self.playing and not self.looping:
            if self.speed > 0 and self.time >= self.duration:
                self.time = 0.0
            elif self.speed < 0 and self.time <= 0:
                self.time = self.duration

    def seek(self, time: float) -> None:
        """Go to a time, clipped to the clip."""
        self.time = min(max(time, 0.0), self.duration) if math.isfinite(time) else self.time

    def step(self, frames: int, fps: float) -> None:
        """Pause, and go to a frame before or after this one."""
        self.playing = False
        self.seek((round(self.time * fps) + frames) / fps)

    def fit(self, duration: float, *, rewind: bool = False) -> None:
        """Another length of the longest clip."""
        self.duration = max(duration, 0.0)
        self.time = 0.0 if rewind else min(self.time, self.duration)
