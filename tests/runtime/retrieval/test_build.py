"""A user's folder: odd names, broken files; building it, updating it, being killed while doing so."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from fake_embedder import FakeEmbedder, open_fake, open_other
from motions import random_motion, walking

from motionrt import limits
from motionrt.errors import GalleryError, GalleryNotFoundError, InvalidInputError, MotionFileNotFoundError
from motionrt.formats import save_motion
from motionrt.motion import Motion
from motionrt.retrieval import Gallery, build_gallery, motion_features, update_gallery
from motionrt.retrieval.locking import writing

GOOD = ["Ünï cödé/日本 walk.BVH", "a b/turn.bvh", "a b/deeper/turn.bvh", "long.bvh", "one frame.npz"]
BROKEN = ["cut off.bvh", "empty.bvh", "not zip.npz"]


def write_folder(folder: Path) -> Path:
    motions = [walking(40), walking(50, turn=0.5), walking(50, turn=-0.5), random_motion(450), walking(1)]
    for name, motion in zip(GOOD, motions, strict=True):
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        save_motion(motion, path.with_suffix(path.suffix.lower())).rename(path)
    text = (folder / "long.bvh").read_text(encoding="utf-8")
    (folder / "cut off.bvh").write_text(text[: text.index("MOTION") // 2], encoding="utf-8")  # amid its joints
    (folder / "empty.bvh").touch()
    (folder / "not zip.npz").write_bytes(b"nothing")
    for ignored in (".hidden/walk.bvh", "._long.bvh", "notes.txt"):
        (folder / ignored).parent.mkdir(exist_ok=True)
        shutil.copy(folder / "long.bvh", folder / ignored)
    return folder


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_folder(tmp_path / "my mocap")


def files_of(gallery: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in gallery.iterdir()}


def test_all_good_files_are_indexed_and_broken_ones_listed_with_reasons(folder: Path) -> None:
    report = build_gallery(folder, open_fake)
    assert [clip.id for clip in report.gallery.clips] == sorted(GOOD)
    assert report.added == tuple(sorted(GOOD))
    assert [skipped.path for skipped in report.gallery.skipped] == sorted(BROKEN)
    assert all(skipped.reason and "\n" not in skipped.reason for skipped in report.gallery.skipped)
    assert report.gallery.folder == folder / ".motionrt-gallery"


def test_a_hit_names_its_file_and_loads_it(folder: Path) -> None:
    gallery = build_gallery(folder, open_fake).gallery
    model = FakeEmbedder()
    original = gallery.motion("a b/turn.bvh")
    hit = gallery.search(model.embed_motion([motion_features(original)])[0], k=1)[0]
    assert hit.path == folder / "a b" / "turn.bvh"
    assert gallery.motion(hit).frames == original.frames == 50


def test_the_gallery_of_an_indexed_folder_opens_by_that_folder(folder: Path) -> None:
    build_gallery(folder, open_fake)
    assert len(Gallery.open(folder)) == len(GOOD)


def test_progress_counts_every_file(folder: Path) -> None:
    seen: list[tuple[int, int]] = []
    build_gallery(folder, open_fake, progress=lambda done, total, name: seen.append((done, total)))
    assert seen == [(i, 8) for i in range(1, 9)]


def test_two_processes_build_the_same_bytes_as_one(folder: Path, tmp_path: Path) -> None:
    build_gallery(folder, open_fake, out=tmp_path / "one", jobs=1)
    build_gallery(folder, open_fake, out=tmp_path / "two", jobs=2)
    assert files_of(tmp_path / "one") == files_of(tmp_path / "two")


def test_folder_and_gallery_may_move_together(folder: Path, tmp_path: Path) -> None:
    build_gallery(folder, open_fake)
    moved = folder.rename(tmp_path / "moved")
    gallery = Gallery.open(moved)
    assert gallery.path(gallery.clips[0]) == moved / gallery.clips[0].id
    assert gallery.motion("long.bvh").frames == 450


def test_an_update_reads_only_what_is_new_or_changed(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    build_gallery(folder, open_fake)
    for name in BROKEN:
        (folder / name).unlink()
    save_motion(walking(33), folder / "new.bvh")
    save_motion(walking(44), folder / "long.bvh")
    (folder / "one frame.npz").unlink()
    os.utime(folder / "a b" / "turn.bvh", ns=(1, 1))  # touched, the same content
    read: list[str] = []
    model = FakeEmbedder()
    report = update_gallery(folder, lambda: model, progress=lambda done, total, name: read.append(name))
    assert read == ["a b/turn.bvh", "long.bvh", "new.bvh"]
    assert model.calls == 2  # one window each of the two files whose content is new
    assert (report.added, report.changed, report.removed) == (("new.bvh",), ("long.bvh",), ("one frame.npz",))
    assert set(report.unchanged) == {*GOOD, "new.bvh"} - {"long.bvh", "one frame.npz", "new.bvh"}
    assert report.gallery.skipped == ()


def test_an_updated_gallery_is_the_one_that_a_build_gives(folder: Path) -> None:
    build_gallery(folder, open_fake)
    save_motion(walking(44), folder / "long.bvh")
    os.utime(folder / "a b" / "turn.bvh", ns=(1, 1))
    updated = files_of(update_gallery(folder, open_fake).gallery.folder or folder)
    assert updated == files_of(build_gallery(folder, open_fake).gallery.folder or folder)


def test_a_file_that_broke_since_leaves_the_gallery_and_is_listed(folder: Path) -> None:
    build_gallery(folder, open_fake)
    (folder / "long.bvh").write_text("HIERARCHY", encoding="utf-8")
    report = update_gallery(folder, open_fake)
    assert report.removed == ("long.bvh",)
    assert "long.bvh" in [skipped.path for skipped in report.gallery.skipped]


def test_an_update_with_another_model_is_refused(folder: Path) -> None:
    build_gallery(folder, open_fake)
    with pytest.raises(GalleryError, match=r"made by the model fake .*, not by another"):
        update_gallery(folder, open_other)


def test_a_gallery_not_made_from_files_cannot_be_updated(tmp_path: Path) -> None:
    Gallery.from_motions([walking(9)], ["walk"], FakeEmbedder()).save(tmp_path)
    with pytest.raises(GalleryError, match="not made from files"):
        update_gallery(tmp_path, open_fake)


def test_without_a_gallery_there_is_nothing_to_update(folder: Path) -> None:
    with pytest.raises(GalleryNotFoundError, match="motionrt gallery build"):
        update_gallery(folder, open_fake)


KILLED_BUILD = """
import os, sys
from fake_embedder import open_fake
from motionrt.retrieval import build_gallery
build_gallery(sys.argv[1], open_fake, progress=lambda done, total, name: os._exit(9) if done == 4 else None)
"""


def test_a_killed_build_leaves_the_old_gallery_and_no_lock(folder: Path) -> None:
    build_gallery(folder, open_fake)
    before = files_of(folder / ".motionrt-gallery")
    save_motion(walking(44), folder / "long.bvh")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    killed = subprocess.run([sys.executable, "-c", KILLED_BUILD, str(folder)], env=environment, check=False)
    assert killed.returncode == 9
    assert files_of(folder / ".motionrt-gallery") == before
    assert update_gallery(folder, open_fake).changed == ("long.bvh",)


def test_a_failure_while_writing_leaves_the_old_gallery(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    build_gallery(folder, open_fake)
    clips = Gallery.open(folder).clips
    save_motion(walking(44), folder / "long.bvh")

    def full(handle: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(GalleryError, match="No space left"):
        update_gallery(folder, open_fake)
    monkeypatch.undo()
    assert Gallery.open(folder).clips == clips
    update_gallery(folder, open_fake)
    assert not list((folder / ".motionrt-gallery").glob(".writing-*"))


def test_a_second_writer_is_turned_away(folder: Path) -> None:
    build_gallery(folder, open_fake)
    with writing(folder / ".motionrt-gallery"), pytest.raises(GalleryError, match="another process"):
        update_gallery(folder, open_fake)


def test_a_reader_keeps_its_gallery_while_another_is_written(folder: Path) -> None:
    old = build_gallery(folder, open_fake).gallery
    copy = old.embeddings.copy()
    save_motion(walking(44), folder / "long.bvh")
    update_gallery(folder, open_fake)
    assert (old.embeddings == copy).all()


def test_a_gallery_inside_the_folder_is_not_indexed(folder: Path) -> None:
    Gallery.from_motions([walking(9)], ["walk"], FakeEmbedder()).save(folder / "shown")
    assert [clip.id for clip in build_gallery(folder, open_fake).gallery.clips] == sorted(GOOD)


def test_a_linked_folder_is_followed_but_a_circle_is_not(folder: Path, tmp_path: Path) -> None:
    elsewhere = write_folder(tmp_path / "elsewhere")
    try:
        (folder / "linked").symlink_to(elsewhere, target_is_directory=True)
        (folder / "a b" / "back").symlink_to(folder, target_is_directory=True)
    except OSError as error:
        pytest.skip(f"this system makes no symbolic links: {error}")
    ids = [clip.id for clip in build_gallery(folder, open_fake).gallery.clips]
    assert ids == sorted([*GOOD, *(f"linked/{name}" for name in GOOD)])


def test_a_name_that_is_no_unicode_is_indexed(folder: Path) -> None:
    try:
        (folder / "long.bvh").rename(folder / os.fsdecode(b"caf\xe9.bvh"))
    except OSError as error:
        pytest.skip(f"this file system takes only Unicode names: {error}")
    gallery = build_gallery(folder, open_fake).gallery
    assert gallery.motion("caf\udce9.bvh").frames == 450
    assert update_gallery(folder, open_fake).changed == ()


def test_a_motion_of_absurd_size_is_skipped(folder: Path) -> None:
    motion = walking(5)
    with limits.raised(metres=1e38):
        huge = Motion(motion.rotations, motion.root * np.float32([1, 1, 3e37]), 20.0)
    save_motion(huge, folder / "huge.npz")
    skipped = {item.path: item.reason for item in build_gallery(folder, open_fake).gallery.skipped}
    assert "huge.npz" in skipped


def test_a_folder_without_motions_is_an_error_that_leaves_nothing(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").touch()
    with pytest.raises(InvalidInputError, match=r"no motion files \(\.bvh, \.amc, \.npz"):
        build_gallery(tmp_path, open_fake)
    assert [path.name for path in tmp_path.iterdir()] == ["notes.txt"]


def test_a_folder_of_only_broken_files_is_an_error_with_the_first_reason(tmp_path: Path) -> None:
    (tmp_path / "bad.bvh").write_text("no", encoding="utf-8")
    with pytest.raises(GalleryError, match=r"none of the 1 motion files .* bad\.bvh: "):
        build_gallery(tmp_path, open_fake)


def test_a_missing_folder_and_a_file_are_errors(tmp_path: Path) -> None:
    with pytest.raises(MotionFileNotFoundError, match="no folder"):
        build_gallery(tmp_path / "gone", open_fake)
    (tmp_path / "file.bvh").touch()
    with pytest.raises(InvalidInputError, match="is a file"):
        build_gallery(tmp_path / "file.bvh", open_fake)


def test_jobs_below_one_are_refused(folder: Path) -> None:
    with pytest.raises(InvalidInputError, match="jobs"):
        build_gallery(folder, open_fake, jobs=0)


def test_a_joint_mapping_is_remembered_for_updates_and_hits(folder: Path) -> None:
    renamed = (folder / "a b" / "turn.bvh").read_text(encoding="utf-8").replace("left_knee", "XYZ_unheard_of")
    (folder / "odd.bvh").write_text(renamed, encoding="utf-8")
    mapping = {"left_knee": "XYZ_unheard_of"}
    gallery = build_gallery(folder, open_fake, mapping=mapping).gallery
    assert Gallery.open(folder).mapping == mapping
    assert gallery.motion("odd.bvh").frames == 50
