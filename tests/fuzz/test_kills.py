"""Galleries after a kill, a lost process and a full disk."""

from __future__ import annotations

import os
import shutil
import signal
from pathlib import Path

import numpy as np
import pytest
from fake_embedder import FakeEmbedder, open_fake
from kills import killed_at
from motions import walking

from motionrt.errors import GalleryError, GalleryNotFoundError
from motionrt.retrieval import Gallery, build_gallery, store, update_gallery

KILLS = int(os.environ.get("MOTIONRT_KILLS", "6"))


@pytest.fixture
def clips(tmp_path: Path) -> Path:
    folder = tmp_path / "clips"
    folder.mkdir()
    for name, speed in (("slow", 0.8), ("fast", 1.6)):
        walking(24, speed=speed).save(folder / f"{name}.npz")
    return folder


def whole(folder: Path, sizes: set[int]) -> None:
    """The gallery that was there, or the new one, and nothing else in its folder once somebody writes again."""
    gallery = Gallery.open(folder)
    gallery.verify()
    assert len(gallery) in sizes


def test_a_build_that_is_killed_anywhere_leaves_no_gallery_or_a_whole_one(clips: Path, tmp_path: Path) -> None:
    for step in range(KILLS):
        target = tmp_path / f"gallery-{step}"
        died = killed_at(step, "build", clips, target)
        try:
            whole(target, {2})
        except GalleryNotFoundError:
            assert died
        build_gallery(clips, open_fake, out=target)
        whole(target, {2})
        assert not list(target.glob(f"{store.TEMPORARY}*"))
        if not died:
            return


def test_an_update_that_is_killed_anywhere_leaves_the_old_gallery_or_the_new_one(clips: Path, tmp_path: Path) -> None:
    before = build_gallery(clips, open_fake, out=tmp_path / "before").gallery.folder
    assert before is not None
    walking(24, speed=2.4).save(clips / "faster.npz")
    for step in range(KILLS):
        target = tmp_path / f"gallery-{step}"
        shutil.copytree(before, target)
        died = killed_at(step, "update", clips, target)
        whole(target, {2, 3})
        update_gallery(target, open_fake)
        whole(target, {3})
        if not died:
            return


def test_an_update_keeps_no_damaged_embedding(clips: Path, tmp_path: Path) -> None:
    folder = build_gallery(clips, open_fake, out=tmp_path / "gallery").gallery.folder
    assert folder is not None
    (file,) = folder.glob("embeddings-*")
    content = bytearray(file.read_bytes())
    content[-7] ^= 1
    file.write_bytes(content)
    with pytest.raises(GalleryError, match="its checksum is wrong"):
        Gallery.open(folder).search(np.ones(256, np.float32))
    walking(24, speed=2.4).save(clips / "faster.npz")
    with pytest.raises(GalleryError, match="its checksum is wrong"):
        update_gallery(folder, open_fake)


@pytest.mark.parametrize("at", [60, 120, 400, -40])
def test_a_head_with_one_other_bit_is_told(clips: Path, tmp_path: Path, at: int) -> None:
    folder = build_gallery(clips, open_fake, out=tmp_path / "gallery").gallery.folder
    assert folder is not None
    head = folder / store.GALLERY_FILE
    content = bytearray(head.read_bytes())
    content[at] ^= 1
    head.write_bytes(content)
    with pytest.raises(GalleryError, match=r"gallery\.json"):
        Gallery.open(folder)


def test_a_full_disk_leaves_the_old_gallery_and_nothing_of_the_new_one(
    clips: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = build_gallery(clips, open_fake, out=tmp_path / "gallery").gallery.folder
    assert folder is not None
    names = {path.name for path in folder.iterdir()}
    walking(24, speed=2.4).save(clips / "faster.npz")

    written = []

    def full(handle: int) -> None:
        written.append(handle)
        if len(written) > 1:
            raise OSError(28, "No space left on device")

    monkeypatch.setattr(store.os, "fsync", full)
    with pytest.raises(GalleryError, match="No space left"):
        update_gallery(folder, open_fake)
    assert {path.name for path in folder.iterdir()} == names
    whole(folder, {2})


class Deadly(FakeEmbedder):
    """A model that ends its process with the third clip."""

    def embed_motion(self, features: object) -> np.ndarray:
        if self.calls >= 2:
            os.kill(os.getpid(), signal.SIGKILL)
        return super().embed_motion(features)  # type: ignore[arg-type]


def open_deadly() -> Deadly:
    return Deadly()


def test_a_process_that_dies_ends_the_build_at_once(tmp_path: Path) -> None:
    folder = tmp_path / "clips"
    folder.mkdir()
    for number in range(10):
        walking(24, speed=0.5 + number / 10).save(folder / f"{number}.npz")
    with pytest.raises(GalleryError, match="ended early"):
        build_gallery(folder, open_deadly, out=tmp_path / "gallery", jobs=2)
    with pytest.raises(GalleryNotFoundError):
        Gallery.open(tmp_path / "gallery")


def test_a_gallery_of_a_stranger_reads_only_the_files_that_it_knows(clips: Path, tmp_path: Path) -> None:
    gallery = build_gallery(clips, open_fake, out=tmp_path / "elsewhere").gallery
    assert gallery.motion("slow.npz").frames == 24
    walking(30, speed=1.0).save(clips / "slow.npz")  # another file of that name
    with pytest.raises(GalleryError, match="not the file that was indexed"):
        gallery.motion("slow.npz")
