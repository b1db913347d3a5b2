"""Updates of libraries write what changed, and builds that are killed go on where they were."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from fake_embedder import FakeEmbedder, open_fake
from motions import walking

from motionrt.formats import save_motion
from motionrt.retrieval import Gallery, build_gallery, growth, journal, update_gallery

COUNT = 12


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    library = tmp_path / "library"
    (library / "more").mkdir(parents=True)
    for number in range(COUNT):
        save_motion(
            walking(20, speed=0.5 + number / 10), library / ("more" if number % 2 else ".") / f"{number:02d}.npz"
        )
    return library


@pytest.fixture
def many_segments(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(growth, "SMALL", 0)
    monkeypatch.setattr(growth, "_TIMES", 0)


def files_of(gallery: Gallery) -> dict[str, tuple[int, int]]:
    """Inode and time of every file of a gallery by name: another one was written."""
    assert gallery.folder is not None
    stats = {path.name: path.stat() for path in gallery.folder.iterdir() if path.name != ".lock"}
    return {name: (stat.st_ino, stat.st_mtime_ns) for name, stat in stats.items()}


def test_an_update_without_changes_writes_nothing(folder: Path) -> None:
    before = files_of(build_gallery(folder, open_fake).gallery)
    report = update_gallery(folder, open_fake)
    assert len(report.unchanged) == COUNT
    assert files_of(report.gallery) == before


def test_an_update_leaves_the_large_files_of_what_did_not_change(folder: Path, many_segments: None) -> None:
    before = files_of(build_gallery(folder, open_fake).gallery)
    (folder / "00.npz").unlink()
    save_motion(walking(33), folder / "02.npz")
    save_motion(walking(35), folder / "new.npz")
    model = FakeEmbedder()
    report = update_gallery(folder, lambda: model)
    after = files_of(report.gallery)
    assert {name for name in before if after.get(name) != before[name]} == {"gallery.json"}
    assert model.calls == 2
    assert (report.added, report.changed, report.removed) == (("new.npz",), ("02.npz",), ("00.npz",))
    assert len(report.gallery.segments) == 2
    assert report.gallery.compact().clips == build_gallery(folder, open_fake).gallery.clips


def test_a_touched_file_costs_the_table_of_its_segment_and_is_not_read_again(folder: Path, many_segments: None) -> None:
    before = files_of(build_gallery(folder, open_fake).gallery)
    os.utime(folder / "02.npz", ns=(1, 1))
    assert update_gallery(folder, open_fake).unchanged == tuple(sorted(before_id for before_id in _ids(folder)))
    after = files_of(Gallery.open(folder))
    assert {name.partition("-")[0] for name in after if name not in before} == {"clips"}
    seen: list[str] = []
    update_gallery(folder, open_fake, progress=lambda done, total, name: seen.append(name))
    assert seen == []


def _ids(folder: Path) -> list[str]:
    return [clip.id for clip in Gallery.open(folder).clips]


def test_new_words_rewrite_the_words_of_the_clips_that_they_are_about(folder: Path, many_segments: None) -> None:
    build_gallery(folder, open_fake)
    save_motion(walking(35), folder / "new.npz")
    update_gallery(folder, open_fake)
    before = files_of(Gallery.open(folder))
    (folder / "captions.csv").write_text("file,caption\nnew.npz,a limping pirate\n")
    gallery = update_gallery(folder, open_fake).gallery
    changed = {name.partition("-")[0] for name, stamp in files_of(gallery).items() if before.get(name) != stamp}
    assert changed == {"gallery.json", "captions", "words"}
    assert [part.captions.texts.texts() for part in gallery.segments] == [[], ["a limping pirate"]]
    assert gallery.words.known("pirate")


KILLED = """
import os, sys
from fake_embedder import open_fake
from motionrt.retrieval import build_gallery, journal, update_gallery
journal.EVERY_S = journal.GROWTH = 0.0
def progress(done, total, name):
    if done == int(sys.argv[3]): os._exit(9)
(build_gallery if sys.argv[2] == "build" else update_gallery)(sys.argv[1], open_fake, progress=progress)
"""


def kill(verb: str, folder: Path, after: int) -> None:
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run([sys.executable, "-c", KILLED, str(folder), verb, str(after)], env=environment, check=False)
    assert done.returncode == 9


def test_a_build_that_is_killed_goes_on_where_it_was(folder: Path) -> None:
    kill("build", folder, 5)
    kill("build", folder, 4)  # four more, of the seven that are left
    assert (folder / ".motionrt-gallery" / journal.FOLDER).is_dir()
    (folder / "00.npz").unlink()
    save_motion(walking(50), folder / "more" / "01.npz")
    report = build_gallery(folder, open_fake)
    assert report.indexed == COUNT - 9 + 1
    assert report.added == tuple(sorted(clip.id for clip in report.gallery.clips))
    assert not (folder / ".motionrt-gallery" / journal.FOLDER).exists()
    resumed = {path.name: path.read_bytes() for path in report.gallery.folder.iterdir()}  # type: ignore[union-attr]
    again = build_gallery(folder, open_fake).gallery.folder
    assert again is not None
    assert {path.name: path.read_bytes() for path in again.iterdir()} == resumed


def test_an_update_that_is_killed_goes_on_where_it_was_and_the_gallery_stays_usable(folder: Path) -> None:
    build_gallery(folder, open_fake)
    for number in range(6):
        save_motion(walking(30 + number), folder / f"new{number}.npz")
    kill("update", folder, 4)
    assert len(Gallery.open(folder)) == COUNT
    report = update_gallery(folder, open_fake)
    assert report.indexed == 2
    assert len(report.added) == 6
    assert len(report.gallery) == COUNT + 6


def test_what_another_model_left_is_not_used(folder: Path) -> None:
    kill("build", folder, 5)
    report = build_gallery(folder, lambda: FakeEmbedder("0" * 64, "another"))
    assert report.indexed == COUNT


def test_a_damaged_journal_is_not_used(folder: Path) -> None:
    kill("build", folder, 5)
    for file in (folder / ".motionrt-gallery" / journal.FOLDER).glob("embeddings-*"):
        content = bytearray(file.read_bytes())
        content[-3] ^= 1
        file.write_bytes(content)
    assert build_gallery(folder, open_fake).indexed == COUNT


def test_a_gallery_of_fewer_bits_keeps_them_through_updates(folder: Path) -> None:
    build_gallery(folder, open_fake, precision="int8")
    save_motion(walking(33), folder / "new.npz")
    updated = update_gallery(folder, open_fake).gallery
    assert updated.precision == "int8"
    files = {path.name for path in updated.folder.iterdir()}  # type: ignore[union-attr]
    assert {p.name for p in build_gallery(folder, open_fake, precision="int8").gallery.folder.iterdir()} == files  # type: ignore[union-attr]
