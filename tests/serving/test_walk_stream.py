"""A walking character over a WebSocket."""

from __future__ import annotations

import json
import time

import numpy as np
import pytest
from service import TOKEN, Served

from motionrt.motion import SMPL24

sync = pytest.importorskip("websockets.sync.client", reason="the extra serve is not installed")
exceptions = pytest.importorskip("websockets.exceptions", reason="the extra serve is not installed")


def connect(served: Served, query: str = f"?token={TOKEN.replace(' ', '%20')}", **options: object) -> object:
    return sync.connect(f"ws://127.0.0.1:{served.port}/v1/walk{query}", open_timeout=20, **options)


def test_frames_come_in_order_and_follow_new_goals(served: Served) -> None:
    with connect(served, f"?paced=false&token={TOKEN.replace(' ', '%20')}") as socket:
        socket.send(json.dumps({"x": 0, "z": 5}))
        assert json.loads(socket.recv())["joints"] == list(SMPL24.names)
        frames = [json.loads(socket.recv()) for _ in range(60)]
        assert [frame["frame"] for frame in frames] == list(range(60))
        assert np.shape(frames[0]["rotations"]) == (24, 4)
        np.testing.assert_allclose(np.linalg.norm(frames[-1]["rotations"], axis=1), 1, atol=1e-3)
        socket.send(json.dumps({"x": 5, "z": 0, "heading": 1.5}))
        later = [json.loads(socket.recv()) for _ in range(400)]
        assert later[-1]["root"][0] > frames[-1]["root"][0] + 1


def test_frames_are_paced_at_30_a_second(served: Served) -> None:
    with connect(served) as socket:
        socket.send(json.dumps({"x": 0, "z": 5}))
        socket.recv()
        began = time.perf_counter()
        for _ in range(60):
            socket.recv()
        assert time.perf_counter() - began > 1.2  # of 2 s; a busy machine starts late, and catches up


@pytest.mark.parametrize("message", ["{", '{"x": "far"}', '{"x": 1e9, "z": 0}', '{"x": 0, "z": 1, "speed": 3}'])
def test_a_goal_that_is_none_closes_the_stream_with_a_reason(served: Served, message: str) -> None:
    with connect(served) as socket:
        socket.send(message)
        with pytest.raises(exceptions.ConnectionClosed) as caught:
            socket.recv(timeout=20)
    assert caught.value.rcvd.code == 4400
    assert caught.value.rcvd.reason


def test_without_the_token_there_is_no_stream(served: Served) -> None:
    with pytest.raises((exceptions.InvalidStatus, exceptions.ConnectionClosed)):
        connect(served, "?token=wrong").recv()


def test_other_pages_get_no_stream(served: Served) -> None:
    with pytest.raises((exceptions.InvalidStatus, exceptions.ConnectionClosed)):
        connect(served, origin="https://evil.example").recv()


def test_more_streams_than_windows_are_refused_and_closed_ones_make_room(
    served: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MOTIONRT_LIMITS", "windows=1")
    _all_closed(served)  # those of other tests
    with connect(served) as first:
        first.send(json.dumps({"x": 0, "z": 5}))
        first.recv()
        with connect(served) as second, pytest.raises(exceptions.ConnectionClosed) as caught:
            second.recv(timeout=20)
        assert caught.value.rcvd.code == 4503
    _all_closed(served)
    with connect(served) as third:
        third.send(json.dumps({"x": 0, "z": 5}))
        assert json.loads(third.recv())["fps"] == 30


def _all_closed(served: Served) -> None:
    """Wait until the service has heard that no stream is open."""
    for _ in range(200):
        if served.app._metrics.streams == 0:  # type: ignore[attr-defined]
            return
        time.sleep(0.05)
