"""The pages of motionrt view and motionrt studio in headless Chromium."""

from __future__ import annotations

import re
import zipfile
from collections.abc import Callable, Iterator
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from characters import character
from chromium import Browser, Page, element, wait_until
from glb_files import glb, unpack
from studio_runtime import StudioRuntime

from motionrt.formats import load_motion
from motionrt.locomotion import Script
from motionrt.studio import open_studio, open_viewer
from motionrt.studio.showing import show_of
from motionrt.studio.workshop import Workshop
from motionrt.synthesis.plan import Plan

WIDTH, HEIGHT, SCALE = 900, 560, 0.35
FLOOR = 190, 470  # pixels where the ground is in sight, away from the panel


def frame(page: Page) -> int:
    found = re.search(r"frame (\d+) of", page.text())
    return int(found.group(1)) if found else -1


def bluish(png: bytes) -> int:
    """How many pixels left of the panel have the first figure's colour."""
    image = pytest.importorskip("PIL.Image", reason="looking at screenshots needs Pillow, which is not installed")
    pixels = np.asarray(image.open(BytesIO(png)).convert("RGB"), dtype=int)
    pixels = pixels[len(pixels) // 4 :, : pixels.shape[1] * (WIDTH - 340) // WIDTH]
    red, blue = pixels[..., 0], pixels[..., 2]
    return int((blue - red > 60).sum())


@pytest.fixture(scope="module")
def view(chromium: Browser, walk_file: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    missing = tmp_path_factory.mktemp("none") / "missing.bvh"
    served = open_viewer(show_of([walk_file, missing]), port=0)
    page = chromium.open(served.url, WIDTH, HEIGHT, SCALE)
    page.wait_text("my walk", 40)
    yield page
    page.close()
    served.stop()


@pytest.fixture
def studio(chromium: Browser, tmp_path: Path) -> Iterator[Callable[[], Page]]:
    served = open_studio(show_of([]), Workshop(StudioRuntime(), folder=tmp_path / "saved"), port=0)
    opened: list[Page] = []

    def open_page() -> Page:
        page = chromium.open(served.url, WIDTH, HEIGHT, SCALE)
        opened.append(page)
        page.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(tmp_path))
        page.wait_text("Find", 40)
        return page

    yield open_page
    for page in opened:
        page.close()
    served.stop()


def test_the_page_shows_a_figure_and_asks_nobody_but_its_server(view: Page) -> None:
    view.wait_text("of 90 · 30 fps")
    wait_until(lambda: bluish(view.screenshot()) > 200, 30, "a blue figure")
    outside = [url for url in view.requests() if not url.startswith(("http://127.0.0.1", "data:", "blob:"))]
    assert outside == []


def test_a_file_that_cannot_be_read_is_told_on_the_page(view: Page) -> None:
    view.wait_text("missing.bvh")


def test_it_plays_pauses_and_steps(view: Page) -> None:
    first = frame(view)
    wait_until(lambda: frame(view) != first, 20, "the next frame")
    view.click("Pause")
    view.wait_text("Play\n")
    view.click("|◀")
    wait_until(lambda: frame(view) == 1, 10, "frame 1")
    view.click("1 ▶")
    view.click("1 ▶")
    wait_until(lambda: frame(view) == 3, 10, "frame 3")
    view.click("◀ 1")
    wait_until(lambda: frame(view) == 2, 10, "frame 2")


def test_search_plays_hits_and_a_click_plays_one(studio: Callable[[], Page]) -> None:
    page = studio()
    page.click("Find")
    page.wait_text("4 hits in")
    page.wait_text("rank 3 · score 0.70")  # three side by side
    page.click("Play 2 · score 0.80")
    wait_until(lambda: "rank 3 · score" not in page.text(), 20, "one hit alone")
    assert "rank 2 · score 0.80" in page.text()
    page.fill("Text", "a unicorn")
    page.wait_text("no unicorns in this gallery")
    page.fill("Text", "a person")
    page.wait_text("rank 1 · score 0.90")


def test_generate_compose_describe_and_export(studio: Callable[[], Page], tmp_path: Path) -> None:
    page = studio()
    page.tab("Make")
    page.click("Generate")
    page.wait_text("generated in")
    page.click("Compose")
    page.wait_text("fill both slots")
    page.click("A")
    page.wait_text("A: wave the right hand")
    page.click("B")
    page.wait_text("B: wave the right hand")
    page.click("Compose")
    page.wait_text("composed in")
    page.click("Describe the selected clip")
    page.wait_text("somebody walks")
    page.tab("Export")
    page.click("Download")
    file = wait_until(lambda: next(tmp_path.glob("*.bvh"), None), 20, "a download")
    wait_until(lambda: file.read_bytes().endswith(b"\n"), 10, "all of it")
    assert load_motion(file).frames == 80
    page.click("Save in the folder saved")
    assert wait_until(lambda: list((tmp_path / "saved").glob("*.bvh")), 10, "a saved file")


def test_clicks_become_steps_that_are_performed_and_a_script(studio: Callable[[], Page], tmp_path: Path) -> None:
    page = studio()
    page.tab("Direct")
    page.click("Perform")
    page.wait_text("nothing to do yet")
    page.click("Walk")
    page.wait_text("click: Walk here")
    page.click_at(*FLOOR)
    page.wait_text("walk to ")
    page.click_at(FLOOR[0] + 120, FLOOR[1] - 60)
    wait_until(lambda: page.text().count("walk to ") == 2, 10, "a second step")
    page.click("Undo")
    wait_until(lambda: page.text().count("walk to ") == 1, 10, "one step less")
    page.click("Sit")
    page.wait_text("click: Sit down here")
    page.click_at(FLOOR[0] + 120, FLOOR[1] - 60)
    page.wait_text("sit: pelvis, left foot, right foot")
    page.click("Perform")
    page.wait_text("keypoints missed by", 30)
    page.click("Download as script")
    file = wait_until(lambda: next(tmp_path.glob("*.yaml"), None), 20, "a script")
    assert [type(step).__name__ for step in Script.read(file).steps] == ["WalkTo", "Act"]


def test_two_windows_do_not_disturb_each_other(studio: Callable[[], Page]) -> None:
    one, two = studio(), studio()
    one.click("Find")
    one.wait_text("4 hits in")
    assert "Nothing on the stage yet" in two.text()
    two.tab("Make")
    two.click("Generate")
    two.wait_text("generated in")
    assert "generated in" not in one.text()
    one.click("Pause")
    one.wait_text("Play\n")
    two.call("Page.bringToFront")
    moving = frame(two)
    wait_until(lambda: frame(two) != moving, 20, "the other window to play on")


def click_for(page: Page, name: str, text: str) -> None:
    """Click a button until the page answers with a text: a page that is busy drawing may miss a click."""

    def answered() -> bool:
        page.click(name)
        try:
            page.wait_text(text, 10)
        except TimeoutError:
            return False
        return True

    wait_until(answered, 90, text)


def upload_for(page: Page, button: str, file: Path) -> None:
    """Choose a file for the upload button with a text."""
    page.wait(
        "(b => { for (let s = 0; b && s < 4; s++, b = b.parentElement) {"
        " const f = b.querySelector('input[type=file]'); if (f) { f.id = 'chosen-now'; return true; } }"
        " return false; })"
        f"({element(button)})"
    )
    root = page.call("DOM.getDocument")["root"]["nodeId"]
    node = page.call("DOM.querySelector", nodeId=root, selector="#chosen-now")["nodeId"]
    page.call("DOM.setFileInputFiles", nodeId=node, files=[str(file)])
    page.run("document.querySelector('#chosen-now').removeAttribute('id')")


def test_a_plan_is_drafted_generated_and_written(studio: Callable[[], Page], tmp_path: Path) -> None:
    page = studio()
    page.tab("Plan")
    page.click("Generate the plan")
    page.wait_text("the plan has no text yet")
    page.click("Add text")
    page.wait_text("1. walk forward")
    page.fill("Text", "sit down")
    page.wait_text("2. sit down")
    click_for(page, "Place", "click where the pelvis is then")
    page.click_at(*FLOOR)
    page.wait_text("◆ place")
    click_for(page, "Generate the plan", "generated in")
    page.click("Download as plan")
    file = wait_until(lambda: next(tmp_path.glob("*.yaml"), None), 20, "a plan")
    found = wait_until(lambda: file.read_text().count("\n") > 3 and Plan.read(file), 10, "all of it")
    assert [item["text"] for item in found.timeline] == ["walk forward", "sit down"]
    assert [way.time for way in found.constraints.path] == [2.0]


def test_a_reload_brings_the_work_back_and_undo_takes_it_back(studio: Callable[[], Page]) -> None:
    page = studio()
    page.tab("Make")
    click_for(page, "Generate", "generated in")
    page.tab("Plan")
    page.click("Add text")
    page.wait_text("1. walk forward")
    page.call("Page.reload")
    page.wait_text("wave the right hand")
    assert page.dialogs == ["beforeunload"]  # the work was not saved
    page.tab("Plan")
    page.wait_text("1. walk forward")
    page.press("z")
    page.wait_text("Nothing on the stage yet")


def test_a_search_leaves_work_on_the_stage(studio: Callable[[], Page]) -> None:
    page = studio()
    page.tab("Make")
    click_for(page, "Generate", "generated in")
    page.tab("Search")
    click_for(page, "Find", "4 hits in")
    page.wait_text("rank 1")
    assert "generated in" in page.text()
    page.click("Find")
    wait_until(lambda: page.text().count("rank 1 ·") == 1, 20, "hits that took the place of the last ones")


def test_clips_and_projects_are_opened_and_saved(studio: Callable[[], Page], walk_file: Path, tmp_path: Path) -> None:
    page = studio()
    page.tab("Open")
    page.wait_text("Begin with any of these")
    upload_for(page, "Open clips", walk_file)
    page.wait_text("my walk")
    page.click("Download as project")
    file = wait_until(lambda: next(tmp_path.glob("*.zip"), None), 20, "a project")
    wait_until(lambda: zipfile.is_zipfile(file), 10, "all of it")
    other = studio()
    other.tab("Open")
    upload_for(other, "Open clips", file)
    other.wait_text("my walk")
    bad = tmp_path / "bad.zip"
    bad.write_bytes(b"PK nothing")
    upload_for(other, "Open clips", bad)
    other.wait_text("no ZIP file that can be read")


def drop(page: Page, *files: Path) -> None:
    """Let files fall onto the picture, as a user does."""
    for kind in ("dragEnter", "dragOver", "drop"):
        page.call(
            "Input.dispatchDragEvent",
            type=kind,
            x=FLOOR[0],
            y=FLOOR[1],
            data={"items": [], "files": [str(file) for file in files], "dragOperationsMask": 1},
        )


def test_several_files_that_are_dropped_are_opened(studio: Callable[[], Page], walk_file: Path, tmp_path: Path) -> None:
    other = tmp_path / "other walk.bvh"
    other.write_bytes(walk_file.read_bytes())
    page = studio()
    drop(page, walk_file, other)
    page.wait_text("my walk")
    page.wait_text("other walk")


def test_motion_is_seen_and_exported_on_a_character_of_the_users_own(
    studio: Callable[[], Page], tmp_path: Path, walk_file: Path
) -> None:
    hero = glb(character("mixamo")).save(tmp_path / "hero.glb")
    page = studio()
    drop(page, walk_file)
    page.wait_text("my walk")
    page.tab("Open")
    upload_for(page, "Open a character", hero)
    page.wait_text("Your character is on the stage")
    page.tab("Export")
    page.wait_text("On your character")
    click_for(page, "Download", "Downloaded")
    file = wait_until(lambda: next(tmp_path.glob("my*.glb"), None), 20, "a download")
    names = {node.get("name") for node in unpack(wait_until(file.read_bytes, 10, "all of it"))[0]["nodes"]}
    assert "mixamorig:Hips" in names
    page.tab("Open")
    upload_for(page, "Open a character", walk_file)
    page.wait_text("a character to look at is one of")


def test_a_performance_that_is_not_saved_is_not_thrown_away_unasked(studio: Callable[[], Page]) -> None:
    page = studio()
    page.tab("Direct")
    click_for(page, "Walk", "click: Walk here")
    page.click_at(*FLOOR)
    page.wait_text("walk to ")
    click_for(page, "Perform", "s of motion in")
    page.wait_text("not saved")
    page.click("Perform")
    page.wait_text("performance has not been saved")
    page.click("Keep both")
    page.wait_text("performance 2")
    page.tab("Open")
    click_for(page, "Download as project", "Downloaded")
    wait_until(lambda: "not saved" not in page.text(), 10, "clips that are saved")


def test_space_arrows_and_numbers_play_step_and_go_except_while_somebody_writes(view: Page) -> None:
    view.click_at(*FLOOR)
    if "Pause" in view.text():
        view.press(" ")
    view.wait_text("Play\n")
    view.press("0")
    wait_until(lambda: frame(view) == 1, 10, "frame 1")
    view.press("ArrowRight")
    wait_until(lambda: frame(view) == 2, 10, "frame 2")
    view.press("ArrowLeft")
    wait_until(lambda: frame(view) == 1, 10, "frame 1")
    view.press("5")
    wait_until(lambda: 44 <= frame(view) <= 47, 10, "the middle")
    view.press(" ")
    view.wait_text("Pause\n")
