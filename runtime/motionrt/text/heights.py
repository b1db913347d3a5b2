"""How high a text says that the pelvis is in time, and where a way bends to both sides."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from motionrt.motion.skeleton import FloatArray
from motionrt.text.query import TextAttributes

_HEIGHTS = {  # of the pelvis of smpl24, metres; medians of recordings
    "standing": 0.94, "crouching": 0.58, "sitting": 0.5, "crawling": 0.45, "kneeling": 0.44, "lying": 0.09,
}  # fmt: skip
_FLOOR = re.compile(r"\b(?:floor|ground)\b")
_PICKED = 0.64  # metres: the pelvis of who picks something up from the floor
_LEAST_CHANGE, _OVER = 0.2, 0.1  # metres
_FIRST, _LAST, _LATEST_S = 0.4, 0.7, 2.0  # when it changes: parts of the motion, seconds at most for the first
_CHANGE_S = 0.2  # of the logistic curve of a change, which lasts about six times as long
_JUMPERS = frozenset({"jump", "hop", "jumping jack"})
_ONE_JUMP, _EACH = 0.28, {"jump": 0.16, "hop": 0.12, "jumping jack": 0.12}  # metres that the pelvis is thrown up
_LASTS_S = {"jump": 0.9, "hop": 0.7, "jumping jack": 1.0}  # seconds of each
_FIRST_JUMP_S, _LEAST_JUMP_S = 0.4, 0.55  # before the first, and of each at least
_ZIGZAG, _ZIGZAG_S, _EIGHT = 0.75, 2.8, 5.6  # radians to either side, seconds to and fro; radians of one loop
_LEAP = 0.8  # metres that somebody gets on in a jump that goes somewhere

Array = npt.NDArray[np.float64]


def heights_of_text(said: TextAttributes, times: npt.ArrayLike) -> FloatArray | None:
    """Heights ``(F,)`` of the pelvis of ``smpl24``, metres, at times ``(F,)`` in seconds, of texts that go down or up.

    None where the text stays at a level, moves on as well, or does not say how high it is.
    """
    at = np.asarray(times, np.float64)
    seconds = float(at[-1])
    moves_on = said.travel not in (None, "none") or said.turn not in (None, "none") or said.path or said.course
    if said.jumps:
        jumps = _jumps(said, seconds)
        return None if jumps is None else jumps.heights(at)
    course = None if moves_on else _course(said)
    if course is None:
        return None
    start, middle, end = course
    once = middle is None
    first = min((_FIRST if once else 1 - _LAST) * seconds, _LATEST_S)
    heights = start + ((end if middle is None else middle) - start) * _changed(at - first)
    if middle is not None:
        heights = heights + (end - middle) * _changed(at - _LAST * seconds)
    return np.asarray(heights, np.float32)


@dataclass(frozen=True)
class _Jumps:
    """Jumps at `tops` seconds, `up` metres high, about `each` seconds apart; `way` metres forward each."""

    tops: tuple[float, ...]
    up: float
    each: float
    way: float

    @property
    def falls(self) -> float:
        """Seconds from the top to the floor."""
        return float(np.sqrt(2 * self.up / 9.81))

    def heights(self, times: Array) -> FloatArray:
        """Of a pelvis that goes down, is thrown up and comes down again."""
        heights = np.full(len(times), _HEIGHTS["standing"])
        for top in self.tops:
            t = times - top
            flight = self.up * np.maximum(1 - (t / self.falls) ** 2, 0)
            before = _bump((t + self.falls + self.each / 6) / (self.each / 4))
            after = _bump((t - self.falls - self.each / 8) / (self.each / 4))
            heights += flight - self.up * (0.9 * before + 0.6 * after)
        return np.asarray(heights, np.float32)


def strides_of_text(said: TextAttributes, times: npt.ArrayLike) -> FloatArray | None:
    """Metres per second ``(F,)`` forward, at times ``(F,)`` in seconds, of somebody who jumps forward or backward."""
    at = np.asarray(times, np.float64)
    jumps = _jumps(said, float(at[-1])) if said.jumps else None
    if jumps is None:
        return None
    fast = [jumps.way / (2 * jumps.falls) * (np.abs(at - top) < jumps.falls) for top in jumps.tops]
    return np.asarray(np.sum(fast, axis=0), np.float32)


def _jumps(said: TextAttributes, seconds: float) -> _Jumps | None:
    """The jumps of a text of nothing but jumps."""
    elsewhere = said.turn not in (None, "none") or said.path or said.course or said.posture_lowest is not None
    onward = said.travel == "backward" or (said.travel == "forward" and said.steps is None)
    stays = said.travel in (None, "none")
    if elsewhere or not (stays or onward) or not set(said.actions) <= _JUMPERS:
        return None
    if seconds < _FIRST_JUMP_S + _LEAST_JUMP_S:
        return None
    often = said.jumps or 1
    kind = said.action or "jump"
    left, usual = seconds - _FIRST_JUMP_S, _LASTS_S[kind]
    count = often if often > 0 else max(2, int(left / usual))
    each = min(max(left / count, _LEAST_JUMP_S), usual)
    count = min(count, int(left / each + 1e-6))
    first = 0.45 * seconds if count == 1 else _FIRST_JUMP_S + each / 2
    up = _ONE_JUMP if often == 1 and kind == "jump" else _EACH[kind]
    way = _LEAP * (up / _ONE_JUMP) * {"forward": 1.0, "backward": -0.7}.get(said.travel or "", 0.0)
    return _Jumps(tuple(first + number * each for number in range(count)), up, each, way)


def _bump(x: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    return np.asarray(np.where(np.abs(x) < 1, 0.5 + 0.5 * np.cos(np.pi * np.clip(x, -1, 1)), 0.0))


def headings_of_text(said: TextAttributes, times: npt.ArrayLike) -> FloatArray | None:
    """Headings ``(F,)``, radians, left positive, at times ``(F,)`` in seconds, of a way that bends to both sides."""
    at = np.asarray(times, np.float64)
    if said.course is None or len(at) < 2:
        return None
    seconds = float(at[-1])
    if said.course == "zigzag":
        return np.asarray(_ZIGZAG * np.sin(2 * np.pi * at / min(_ZIGZAG_S, seconds / 1.5)), np.float32)
    return np.asarray(_EIGHT * (1 - np.abs(2 * at / seconds - 1)), np.float32)


def ceiling_of_text(said: TextAttributes) -> float | None:
    """Metres below which the pelvis of ``smpl24`` stays in a text of one low posture; None elsewhere."""
    low = said.posture_lowest
    stays = low is not None and low == said.posture_start == said.posture_end and said.level in (None, "level")
    height = _HEIGHTS.get(low or "", _HEIGHTS["standing"])
    return height + _OVER if stays and height < _HEIGHTS["standing"] else None


def _changed(times: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    return np.asarray(1 / (1 + np.exp(-times / _CHANGE_S)))


def _course(said: TextAttributes) -> tuple[float, float | None, float] | None:
    """Heights at the start, in the middle where it is another one, and at the end."""
    up = _HEIGHTS["standing"]
    start, end = (_HEIGHTS.get(name or "") for name in (said.posture_start, said.posture_end))
    lowest = _HEIGHTS.get(said.posture_lowest or "")
    middle = None
    if said.action == "pick up" and said.hands_low and lowest is None and _FLOOR.search(said.text):
        return up, _PICKED, up
    if said.level == "up":
        risen_from = 0.3 if _FLOOR.search(said.text) else _HEIGHTS["sitting"]
        start, end = next(height for height in (start, lowest, risen_from) if height is not None), up
    elif said.level == "down":
        start, end = up, lowest if end is None else end
    elif said.level == "down and up" or (start in (None, up) and end == up and lowest is not None):
        start, middle, end = up, lowest, up
    if start is None or end is None:
        return None
    if start == end == lowest == _HEIGHTS["lying"]:
        return start, None, end
    changes = max(start, end) - min(start, end, end if middle is None else middle)
    return (start, middle, end) if changes >= _LEAST_CHANGE else None
