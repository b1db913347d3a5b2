"""What undo brings back, what a reload takes up, and projects that come back as they were saved."""

from __future__ import annotations

import io
import json
import zipfile

import numpy as np
import pytest
from motions import walking

from motionrt.errors import InvalidInputError
from motionrt.locomotion import Script, WalkTo
from motionrt.motion import Motion
from motionrt.studio.clips import PALETTE, Clip
from motionrt.studio.draft import Draft
from motionrt.studio.plan_draft import PlanDraft
from motionrt.studio.project import plain_name, project_bytes, sheet_of, unpacked
from motionrt.studio.state import KEPT_S, STEPS_BACK, Kept, Past, State
from motionrt.studio.uploads import Uploads
from motionrt.synthesis.plan import Plan


def state(steps: int) -> State:
    return State(draft=Draft(steps=tuple(WalkTo(float(x), 0.0) for x in range(steps))))


def test_undo_goes_back_state_by_state_and_not_for_ever() -> None:
    past = Past()
    for number in range(STEPS_BACK + 10):
        past.push(state(number))
    found = [past.pop() for _ in range(STEPS_BACK)]
    assert [len(one.draft.steps) for one in found if one] == list(range(STEPS_BACK + 9, 9, -1))
    assert past.pop() is None


def test_work_is_kept_for_the_browser_that_did_it_for_an_hour_and_taken_once() -> None:
    now = [0.0]
    kept = Kept(lambda: now[0])
    kept.keep("one", state(1))
    kept.keep("one", state(2))
    kept.keep("two", state(3))
    kept.keep("two", State())  # nothing to lose
    kept.keep(None, state(4))
    assert kept.take("three") is None
    assert kept.take(None) is None
    assert [len(found.draft.steps) for found in (kept.take("one"), kept.take("one")) if found] == [2, 1]
    assert kept.take("one") is None
    now[0] = KEPT_S + 1
    assert kept.take("two") is None


def test_no_more_is_kept_than_windows_may_be_open() -> None:
    kept = Kept()
    for number in range(1, 40):
        kept.keep("one", state(number))
    found = []
    while (one := kept.take("one")) is not None:
        found.append(len(one.draft.steps))
    assert found == list(range(39, 39 - len(found), -1))
    assert len(found) == 8


def project() -> bytes:
    clip = Clip("my walk", walking(30), PALETTE[0], "a note", made=True)
    draft = Draft(steps=(WalkTo(1.0, 2.0),))
    return project_bytes(State((clip,), "overlaid", draft, PlanDraft().with_text("walk forward")))


def test_a_project_holds_clips_script_and_plan_that_are_read_again(tmp_path_factory: pytest.TempPathFactory) -> None:
    files = unpacked(project())
    sheet = sheet_of(files)
    assert sheet is not None
    assert sheet["layout"] == "overlaid"
    assert [(row["name"], row["note"]) for row in sheet["clips"]] == [("my walk", "a note")]
    uploads = Uploads()
    try:
        kept = {name: uploads.keep(name, content) for name, content in files if name != "project.json"}
        with uploads.alone():
            assert [(s.x, s.z) for s in Script.read(kept["script.yaml"]).steps if isinstance(s, WalkTo)] == [(1.0, 2.0)]
            assert PlanDraft.of(Plan.read(kept["plan.yaml"])).lines[0].text == "walk forward"
            from motionrt import load_motion

            back: Motion = load_motion(kept["clip0.npz"])
        np.testing.assert_allclose(back.positions(), walking(30).positions(), atol=1e-5)
    finally:
        uploads.close()


def zipped(**files: bytes) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name.replace("__", "/"), content)
    return out.getvalue()


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"no zip at all", "no ZIP file that can be read"),
        (project()[:-40], "no ZIP file that can be read"),
        (zipped(a__x=b"1", b__x=b"2"), "two files 'x'"),
        (zipped(**{f"f{n}": b"" for n in range(101)}), "101 files"),
        (zipped(big=bytes(300 * 2**20)), "unpacks to 314,572,800 bytes"),
    ],
)
def test_a_bundle_that_cannot_be_is_refused(content: bytes, words: str) -> None:
    with pytest.raises(InvalidInputError, match=words):
        unpacked(content)


@pytest.mark.parametrize(
    "sheet",
    [b"{", b"[]", b'{"version": 1}', b'{"version": 1, "clips": [3]}', json.dumps({"version": 9, "clips": []}).encode()],
)
def test_a_sheet_that_is_none_is_refused(sheet: bytes) -> None:
    with pytest.raises(InvalidInputError):
        sheet_of([("project.json", sheet)])


@pytest.mark.parametrize("name", ["../../etc/passwd", "C:\\\\x\\\\..\\\\y.bvh", "/abs.bvh", "..", "a/b/.hidden"])
def test_names_of_a_bundle_name_no_folder(name: str) -> None:
    assert not set(plain_name(name)) & set("/\\\\:")
    assert not plain_name(name).startswith(".")
