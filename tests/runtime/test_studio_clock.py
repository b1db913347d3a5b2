"""The playback clock."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from motionrt.studio.clock import Clock


def test_time_goes_on_at_the_chosen_speed() -> None:
    clock = Clock(duration=10, speed=0.5)
    assert clock.advance(2.0)
    assert clock.time == pytest.approx(1.0)


def test_nothing_has_to_be_drawn_while_paused_or_without_a_clip() -> None:
    assert not Clock(duration=10, playing=False).advance(1)
    assert not Clock(duration=0).advance(1)


@given(st.floats(0.1, 100), st.floats(-300, 300), st.floats(-4, 4))
def test_a_looping_clock_stays_within_the_clip(duration: float, seconds: float, speed: float) -> None:
    clock = Clock(duration=duration, speed=speed)
    clock.advance(seconds)
    assert 0 <= clock.time <= duration
    assert clock.playing


def test_a_loop_carries_over_what_is_beyond_the_end() -> None:
    clock = Clock(duration=4, time=3.5)
    clock.advance(1.0)
    assert clock.time == pytest.approx(0.5)


@pytest.mark.parametrize(("speed", "begin", "end"), [(1.0, 3.5, 4.0), (-1.0, 0.5, 0.0)])
def test_without_loop_it_stops_at_the_end_and_starts_again_from_the_other(
    speed: float, begin: float, end: float
) -> None:
    clock = Clock(duration=4, time=begin, speed=speed, looping=False)
    clock.advance(1.0)
    assert (clock.time, clock.playing) == (end, False)
    clock.toggle()
    assert (clock.time, clock.playing) == (4 - end, True)


def test_steps_pause_and_land_on_frames() -> None:
    clock = Clock(duration=4, time=1.01)
    clock.step(1, 30)
    assert clock.time == pytest.approx(31 / 30)
    assert not clock.playing
    clock.step(-100, 30)
    assert clock.time == 0
    clock.step(1000, 30)
    assert clock.time == 4


def test_a_shorter_clip_pulls_the_time_back() -> None:
    clock = Clock(duration=9, time=8)
    clock.fit(3)
    assert (clock.duration, clock.time) == (3, 3)
    clock.fit(5, rewind=True)
    assert clock.time == 0


def test_a_time_that_is_no_number_is_not_taken() -> None:
    clock = Clock(duration=4, time=2)
    clock.seek(math.nan)
    assert clock.time == 2
    assert not clock.advance(math.inf)
