"""Work in the background: progress, cancelling, errors, taking turns."""

from __future__ import annotations

import threading

import pytest

from motionrt.errors import InvalidInputError, PathError
from motionrt.formats.fbx.write import can_write_fbx
from motionrt.studio.jobs import Cancelled, Jobs, Told
from motionrt.studio.serving import free_port
from motionrt.studio.workshop import file_name, formats, motion_bytes, save_in


class Heard:
    def __init__(self) -> None:
        self.told: list[tuple[float, str]] = []
        self.results: list[object] = []
        self.errors: list[BaseException] = []
        self.ends = 0

    def jobs(self, desk: threading.Lock | None = None) -> Jobs:
        return Jobs(desk or threading.Lock(), lambda share, words: self.told.append((share, words)))

    def start(self, jobs: Jobs, work: object) -> bool:
        return jobs.start(work, lambda r, _: self.results.append(r), self.errors.append, self._end)  # type: ignore[arg-type]

    def _end(self) -> None:
        self.ends += 1


def test_progress_and_result_arrive() -> None:
    heard = Heard()
    jobs = heard.jobs()

    def work(told: Told) -> int:
        told(1, 4, "walking")
        return 42

    assert heard.start(jobs, work)
    assert jobs.wait(10)
    assert heard.told[0] == (0.25, "walking")
    assert (heard.results, heard.errors, heard.ends) == ([42], [], 1)


def test_an_error_is_handed_over_and_the_next_job_runs() -> None:
    heard = Heard()
    jobs = heard.jobs()

    def work(_: Told) -> None:
        raise PathError("a wall")

    heard.start(jobs, work)
    assert jobs.wait(10)
    assert isinstance(heard.errors[0], PathError)
    heard.start(jobs, lambda _: 1)
    assert jobs.wait(10)
    assert heard.results == [1]


def test_a_job_can_be_cancelled_while_it_works() -> None:
    heard, going = Heard(), threading.Event()
    jobs = heard.jobs()

    def work(told: Told) -> None:
        while True:
            going.set()
            told(0, 1, "on and on")

    heard.start(jobs, work)
    assert going.wait(10)
    assert not heard.start(jobs, work)  # one at a time
    jobs.cancel()
    assert jobs.wait(10)
    assert isinstance(heard.errors[0], Cancelled)


def test_windows_take_turns_and_who_waits_can_be_cancelled() -> None:
    desk, heard = threading.Lock(), Heard()
    jobs = heard.jobs(desk)
    with desk:
        heard.start(jobs, lambda _: 1)
        assert not jobs.wait(0.3)
        assert heard.told[0] == (0.0, "waiting for another window")
        jobs.cancel()
        assert jobs.wait(10)
    assert isinstance(heard.errors[0], Cancelled)
    assert not desk.locked()


def test_a_taken_port_is_a_typed_error_that_says_what_to_do() -> None:
    import socket

    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        with pytest.raises(InvalidInputError, match="--port"):
            free_port("127.0.0.1", other.getsockname()[1])
    assert free_port("127.0.0.1", 0) > 0
    with pytest.raises(InvalidInputError, match="0 to 65535"):
        free_port("127.0.0.1", 70000)
    with pytest.raises(InvalidInputError, match="--host"):
        free_port("203.0.113.1", 0)


def test_files_have_plain_names_and_none_is_overwritten(tmp_path) -> None:  # type: ignore[no-untyped-def]
    assert file_name("sub/dir/größe 1.BVH", "bvh") == "sub__dir__größe_1.bvh"
    assert file_name("../..", "npz") == "motion.npz"
    assert save_in(tmp_path, "a.bvh", b"1").name == "a.bvh"
    assert save_in(tmp_path, "a.bvh", b"2").name == "a-2.bvh"
    (tmp_path / "file").write_bytes(b"")
    with pytest.raises(InvalidInputError, match="cannot save"):
        save_in(tmp_path / "file", "a.bvh", b"")


@pytest.mark.parametrize("form", formats())
def test_a_motion_is_exported_in_every_format_that_is_written(form: str) -> None:
    from motions import walking

    if form == "fbx" and not can_write_fbx():
        pytest.skip("no Blender on this machine (Debian: apt install blender)")
    assert len(motion_bytes(walking(5), form)) > 500
    with pytest.raises(InvalidInputError, match="unknown format"):
        motion_bytes(walking(5), "xyz")
